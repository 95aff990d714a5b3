"""The same numbers as the command line's, to the last bit, in every way to ask for them."""

from __future__ import annotations

import copy
import json
import math
import pickle
import subprocess
import threading
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
from conftest import STUDIES, designs

import retune as rt


def asked(program: Path, study: Path, X: np.ndarray) -> list[dict[str, float]]:
    """What `retune evaluate --json` answers."""
    lines = "\n".join(" ".join(repr(float(value)) for value in row) for row in X)
    answer = subprocess.run([program, "evaluate", study, "--json"], input=lines, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in answer.stdout.splitlines()]


@pytest.mark.parametrize("name", ["ssvi.json", "tmd-free.json", "ssvi-resonance.json", "tmd-k1.json"])
def test_contract_values_are_those_of_the_command_line(program: Path, name: str) -> None:
    problem = rt.Problem.from_study(STUDIES / name)
    X = designs(problem, 6)
    answers = asked(program, STUDIES / name, X)
    batch = problem.batch(X)
    assert [answer["E1max"] for answer in answers] == batch.E1max.tolist()
    assert [problem.evaluate(x).largest for x in X] == batch.E1max.tolist()
    assert [problem(x) for x in X] == batch.value.tolist()


def test_contract_limits_are_those_of_the_command_line(program: Path, ssvi: rt.Problem, tmp_path: Path) -> None:
    study = tmp_path / "limited.json"
    study.write_text(json.dumps(ssvi.study))
    X = np.concatenate([designs(ssvi, 6), [[215, 232, 0.06, 0.36], [250, 150, 0.03, 0.4], [400, 100, 0.03, 0.9]]])
    batch = ssvi.batch(X)
    answers = [answer | answer["reached"] for answer in asked(program, study, X)]
    for name in ("E1max", "stroke", "contact_force", "violation"):
        assert [answer[name] for answer in answers] == batch[name].tolist(), name
    broken = batch.violation > 0
    assert broken.any() and not broken.all(), "the draw has designs of both kinds"
    assert (batch.value[broken] > 1e100).all() and (batch.value[~broken] == batch.E1max[~broken]).all()
    assert (np.argsort(batch.value[broken]) == np.argsort(batch.violation[broken])).all(), "ordered by violation"


def test_contract_a_problem_of_objects_is_that_of_its_study(tmp_path: Path) -> None:
    built = rt.Problem(
        rt.Structure(m1=1000, c1=452, k1=3.95e4),
        rt.SSVI(m2=60, k2=215, c2=232, D=0.06, C=0.36),
        P=800,
        omega=6.28,
        window=(50, 100),
        band=(5, 8),
        samples=31,
        vary=["k2", "c2", "D", "C"],
        bounds={"k2": (10, 600), "c2": (1, 1000), "D": (0, 1), "C": (0, 2)},
        surf=json.loads((STUDIES / "ssvi.json").read_text())["optimize"]["surf"],
        coarse={"rtol": 1e-4, "peaks": False, "most": 800},
        refine={"starts": 3, "scaled": True, "TolX": 1e-4, "TolFun": 1e-3, "MaxFunEvals": 2000, "MaxIter": 2000},
        solver={"search_rtol": 1e-8},
        name="ssvi",
    )
    assert built == rt.Problem.from_study(STUDIES / "ssvi.json")
    assert built == rt.Problem.from_study(built.study)
    assert built != built.at(k1=30000.0)
    assert built.names == ["k2", "c2", "D", "C"] and built.units == ["N/m", "N·s/m", "m", "m"]
    assert built.start == [215, 232, 0.06, 0.36]
    assert built.at([300, 200, 0.1, 0.3]).start == [300, 200, 0.1, 0.3]
    free = rt.Problem(rt.Structure(m1=1, c1=0.1, k1=1), rt.TMD(0.1, k2=0.1, c2=0.02), P=1, vary=["k2"], bounds={"k2": (0, np.inf)})
    assert free.bounds == [(0, np.inf)]


