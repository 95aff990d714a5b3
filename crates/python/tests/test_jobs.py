"""Jobs: the files of the command line, Ctrl-C, comparisons, certificates."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from contextlib import chdir
from pathlib import Path
from typing import Any

import pytest
from conftest import STUDIES

import retune as rt

SMALL = {"k2": {"from": 100, "to": 600, "points": 4}, "c2": {"from": 50, "to": 300, "points": 4}}


def small(tmp_path: Path) -> Path:
    """A study whose search takes a second."""
    study = json.loads((STUDIES / "ssvi.json").read_text())
    study["optimize"] |= {
        "vary": ["k2", "c2"],
        "bounds": {"k2": [10, 600], "c2": [1, 1000]},
        "surf": SMALL,
        "objective": {"omega": {"from": 5, "to": 8, "samples": 9}},
        "refine": {"starts": 1, "MaxFunEvals": 25},
    }
    del study["$schema"]
    file = tmp_path / "small.json"
    file.write_text(json.dumps(study))
    return file


def below(place: Path) -> dict[str, bytes]:
    """Every file in a directory and below."""
    paths = (path for path in sorted(place.rglob("*")) if path.is_file() and not path.name.startswith("."))
    return {str(path.relative_to(place)): path.read_bytes() for path in paths}


def files(place: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(place.iterdir()) if not path.name.startswith(".")}


def test_contract_a_search_has_the_bytes_of_the_command_line(program: Path, tmp_path: Path) -> None:
    study = small(tmp_path)
    subprocess.run([program, "optimize", study, "--out", tmp_path / "line"], check=True, capture_output=True)
    result = rt.optimize(rt.Problem.from_study(study), out=tmp_path / "package")
    assert files(tmp_path / "line") == files(tmp_path / "package")
    assert "manifest.json" in files(result.out) and "report.html" in files(result.out)
    assert result.fun == rt.Problem.from_study(study)(result.x) and result.success
    assert rt.Problem.from_study(result.out).start == result.x.tolist()
    assert "E1max" in repr(result) and "<table>" in result._repr_html_()
    assert result.report().encode() == files(result.out)["report.html"]
    row = result.to_pandas().iloc[0]
    assert [row[name] for name in result.problem.names] == result.x.tolist() and row["E1max"] == result.fun
    assert any("holds" in line for line in rt.verify(result.out))
    (result.out / "optimum.json").write_text((result.out / "optimum.json").read_text().replace("E1max", "E1min"))
    with pytest.raises(rt.Error, match="optimum.json"):
        rt.verify(result.out)


def test_contract_a_problem_without_a_file_is_written_and_verified(tmp_path: Path) -> None:
    problem = rt.Problem.from_study(json.loads(small(tmp_path).read_text()))
    first = rt.optimize(problem, tmp_path / "out")
    again = rt.optimize(problem, tmp_path / "out")
    assert json.loads((first.out / "manifest.json").read_text())["made_by"]["study"] == "study.json"
    assert first.x.tolist() == again.x.tolist() and rt.verify(again.out)
    foreign = tmp_path / "foreign"
    foreign.mkdir()
    (foreign / "optimum.json").write_text("{}")
    with pytest.raises(rt.Error, match="--replace"):
        rt.optimize(problem, foreign)
    assert rt.optimize(problem, foreign, replace=True).fun == first.fun


INTERRUPTED = """
import sys, retune as rt
problem = rt.Problem.from_study(sys.argv[1])
print("ready", flush=True)
try:
    rt.optimize(problem, sys.argv[2], resume=True)
except KeyboardInterrupt:
    print("stopped", flush=True)
    # The interpreter lives, and so does the package.
    assert problem(problem.start) > 0
    sys.exit(42)
