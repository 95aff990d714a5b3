"""Times what people wait for beside an earlier version: values over a band, and whole searches.

    python3 tests/job.py RETUNE BASE [--repeats N]

RETUNE and BASE are the programs of two versions. Times are those of the processor, one thread, the least of N turns taken one after the other.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Designs in the order k2 c2 D C: that of results/ssvi, whose motions are regular, and Table 2's, where they are not.
DESIGNS = {"regular": "583.92142 94.97052 0.02885 1.10454", "irregular": "215 232 0.06 0.36"}
# Values in one process, so that its start counts for little.
VALUES = 40


def seconds(command, text=None):
    """Processor time of a command, s, and its first line."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, input=text, text=True, capture_output=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, done.stdout.partition("\n")[0]


def study(name, directory, old, **solver):
    """A study of ours as a version takes it."""
    study = json.loads((ROOT / f"studies/{name}.json").read_text())
    study.pop("$schema")
    study["solver"] = {**study.get("solver", {}), **solver}
    if old:
        study.pop("kind")
        study["solver"].pop("search_rtol", None)
    file = directory / f"{name}-{'old' if old else 'new'}.json"
    file.write_text(json.dumps(study))
    return file


def rows(programs, directory, repeats):
    """What is timed: a name, and the time of each version."""
    for motion, design in DESIGNS.items():
        for rtol in (1e-10, 1e-9, 1e-6, 1e-5):
            files = [study("ssvi", directory, old, rtol=rtol) for old in (False, True)]
            turn = lambda: [seconds([program, "evaluate", file, "--threads", "1"], f"{design}\n" * VALUES)
                            for program, file in zip(programs, files)]
            turns = [turn() for _ in range(repeats)]
            yield f"worst over the band, {motion}, rtol {rtol:g}, ms", [1e3 / VALUES * min(t[i][0] for t in turns) for i in (0, 1)]
    for name in ("ssvi", "ssvi-global"):
        for what, solver in (("as committed", {}), ("search_rtol 1e-6", {"search_rtol": 1e-6})):
            times = []
            for number, program in enumerate(programs):
                file = study(name, directory, number == 1, **solver)
                out = directory / f"{name}-{number}-{len(solver)}"
                times.append(seconds([program, "optimize", file, "--out", out, "--threads", "1"])[0])
            yield f"optimize {name}, {what}, s", times


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", nargs=2, type=Path)
    parser.add_argument("--repeats", type=int, default=5)
    given = parser.parse_args()
    print("`just bench-job`: processor time on one thread, beside commit f3d2d61; the certificate of today follows other motions, too\n")
    print(f"{'':<56}{'today':>10}{'f3d2d61':>10}{'ratio':>8}")
    with tempfile.TemporaryDirectory() as directory:
        for name, (today, base) in rows([program.resolve() for program in given.programs], Path(directory), given.repeats):
            print(f"{name:<56}{today:>10.2f}{base:>10.2f}{base / today:>8.2f}", flush=True)


if __name__ == "__main__":
    main()