def test_contract_threads_and_pickles_change_nothing(ssvi: rt.Problem) -> None:
    X = designs(ssvi, 40)
    alone = ssvi.batch(X, threads=1)
    again = pickle.loads(pickle.dumps(ssvi))
    assert again == ssvi and type(again) is rt.Problem and again.batch(X, threads=2) == alone
    assert copy.deepcopy(ssvi).batch(X[::2]) == rt.Table({name: column[::2] for name, column in alone.items()})
    assert pickle.loads(pickle.dumps(alone)) == alone
    error = pickle.loads(pickle.dumps(rt.StudyError("k2: -1 is not allowed", "k2", -1.0)))
    assert (str(error), error.field, error.value) == ("k2: -1 is not allowed", "k2", -1.0)


@pytest.mark.parametrize("method", ["spawn", "fork", "forkserver"])
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_contract_processes_of_every_kind_agree(method: str) -> None:
    """A forked child has the memory of its parent's threads, and none of them."""
    problem = rt.Problem.from_study(STUDIES / "ssvi.json")
    x = problem.start
    here = problem(x)  # the pool of this process now exists
    with get_context(method).Pool(1) as pool:
        assert pool.apply_async(problem, (x,)).get(60) == here


def test_contract_the_lock_is_released(ssvi: rt.Problem) -> None:
    """While one thread evaluates, another runs Python."""
    counted, done = 0, threading.Event()

    def evaluate() -> None:
        ssvi.at(T=20000.0, t0=0.0)(ssvi.start)
        done.set()

    thread = threading.Thread(target=evaluate)
    thread.start()
    while not done.is_set():
        counted += 1
        done.wait(0.001)
    thread.join()
    assert counted > 5


def test_contract_a_run_is_that_of_the_command_line(program: Path, tmp_path: Path) -> None:
    study = STUDIES / "ssvi-resonance.json"
    rows = tmp_path / "motion.csv"
    command = [program, "simulate", study, "--set", "k1=30000", "--trajectory", rows, "--json"]
    said = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    run = rt.Problem.from_study(study).simulate(k1=30000)
    assert run.maxima == said
    lines = [line.split(",") for line in rows.read_text().splitlines()]
    grid = [line for line in lines[1:] if line[-1] == "grid"]
    assert lines[0][:-1] == list(run.motion)
    for i, name in enumerate(run.motion):
        assert [float(line[i]) for line in grid] == run.motion[name].tolist(), name
    assert [line[-1] for line in lines[1:] if line[-1] != "grid"] == run.events.moment.tolist()
    impacts = said["impacts"]
    assert run.contacts.rows == impacts["primary"] + impacts["obstacle"]
    walls = run.contacts.wall.tolist()
    assert [walls.count("structure"), walls.count("obstacle")] == [impacts["primary"], impacts["obstacle"]]
    assert run.contacts.force.max() == max(said["force_max"].values())
    assert (run.contacts.lift_off > run.contacts.touch_down)[:-1].all()


def test_contract_a_contact_that_the_window_cuts_has_its_wall_and_no_force_beyond() -> None:
    study = json.loads((STUDIES / "ssvi-resonance.json").read_text())
    whole = rt.Problem.from_study(study).simulate().contacts
    assert whole.rows > 20
    study["window"] = {"t0": whole.lift_off[5] - 1e-4, "T": whole.touch_down[9] + 1e-4}
    cut = rt.Problem.from_study(study).simulate().contacts
    assert cut.wall.tolist() == whole.wall[5:10].tolist()
    assert np.isnan(cut.force[[0, -1]]).all()
    np.testing.assert_allclose(cut.force[1:-1], whole.force[6:9], rtol=1e-9)
    assert np.isnan(cut.touch_down[0]) and np.isnan(cut.lift_off[-1])