"""


def test_contract_ctrl_c_ends_a_search_and_resume_goes_on_to_the_same_bytes(tmp_path: Path) -> None:
    study = json.loads(small(tmp_path).read_text())
    study["optimize"]["surf"] = {name: {**axis, "points": 40} for name, axis in SMALL.items()}
    slow = tmp_path / "slow.json"
    slow.write_text(json.dumps(study))
    out = tmp_path / "broken"
    stopped = 0
    for attempt in range(3):
        process = subprocess.Popen([sys.executable, "-c", INTERRUPTED, slow, out], stdout=subprocess.PIPE, text=True)
        assert process.stdout is not None and process.stdout.readline() == "ready\n"
        time.sleep(0.7)
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        process.communicate(timeout=60)
        assert time.monotonic() - begun < 20, "Ctrl-C ends it soon, on a busy machine too"
        stopped += process.returncode == 42
    assert stopped, "at least one was stopped on the way"
    problem = rt.Problem.from_study(slow)
    resumed = rt.optimize(problem, out, resume=True)
    unbroken = rt.optimize(problem, tmp_path / "unbroken")
    assert files(resumed.out) == files(unbroken.out)


def test_contract_ctrl_c_ends_a_large_grid_at_once(tmp_path: Path) -> None:
    study = json.loads(small(tmp_path).read_text())
    study["optimize"]["surf"] = {name: {**axis, "points": 400} for name, axis in SMALL.items()}
    large = tmp_path / "large.json"
    large.write_text(json.dumps(study))
    with subprocess.Popen([sys.executable, "-c", INTERRUPTED, large, tmp_path / "out"], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdout.readline() == "ready\n"
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        assert process.wait(timeout=60) == 42
        assert time.monotonic() - begun < 5, "points that were not begun are not computed"


def test_contract_ctrl_c_ends_a_batch(tmp_path: Path) -> None:
    code = """
import sys, numpy as np, retune as rt
problem = rt.Problem.from_study(sys.argv[1])
print("ready", flush=True)
try:
    problem.batch(np.tile(problem.start, (10**6, 1)))
except KeyboardInterrupt:
    sys.exit(42)
