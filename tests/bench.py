"""Times what people wait for beside an earlier version: values over a band, a `surf`, searches, a design, a certificate; and what a looser
tolerance of a search changes of its result.

    python3 tests/bench.py RETUNE BASE [--repeats N]

RETUNE and BASE are the programs of two versions, each in target/release of its checkout. Times are those of the processor, one thread, the least
of N turns that alternate between the versions (of fewer where they take long). A dash: BASE has no such command, or cannot read the results.
"""

import argparse
import json
import os
import platform
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Designs in the order k2 c2 D C: that of results/ssvi, whose motions are regular, and Table 2's, where they are not.
DESIGNS = {"regular": "583.92141 94.97052 0.028850 1.104545", "irregular": "215 232 0.06 0.36"}
# Values in one process, so that its start counts for little.
VALUES = 40
# A `surf`, each point one run at one frequency: points along each side, its ranges (those of `just lab bench-surf`), and how coarse it may be to say
# where a search starts: its tolerance, and an eighth of what the structure has without a damper.
POINTS = 12
RANGES = {"k2": (50, 1600, "log"), "c2": (10, 400, "log"), "D": (0.02, 0.26, "linear"), "C": (0.06, 0.78, "linear")}
COARSE = {"rtol": 1e-4, "most": 200}
# The footbridge of the README.
BRIDGE = "design --m1 40t --f1 2Hz --zeta 0.5% --force 280N --band 1.8Hz..2.2Hz --mass 2%".split()
# No further turn begins after this time, s.
LONG = 10
# Studies whose searches are made with and without a tolerance of their own, and with a coarse grid: name, search_rtol, coarse.
SEARCHES = ("ssvi", "ssvi-global", "ssvi-resonance")
STAGES = (("1e-10", 1e-10, {}), ("1e-8", 1e-8, {}), ("1e-8, coarse", 1e-8, {"rtol": 1e-4, "peaks": False}), ("1e-6", 1e-6, {}))


