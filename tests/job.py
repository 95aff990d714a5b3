"""Times what people wait for beside an earlier version: values over a band, a grid of runs, whole searches; and what a looser tolerance of a
search changes of its result.

    python3 tests/job.py RETUNE BASE [--repeats N] [--build]
    python3 tests/job.py RETUNE BASE --fronts

RETUNE and BASE are the programs of two versions, each in target/release of its checkout. Times are those of the processor, one thread; of values the
least of N turns taken one after the other. With --build also the wall clock of a build of either from clean. With --fronts only the wall
clock of fronts by the plan and the studies of BASE, and what either finds.
"""

import argparse
import csv
import json
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
# Studies whose searches are made with and without a tolerance of their own, and with a coarse grid: name, search_rtol, coarse.
SEARCHES = ("ssvi", "ssvi-global", "ssvi-robust", "ssvi-resonance", "tmd-free", "tmd-resonance")
STAGES = (("1e-10", 1e-10, {}), ("1e-8", 1e-8, {}), ("1e-8, coarse", 1e-8, {"rtol": 1e-4, "peaks": False}), ("1e-6", 1e-6, {}))


def seconds(command, text=None):
    """Processor time of a command, s, and its first line."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, input=text, text=True, capture_output=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, done.stdout.partition("\n")[0]


def study(name, directory, old, coarse=None, **solver):
    """A study of ours as a version takes it, its grid coarse as given."""
    study = json.loads((ROOT / f"studies/{name}.json").read_text())
    study.pop("$schema")
    study["solver"] = {**study.get("solver", {}), **solver}
    if coarse is not None:
        study["optimize"]["coarse"] = coarse
    if old:
        study.pop("kind")
        study["optimize"].pop("coarse", None)
        study["solver"].pop("search_rtol", None)
    file = directory / f"{name}-{'old' if old else 'new'}.json"
    file.write_text(json.dumps(study))
    return file


def values(name, designs, programs, directory, repeats, **solver):
    """Time of a value, ms, by either version."""
    files = [study(name, directory, old, **solver) for old in (False, True)]
    text = "".join(f"{design}\n" for design in designs)

    def turn(program, file):
        return seconds([program, "evaluate", file, "--threads", "1"], text)[0]

    turns = [[turn(*pair) for pair in zip(programs, files)] for _ in range(repeats)]
    return [1e3 / len(designs) * min(times) for times in zip(*turns)]


def run_of_a_surf(program, directory, old, coarse, **solver):
    """Time of a run of a `surf`, ms: a grid alone, as one share of itself."""
    file = study("ssvi-resonance", directory, old, coarse, **solver)
    said = json.loads(file.read_text())
    axis = lambda first, last, scale: {"from": first, "to": last, "points": POINTS, "scale": scale}
    said["optimize"]["surf"] = {name: axis(*ends) for name, ends in RANGES.items()}
    file.write_text(json.dumps(said))
    out = Path(tempfile.mkdtemp(dir=directory)) / "surf"
    took, _ = seconds([program, "optimize", file, "--shard", "1/1", "--out", out, "--threads", "1"])
    return 1e3 * took / POINTS**4


def search(program, name, directory, old=False, coarse=None, **solver):
    """Time of a search, s, and the E1max that it ends with, J."""
    out = Path(tempfile.mkdtemp(dir=directory)) / name
    took, _ = seconds([program, "optimize", study(name, directory, old, coarse, **solver), "--out", out, "--threads", "1"])
    return took, json.loads((out / "optimum.json").read_text())["E1max"]


def commit(program):
    """The commit of the checkout in which a program was built."""
    command = ["git", "-C", program.parents[2], "rev-parse", "--short=7", "HEAD"]
    return subprocess.run(command, text=True, capture_output=True, check=True).stdout.strip()


def compare(programs, directory, repeats):
    """Both versions."""
    print(f"{'':<56}{'today':>10}{commit(programs[1]):>10}{'ratio':>8}")

    def row(name, times):
        print(f"{name:<56}{times[0]:>10.3f}{times[1]:>10.3f}{times[1] / times[0]:>8.2f}", flush=True)

    for motion, design in DESIGNS.items():
        took = {}
        for rtol in (1e-10, 1e-9, 1e-6, 1e-5):
            took[rtol] = values("ssvi", [design] * VALUES, programs, directory, repeats, rtol=rtol)
            row(f"worst over the band, {motion}, rtol {rtol:g}, ms", took[rtol])
        row("the same at 1e-5, beside the 1e-10 of then, ms", [took[1e-5][0], took[1e-10][1]])
    turns = {}
    for turn in range(max(1, repeats // 2)):
        for of, (coarse, rtol) in {"exact": ({}, 1e-10), "loose": ({}, 1e-4), "coarse": (COARSE, 1e-10)}.items():
            for old, program in ((False, programs[0]), (True, programs[1])):
                if not (old and of == "coarse"):
                    took = run_of_a_surf(program, directory, old, coarse, rtol=rtol)
                    turns[of, old] = min(took, turns.get((of, old), took))
    row(f"a run of a surf of {POINTS**4}, rtol 1e-10, ms", [turns["exact", False], turns["exact", True]])
    row(f"a run of a surf of {POINTS**4}, rtol 1e-4, ms", [turns["loose", False], turns["loose", True]])
    row("the same at 1e-4 up to 200 J, beside the 1e-10 of then, ms", [turns["coarse", False], turns["exact", True]])
    for name in ("retune-ssvi", "retune-ssvi-free"):
        base, _ = search(programs[1], name, directory, old=True)
        row(f"optimize {name}, as committed, s", [search(programs[0], name, directory)[0], base])
    for name in ("ssvi", "ssvi-global"):
        base, _ = search(programs[1], name, directory, old=True)
        row(f"optimize {name}, as committed, s", [search(programs[0], name, directory)[0], base])
        exact = search(programs[0], name, directory, coarse={}, search_rtol=1e-8)[0]
        row(f"optimize {name}, all at 1e-8 today, s", [exact, base])


def tolerances(program, directory):
    """What a search finds at its own tolerance, and how its end differs from that at the tightest."""
    head = "".join(f"{'s, ' + stage:>21}{'E1max, J':>12}{'change':>9}" for stage, *_ in STAGES)
    print(f"\n{'search':<14}{head}")
    for name in SEARCHES:
        ends = [search(program, name, directory, coarse=coarse, search_rtol=rtol) for _, rtol, coarse in STAGES]
        tightest = ends[0][1]
        print(f"{name:<14}" + "".join(f"{took:>21.2f}{e1:>12.6f}{e1 / tightest - 1:>+9.1e}" for took, e1 in ends), flush=True)


def build(programs, directory):
    """Wall clock of a build from clean: `cargo build --release --package retune` beside where each program was built."""
    took = []
    for number, program in enumerate(programs):
        command = ["cargo", "build", "--release", "--quiet", "--package", "retune", "--target-dir", directory / f"build-{number}"]
        begin = time.perf_counter()
        subprocess.run(command, cwd=program.parents[2], check=True)
        took.append(time.perf_counter() - begin)
    print(f"\n{'a build from clean, s, two cores':<56}{took[0]:>10.0f}{took[1]:>10.0f}{took[1] / took[0]:>8.2f}")


def fronts(programs, directory):
    """Wall clock of fronts by the plan of the earlier version and of what they find: the E1max of the SSVI NES under each bound on k2. Searches of
    today's version are as coarse as in its own studies; the searches alone, without the files of certificates and with them, and with all descents
    after them."""
    studies, took, found = programs[1].parents[2] / "studies", [], []
    today, then = programs
    bare, searches = {"rounds": 0, "certificates": 0}, {"rounds": 0}
    columns = {"searches": (today, bare), "certified": (today, searches), "descents": (today, {}), "then": (then, {"certificates": 0}), commit(then): (then, {})}
    for number, (program, said) in enumerate(columns.values()):
        place = directory / str(number)
        place.mkdir()
        for name in ("fronts", "fronts-tmd", "fronts-ssvi"):
            plan = json.loads((studies / f"{name}.json").read_text())
            plan.pop("$schema")
            if name == "fronts":
                plan |= said
            if program == today:
                plan["kind"] = "fronts" if name == "fronts" else "study"
                if name != "fronts":
                    plan["solver"] = {**plan.get("solver", {}), "search_rtol": 1e-6}
                if name == "fronts-ssvi":
                    plan["optimize"]["coarse"] = {"rtol": 1e-4, "peaks": False}
            (place / f"{name}.json").write_text(json.dumps(plan))
        begin = time.perf_counter()
        subprocess.run([program, "fronts", place / "fronts.json", "--out", place / "out"], capture_output=True, check=True)
        took.append(time.perf_counter() - begin)
        with open(place / "out/k2.csv", newline="") as table:
            rows = [row for row in csv.DictReader(table) if row["damper"] == "SSVI NES"]
        found.append({float(row["k2_most"]): float(row["E1max"]) for row in rows})
    print(f"`just lab bench-fronts`: fronts by the plan of commit {commit(programs[1])}, all cores\n")
    print(f"{'':<42}" + "".join(f"{name:>10}" for name in columns))
    print(f"{'wall clock, s':<42}" + "".join(f"{wall:>10.1f}" for wall in took))
    against = [3, 4, 4, 3, 4]  # "then" and the searches alone make no certificate of the best
    print(f"{'times as fast as then':<42}" + "".join(f"{took[other] / wall:>10.2f}" for wall, other in zip(took, against)))
    for bound in found[-1]:
        print(f"{f'SSVI NES, k2 at most {bound:g} N/m: E1max, J':<42}" + "".join(f"{of[bound]:>10.1f}" for of in found))


def peers():
    """The time of a run to an error of E1max by the best of other programs, and by ours, of `results/accuracy`."""
    errors = {}
    with open(ROOT / "results/accuracy/runs.csv", newline="") as table:
        for row in csv.DictReader(table):
            if not row["failure"]:
                key = (row["scene"], row["program"], row["method"], row["contacts"])
                errors.setdefault(key, []).append((float(row["seconds"]), float(row["E1max_error"])))
    print(f"\n{'a run, results/accuracy':<24}{'error':>7}{'ms':>9}{'best peer, ms':>15}{'ratio':>8}  which")
    for scene in dict.fromkeys(scene for scene, *_ in errors):
        for level in (1e-6, 1e-9):
            best = {}
            for (of, program, method, _), runs in errors.items():
                # An error counts only if no tighter setting has a larger one.
                sure = [time for i, (time, _) in enumerate(runs) if max(error for _, error in runs[i:]) <= level]
                if of == scene and sure and (program != "retune" or method == "hybrid"):
                    name = program if program == "retune" else f"{program} {method}"
                    best[name] = min(min(sure), best.get(name, float("inf")))
            own = best.pop("retune")
            peer = min(best, key=best.get, default=None)
            cells = f"{1e3 * best[peer]:>15.4f}{best[peer] / own:>8.1f}  {peer}" if peer else f"{'-':>15}{'-':>8}  none gets there"
            print(f"{scene:<24}{level:>7.0e}{1e3 * own:>9.4f}{cells}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", nargs=2, type=Path)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--build", action="store_true", help="time builds of both from clean, too")
    parser.add_argument("--fronts", action="store_true", help="only fronts, by the plan of BASE")
    given = parser.parse_args()
    programs = [program.resolve() for program in given.programs]
    if given.fronts:
        with tempfile.TemporaryDirectory() as directory:
            return fronts(programs, Path(directory))
    print(f"`just lab bench-job`: processor time on one thread, beside commit {commit(programs[1])}; the certificate of today follows other motions, too\n")
    with tempfile.TemporaryDirectory() as directory:
        compare(programs, Path(directory), given.repeats)
        tolerances(programs[0], Path(directory))
        if given.build:
            build(programs, Path(directory))
    peers()


if __name__ == "__main__":
    main()