"""
    with subprocess.Popen([sys.executable, "-c", code, STUDIES / "ssvi.json"], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdout.readline() == "ready\n"
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        assert process.wait(timeout=60) == 42
        assert time.monotonic() - begun < 5


def test_contract_an_exception_of_the_progress_ends_the_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise LookupError("shown nowhere")

    monkeypatch.setattr("retune._progress.Progress.__call__", fail)
    with pytest.raises(LookupError, match="shown nowhere"):
        rt.optimize(rt.Problem.from_study(small(tmp_path)), tmp_path / "out")


def test_contract_progress_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from retune._progress import Progress

    told: list[tuple[str, str, int]] = []
    shown = Progress.__call__

    def note(self: Progress, kind: str, words: str, done: int, known: int, count: int) -> None:
        told.append((kind, words, done))
        assert done <= max(count, done if words != "surf" else count)
        shown(self, kind, words, done, known, count)

    monkeypatch.setattr(Progress, "__call__", note)
    rt.optimize(rt.Problem.from_study(small(tmp_path)), tmp_path / "out")
    # A stage that ends between two looks is told nothing of.
    stages = {words for kind, words, _ in told if kind in ("progress", "finished")}
    assert stages and stages <= {"surf", "fminsearch", "descents", "certificates"}
    assert any(kind == "result" and "E1max" in words for kind, words, _ in told)


def test_contract_a_certificate_is_that_of_the_command_line(program: Path, tmp_path: Path) -> None:
    study = STUDIES / "tmd.json"
    out = tmp_path / "certificate"
    subprocess.run([program, "certify", study, "--out", out], check=True, capture_output=True)
    certificate = rt.certify(rt.Problem.from_study(study))
    assert certificate.data == json.loads((out / "certificate.json").read_text())
    assert list(certificate.to_pandas().parameter) == [one["parameter"] for one in certificate["sensitivity"]]
    assert certificate.words in certificate.report() or "&" in certificate.words
    assert certificate.words in repr(certificate) and certificate.verdict == certificate["verdict"]


def test_contract_dampers_are_compared(tmp_path: Path) -> None:
    problem = rt.Problem(
        rt.Structure(m1=1000, c1=452, k1=3.95e4),
        rt.TMD(60, k2=1900, c2=150),
        P=800,
        band=(5, 8),
        samples=7,
        vary=["k2", "c2"],
        bounds={"k2": (10, 4000), "c2": (0, 1000)},
        response="steady",
    )
    compared = rt.compare(problem, [rt.TMD(20), rt.TMD(60, k2=1900, c2=150), rt.TMD(60)], tmp_path / "compared")
    light, given, found = (next(r for r in compared.results if r.out.name.startswith(f"{i}-")) for i in (1, 2, 3))
    assert compared.best is compared.results[0] and light is compared.results[-1], "a heavier damper does more"
    assert given.fun == pytest.approx(found.fun, rel=1e-3), "both find the same optimum"
    assert found["m2"] == 60 and "verdict" in repr(compared) and compared._repr_html_().count("<tr>") == 4
    assert compared.to_pandas()["E1max"].tolist() == [result.fun for result in compared.results]
    assert compared.report().count("<tr>") == 4 and "srcdoc=" in compared.report()
    pulse = {"pulse": "half sine", "of": "force", "peak": 1e4, "duration": 0.1}
    study = problem.study
    shock = {**study, "scene": {**study["scene"], "forcing": pulse}, "optimize": {**study["optimize"], "objective": {}}}
    with pytest.raises(rt.StudyError, match="k2: missing, and only for a forcing with a frequency") as caught:
        rt.compare(rt.Problem.from_study(shock), [rt.TMD(60)])
    assert caught.value.field == "damper.k2"
    with pytest.raises(rt.StudyError, match="give one damper"):
        rt.compare(problem, [])


@pytest.mark.parametrize("moved", [{"imbalance": "0.5 kg·m"}, {"base": "2 mm"}, {"base_acceleration": "0.02 g"}])
def test_contract_dampers_are_compared_by_any_quantity_whatever_moves_the_structure(moved: dict[str, Any], tmp_path: Path) -> None:
    problem = rt.Problem(
        rt.Structure(m1=1000, c1=452, k1=3.95e4),
        rt.TMD(60, k2=1900, c2=150),
        **moved,
        band=(5, 8),
        samples=7,
        vary=["k2", "c2"],
        bounds={"k2": (10, 4000), "c2": (0, 1000)},
        response="steady",
        quantity="x1max",
    )
    dampers = [rt.TMD(20), rt.TMD(60, k2=1900, c2=150), rt.TMD(60)]
    compared = rt.compare(problem, dampers, tmp_path / "compared")
    by_mass = {result["m2"]: result.fun for result in compared.results}
    assert len(compared.results) == 3 and by_mass[60] < by_mass[20]
    assert compared.results[0].fun == pytest.approx(compared.results[1].fun, rel=1e-3), "found and given come to the same optimum"
    assert "x1max, m" in repr(compared) and compared.to_pandas()["x1max"].tolist() == [result.fun for result in compared.results]


def test_contract_branches_have_the_answer_of_the_command_line(program: Path, tmp_path: Path) -> None:
    study = STUDIES / "ssvi.json"
    line = [program, "branches", study, "--from", "5.2", "--to", "5.266", "--samples", "5", "--starts", "2"]
    subprocess.run([*line, "--out", tmp_path / "line"], check=True, capture_output=True)
    found = rt.branches(study, tmp_path / "package", span=(5.2, 5.266), samples=5, starts=2, progress=False)
    assert found == json.loads((tmp_path / "line" / "branches.json").read_text())
    assert files(tmp_path / "line") == files(tmp_path / "package")
    assert any(event["kind"] == "period doubling" for branch in found["branches"] for event in branch["events"])
    assert any("holds" in line for line in rt.verify(tmp_path / "package"))
    with pytest.raises(rt.Error, match="give one of k2, c2"):
        rt.branches(study, tmp_path / "other", over="zeta")


def test_contract_a_design_is_that_of_the_command_line(program: Path, tmp_path: Path) -> None:
    line = [program, "design", "--m1", "500", "--k1", "20000", "--c1", "100", "--P", "800", "--band", "5", "8", "--mass", "25"]
    subprocess.run([*line, "--out", "line"], check=True, capture_output=True, cwd=tmp_path)
    structure = rt.Structure(m1=500, k1=20000, c1=100)
    with chdir(tmp_path):
        design = rt.design(structure, "package", P=800, band=(5, 8), mass=25, progress=False)
    own, other = (below(tmp_path / name) for name in ("line", "package"))
    for name in ("answer.txt", "manifest.json"):  # they name their directory
        own[name], other[name] = own[name].replace(b"line", b""), other[name].replace(b"package", b"")
    del own["manifest.json"], other["manifest.json"]  # the hash of the answer, which names its directory
    assert own == other and "comparison.csv" in own
    assert repr(design) == design.answer and "TMD" in design.answer
    assert [(row["damper"], row["limits"], row["m2"]) for row in design.rows][:2] == [("no damper", "all", ""), ("TMD", "all", 25)]
    words = rt.design(structure, tmp_path / "words", P="0.8 kN", band="5..8", mass="5 %", damper="tmd", progress=False)
    assert words.rows == design.rows[:2]
    assert design._repr_html_().startswith("<table>")
    assert design.report() == (tmp_path / "package" / "report.html").read_text(encoding="utf-8")
    assert design.report()._repr_html_().startswith("<iframe srcdoc=") and len(design.to_pandas()) == len(design.rows)
    based = rt.design(structure, tmp_path / "based", base="1 mm", band="0.8Hz..1.3Hz", mass="5 %", damper="tmd", progress=False)
    assert "base that moves by 1 mm" in " ".join(based.answer.split()) and based.rows[1]["damper"] == "TMD"
    with pytest.raises(rt.StudyError, match="mass: 900 is more than the structure") as caught:
        rt.design(structure, tmp_path / "heavy", P=800, band=(5, 8), mass=900)
    assert caught.value.field == "mass"
    assert design._repr_html_().count("5 to 8 rad/s") == 1
    with pytest.raises(rt.StudyError, match="stroke is limited twice|is limited twice, to 0.5 mm and to 2 mm"):
        rt.design(structure, tmp_path / "twice", P=800, mass="5 %", stroke="2 mm", limits={"stroke": "0.5 mm"})
    with pytest.raises(rt.Error, match='"figure99" is no table or figure of the paper'):
        rt.reproduce("figure99", tmp_path / "none", study=STUDIES / "paper.json", progress=False)


def test_contract_jobs_on_files_have_the_bytes_of_the_command_line(program: Path, tmp_path: Path) -> None:
    study = small(tmp_path)

    def line(name: str, *arguments: object) -> Path:
        subprocess.run([program, *map(str, arguments), "--out", tmp_path / f"line-{name}"], check=True, capture_output=True)
        return tmp_path / f"line-{name}"

    def out(name: str) -> Path:
        return tmp_path / f"package-{name}"

    quiet = {"progress": False}
    table = rt.sweep(study, out("sweep"), over="k1", span=(3e4, 4e4), points=9, quantities=["E1max", "x1max"], **quiet)
    swept = line("sweep", "sweep", study, "--over", "k1", "--from", 3e4, "--to", 4e4, "--points", 9, "--quantity", "E1max,x1max")
    assert below(out("sweep")) == below(swept) and table == json.loads((swept / "sweep.json").read_text())
    for number in (1, 2):
        assert rt.sweep(study, out("parts"), over="k1", span=(3e4, 4e4), points=9, shard=(number, 2), **quiet) is None
    merged = rt.sweep(study, out("parts"), over="k1", span=(3e4, 4e4), points=9, merge=True, **quiet)
    whole = rt.sweep(study, out("whole"), over="k1", span=(3e4, 4e4), points=9, **quiet)
    assert merged == whole and merged is not None
    with pytest.raises(rt.StudyError, match="over: ") as caught:
        rt.sweep(study, over="mass", span=(1, 2))
    assert (caught.value.field, caught.value.value) == ("over", "mass")

    certificate = rt.certify_file(study, out("certify"), **quiet)
    assert below(out("certify")) == below(line("certify", "certify", study)) and certificate.verdict

    for number in (1, 2):
        assert rt.share(study, (number, 2), out("merge"), **quiet) == out("merge")
    result = rt.merge(study, out=out("merge"), **quiet)
    one = rt.optimize(rt.Problem.from_study(study), tmp_path / "one", progress=False)
    assert result.fun == one.fun and (result.out / "optimum.json").read_bytes() == (one.out / "optimum.json").read_bytes()
    with pytest.raises(rt.Error, match="shard: "):
        rt.share(study, (3, 2), out("merge"))

    plan: dict[str, object] = {"kind": "table2", "rows": [{"damper": "SSVI NES", "study": "small.json"}]}
    (tmp_path / "several.json").write_text(json.dumps(plan))
    rt.table2(tmp_path / "several.json", out("table2"), **quiet)
    assert below(out("table2")) == below(line("table2", "table2", tmp_path / "several.json"))

    # A tuning at another stiffness takes most of a minute: what is asked for arrives.
    with pytest.raises(rt.Error, match="k1: -3 is not allowed"):
        rt.retention(tmp_path / "several.json", [4e4, -3], out("retention"), **quiet)

    plan = {"kind": "fronts", "dampers": [{"damper": "SSVI NES", "study": "small.json"}], "k2": [600], "samples": 9, "check": 9, "certificates": 1}
    (tmp_path / "fronts.json").write_text(json.dumps(plan))
    rt.fronts(tmp_path / "fronts.json", out("fronts"), **quiet)
    assert below(out("fronts")) == below(line("fronts", "fronts", tmp_path / "fronts.json"))

    assert rt.reproduce("figure6", out("paper"), study=STUDIES / "paper.json", **quiet) == out("paper")
    assert below(out("paper")) == below(line("paper", "figure", 6, "--study", STUDIES / "paper.json"))


def test_contract_a_motion_is_proven(program: Path) -> None:
    design = STUDIES.parent / "results" / "tmd-free"
    theorem = rt.prove(design)
    said = subprocess.run([program, "prove", design, "--json"], capture_output=True, text=True, check=True)
    assert theorem == json.loads(said.stdout)
    low, high = theorem["largest"]["E1max"]
    assert 160.605045 < low < high < 160.605046
    with pytest.raises(rt.Error, match="omega"):
        rt.prove(design, omega=-1.0)


def test_contract_every_command_is_reachable(program: Path) -> None:
    """A command that comes new is missed here until it has its place."""
    said = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    commands = re.findall(r"^  (\w+) {2,}", said.partition("Commands:")[2].partition("Options:")[0], re.M)
    functions = {"optimize", "design", "merge", "verify", "certify", "sweep", "branches", "table2", "retention", "fronts", "losses", "prove", "reproduce"}
    assert functions <= set(dir(rt))
    # By another name: `problem.simulate`, `problem.batch`, `reproduce("figure3")`, `Problem.from_study`.
    elsewhere = {"simulate", "evaluate", "figure", "table", "check"}
    # Of no use there: a page for a person to look at, and what editors and shells complete with.
    assert set(commands) == functions | elsewhere | {"explore", "schema", "completions", "help"}