def seconds(program, arguments, text=None, cwd=None):
    """Processor time of a command on one thread, s; none where the program does not know it."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([program, *arguments, "--threads", "1"], input=text, text=True, capture_output=True, cwd=cwd)
    if done.returncode == 2:
        return None
    if done.returncode:
        sys.exit(f"{program} {' '.join(map(str, arguments))}: {done.stderr}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def study(program, name, directory, coarse=None, **solver):
    """A study of ours as a version takes it, its grid coarse as given: an earlier format has neither kind nor what is coarse."""
    study = json.loads((ROOT / f"studies/{name}.json").read_text())
    study.pop("$schema")
    study["solver"] = {**study.get("solver", {}), **solver}
    if coarse is not None:
        study["optimize"]["coarse"] = coarse
    file = Path(tempfile.mkdtemp(dir=directory)) / f"{name}.json"
    file.write_text(json.dumps(study))
    if subprocess.run([program, "check", file], capture_output=True).returncode:
        study.pop("kind")
        study["optimize"].pop("coarse", None)
        study["solver"].pop("search_rtol", None)
        file.write_text(json.dumps(study))
    return file


def values(program, directory, design, rtol):
    """Time of a value over the band, s."""
    took = seconds(program, ["evaluate", study(program, "ssvi", directory, rtol=rtol)], f"{design}\n" * VALUES)
    return took / VALUES


def surf(program, directory, coarse, rtol):
    """Time of a run of a `surf`, s: a grid alone, as one share of itself."""
    file = study(program, "ssvi-resonance", directory, coarse, rtol=rtol)
    said = json.loads(file.read_text())
    axis = lambda first, last, scale: {"from": first, "to": last, "points": POINTS, "scale": scale}
    said["optimize"]["surf"] = {name: axis(*ends) for name, ends in RANGES.items()}
    file.write_text(json.dumps(said))
    return seconds(program, ["optimize", file, "--shard", "1/1", "--out", file.parent / "surf"]) / POINTS**4


def search(program, directory, name, coarse=None, **solver):
    """Time of a search, s, and the E1max that it ends with, J."""
    file = study(program, name, directory, coarse, **solver)
    took = seconds(program, ["optimize", file, "--out", file.parent / "out"])
    return took, json.loads((file.parent / "out/optimum.json").read_text())["E1max"]


def command(program, directory, arguments):
    """Time of a command in a directory of its own, s."""
    return seconds(program, arguments, cwd=tempfile.mkdtemp(dir=directory))


def commit(program):
    """The commit of the checkout in which a program was built."""
    command = ["git", "-C", program.parents[2], "describe", "--always", "--dirty"]
    return subprocess.run(command, text=True, capture_output=True, check=True).stdout.strip()


def machine():
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    name = next((line.partition(": ")[2] for line in lines if line.startswith("model name")), platform.processor())
    rustc = subprocess.run(["rustc", "--version"], text=True, capture_output=True).stdout.strip()
    return f"{name}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.2f} at the start; {rustc}"


def compare(programs, directory, repeats):
    """Both versions."""
    print(f"{'':<58}{'today':>10}{commit(programs[1]):>10}{'ratio':>8}")

    def row(name, scale, of, base_of=None):
        """`of` times a program; the base by `base_of`, where that differs."""
        least = [float("inf"), float("inf")]
        begun = time.perf_counter()
        for _ in range(repeats):
            for i, (program, took) in enumerate(zip(programs, (of, base_of or of))):
                if least[i] is not None and (turn := took(program)) is not None:
                    least[i] = min(least[i], scale * turn)
                else:
                    least[i] = None
            if time.perf_counter() - begun > LONG:
                break
        cells = "".join(f"{'-' if t is None else format(t, '.3f'):>10}" for t in least)
        print(f"{name:<58}{cells}" + (f"{least[1] / least[0]:>8.2f}" if least[1] else f"{'-':>8}"), flush=True)

    for motion, design in DESIGNS.items():
        for rtol in (1e-10, 1e-9, 1e-6, 1e-5):
            row(f"worst over the band, {motion}, rtol {rtol:g}, ms", 1e3, lambda p: values(p, directory, design, rtol))
    exact, loose = (lambda p, rtol=rtol: surf(p, directory, {}, rtol) for rtol in (1e-10, 1e-4))
    row(f"a run of a surf of {POINTS**4}, rtol 1e-10, ms", 1e3, exact)
    row(f"a run of a surf of {POINTS**4}, rtol 1e-4, ms", 1e3, loose)
    row("the same at 1e-4 up to 200 J, beside the 1e-10 of then, ms", 1e3, lambda p: surf(p, directory, COARSE, 1e-10), exact)
    for name in ("retune-ssvi", "retune-ssvi-free", "ssvi", "ssvi-global"):
        row(f"optimize {name}, as committed, s", 1, lambda p: search(p, directory, name)[0])
    row("design of the README's footbridge, s", 1, lambda p: command(p, directory, BRIDGE))
    row("certify results/ssvi, s", 1, lambda p: command(p, directory, ["certify", ROOT / "results/ssvi", "--out", "out"]))


def tolerances(program, directory):
    """What a search finds at its own tolerance, and how its end differs from that at the tightest."""
    head = "".join(f"{'s, ' + stage:>21}{'E1max, J':>12}{'change':>9}" for stage, *_ in STAGES)
    print(f"\n{'search':<14}{head}")
    for name in SEARCHES:
        ends = [search(program, directory, name, coarse, search_rtol=rtol) for _, rtol, coarse in STAGES]
        tightest = ends[0][1]
        print(f"{name:<14}" + "".join(f"{took:>21.2f}{e1:>12.6f}{e1 / tightest - 1:>+9.1e}" for took, e1 in ends), flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", nargs=2, type=Path)
    parser.add_argument("--repeats", type=int, default=5)
    given = parser.parse_args()
    programs = [program.resolve() for program in given.programs]
    print(f"`just lab bench`: processor time on one thread, commit {commit(programs[0])} beside {commit(programs[1])}\n{machine()}\n")
    with tempfile.TemporaryDirectory() as directory:
        compare(programs, directory, given.repeats)
        tolerances(programs[0], directory)


if __name__ == "__main__":
    main()
