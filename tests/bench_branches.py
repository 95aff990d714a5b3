"""Times the branches of two dampers on one core beside what a sampled search does: runs from rest at 3001 frequencies (`just lab bench-branches`).

Each pair is run in turns, three times; the least times count.
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time


def seconds(*command):
    begin = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begin


def main(retune):
    print(f"{'damper':<18} {'branches, s':>12} {'3001 runs, s':>13} {'ratio':>6} {'stable motions, J':>18} {'runs, J':>8}")
    for damper in ("results/ssvi", "studies/ssvi.json"):
        with tempfile.TemporaryDirectory() as place:
            out = {job: pathlib.Path(place) / job for job in ("branches", "sweep")}
            common = ("--from", "5", "--to", "8", "--threads", "1", "--replace", "--quiet")
            least = {job: float("inf") for job in out}
            for _ in range(3):
                for job, more in (("branches", ()), ("sweep", ("--over", "omega", "--points", "3001"))):
                    took = seconds(retune, job, damper, *more, *common, "--out", out[job])
                    least[job] = min(least[job], took)
            found = json.loads((out["branches"] / "branches.json").read_text())["branches"]
            most = max(branch["largest_stable"]["E1max"] for branch in found if branch["largest_stable"])
            with open(out["sweep"] / "sweep.csv", newline="") as table:
                sampled = max(float(row["E1max"]) for row in csv.DictReader(table))
        ratio = least["branches"] / least["sweep"]
        print(f"{damper:<18} {least['branches']:12.2f} {least['sweep']:13.2f} {ratio:6.2f} {most:18.1f} {sampled:8.1f}")


if __name__ == "__main__":
    main(sys.argv[1])