def test_contract_a_sweep_is_that_of_the_command_line(program: Path, tmp_path: Path) -> None:
    study = STUDIES / "ssvi-resonance.json"
    out = tmp_path / "sweep"
    command = [program, "sweep", study, "--over", "omega", "--from", "5", "--to", "8", "--points", "13", "--out", out, "--quiet"]
    subprocess.run(command, capture_output=True, check=True)
    lines = [line.split(",") for line in (out / "sweep.csv").read_text().splitlines()]
    sweep = rt.Problem.from_study(study).sweep(omega=np.linspace(5, 8, 13))
    assert list(sweep) == lines[0]
    for i, name in enumerate(sweep):
        said = [float(line[i]) if line[i] else float("nan") for line in lines[1:]]
        np.testing.assert_array_equal(said, sweep[name], name)
    assert rt.Problem.from_study(study).sweep(omega=6.5).rows == 1
    assert rt.Problem.from_study(study).sweep(k1=[3e4, 4e4], objective=True).E1max[0] > 0


def test_contract_a_record_of_numpy_is_that_of_its_study(tmp_path: Path) -> None:
    structure, damper = rt.Structure(m1=1000, c1=452, k1=3.95e4), rt.SSVI(60, k2=215, c2=232, D=0.02, C=0.1)
    t = 0.01 * np.arange(3001)
    a = 3 * np.exp(-0.1 * t) * np.sin(6 * t)
    of = "base acceleration"
    built = rt.Problem(structure, damper, record=rt.Record(t, a, of=of), window=(0, 30))
    (tmp_path / "a.csv").write_text("t,a\n" + "".join(f"{time!r},{value!r}\n" for time, value in zip(t.tolist(), a.tolist())))
    (tmp_path / "study.json").write_text(json.dumps({**built.study, "scene": {**built.study["scene"], "forcing": {"record": "a.csv", "of": of}}}))
    motion = [problem.simulate() for problem in (built, rt.Problem.from_study(tmp_path / "study.json"), pickle.loads(pickle.dumps(built)))]
    assert motion[0].contacts.rows > 5
    assert all((run.x1 == motion[0].x1).all() for run in motion)
    assert len({run.maxima["E1max"] for run in motion}) == 1
    # The distance of the samples in place of their times, another unit, a file.
    same = [
        rt.Record(0.01, a / 9.80665, of=of, unit="g"),
        rt.Record(np.float32(t).astype(float).round(6), -a, of=of, scale=-1),
        rt.Record.read(tmp_path / "a.csv", of=of, column="a"),
    ]
    for record in same:
        run = rt.Problem(structure, damper, record=record, window=(0, 30)).simulate()
        assert np.abs(run.x1 - motion[0].x1).max() < 1e-6 * np.abs(run.x1).max()
    assert "3001 samples" in repr(built)
    with pytest.warns(UserWarning, match="the record ends at 30 s; from there to T = 40 s the motion is free"):
        rt.Problem(structure, damper, record=rt.Record(t, a, of=of), window=(0, 40))


def test_exact_a_pulse_moves_a_free_mass_by_its_impulse() -> None:
    free = rt.Structure(m1=10, c1=0, k1=0)
    pulse = rt.Pulse("half sine", 2, 0.5, of="force", unit="kN")
    run = rt.Problem(free, record=pulse, window=(0, 2)).simulate()
    assert run.maxima["v1max"] == pytest.approx(2000 * 0.5 * 2 / np.pi / 10, rel=1e-13)


def test_contract_a_random_motion_has_no_largest_stroke_and_no_frequency() -> None:
    problem = rt.Problem.from_study(STUDIES / "random-tmd.json")
    found = problem.evaluate(problem.start)
    assert found.value == found.largest > 0
    assert math.isnan(found.stroke) and math.isnan(found.omega_worst)


def test_numbers_of_numpy_are_shown() -> None:
    """A part made of numpy's scalars showed none of them."""
    structure = rt.Structure(m1=np.float32(12), c1=np.int32(3), k1=np.float64(1000))
    shown = repr(structure)
    assert all(text in shown for text in ("m1", "c1", "k1")), shown
    assert structure == rt.Structure(m1=12.0, c1=3.0, k1=1000.0)
