#!/usr/bin/env python3
"""Measures what docs/scale.md plans with, on this machine.

    python3 deploy/measure_scale.py target/release/retune
"""

import json
import os
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
RETUNE = str(Path(sys.argv[1]).resolve())


def study(name, points, end=None):
    study = json.loads((HERE.parent / "studies" / "ssvi-resonance.json").read_text())
    study.pop("$schema", None)
    study["name"] = name
    for axis, count in zip(study["optimize"]["surf"].values(), points):
        axis["points"] = count
    study["optimize"]["refine"] = {"MaxFunEvals": 20}
    if end:
        study["window"] = {"t0": 0, "T": end}
    Path(f"{name}.json").write_text(json.dumps(study))


def run(*arguments):
    """Seconds, and the largest memory in MiB."""
    begun = time.monotonic()
    process = os.spawnv(os.P_NOWAIT, RETUNE, ["retune", *arguments, "--quiet"])
    _, status, usage = os.wait4(process, 0)
    assert status == 0, arguments
    return time.monotonic() - begun, usage.ru_maxrss / 1024


def size(pattern):
    return sum(path.stat().st_size for path in Path().glob(pattern))


def main():
    sys.stdout = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what the program says

    study("long", [12, 12, 12, 12])
    runs = 12 ** 4
    seconds, _ = run("optimize", "long.json", "--out", "long", "--shard", "1/1", "--threads", "1")
    print(f"a run of the SSVI study (100 s of motion), one core: {1e3 * seconds / runs:.3f} ms")
    print(f"a part: {size('long/parts/*.part') / runs:.1f} bytes a run")

    count = 200
    begun = time.monotonic()
    for i in range(1, count + 1):
        run("optimize", "long.json", "--out", "empty", "--shard", f"{i}/1000000", "--threads", "1")
    print(f"a task without runs (start, lock, journal, part on disk): {1e3 * (time.monotonic() - begun) / count:.1f} ms")

    for name, points in [("small", [10, 10, 10, 10]), ("large", [100, 10, 10, 100])]:
        study(name, points, end=0.1)
        runs = points[0] * points[1] * points[2] * points[3]
        seconds, memory = run("optimize", f"{name}.json", "--out", name, "--shard", "1/1")
        print(f"a share of {runs} runs of 0.1 s: {1e6 * seconds / runs:.1f} us a run on {os.cpu_count()} cores, {memory:.0f} MiB")
        seconds, memory = run("merge", f"{name}.json", "--out", name)
        print(f"its merge and 20 evaluations more: {seconds:.1f} s, {memory:.0f} MiB, surf.csv {size(f'{name}/surf.csv') / runs:.1f} bytes a run")

    try:
        from hyperqueue import Job
        from hyperqueue.cluster import LocalCluster, WorkerConfig
    except ImportError:
        print("HyperQueue is not installed: its figure is left out")
        return
    with LocalCluster() as cluster:
        for _ in range(2):
            cluster.start_worker(WorkerConfig(cores=1))
        count = 2000
        job = Job(default_workdir=Path.cwd(), max_fails=None)
        for _ in range(count):
            job.program(["/bin/true"], stdout=None, stderr=None)
        client = cluster.client()
        begun = time.monotonic()
        client.wait_for_jobs([client.submit(job)])
        print(f"HyperQueue, two workers on this machine: {count / (time.monotonic() - begun):.0f} tasks of /bin/true a second")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as directory:
        os.chdir(directory)
        main()
