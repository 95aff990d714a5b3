#!/usr/bin/env python3
"""Tunes a study on many machines with HyperQueue (pip install hyperqueue): the shares of its grid as tasks, then one merge.

    python3 deploy/on_hyperqueue.py studies/ssvi.json --shards 64 --server-dir ~/.hq-server/hq-current   # a running HyperQueue
    python3 deploy/on_hyperqueue.py studies/ssvi.json --shards 8 --local 2                               # two workers here

The directory of the results must be one that all workers see. Whatever dies on the way, start the same command again: parts
that are there are kept, shares that were begun go on, and the merge refuses anything that is not complete.
"""

import argparse
import subprocess
import sys
from pathlib import Path

from hyperqueue import Job
from hyperqueue.client import Client
from hyperqueue.cluster import LocalCluster, WorkerConfig
from hyperqueue.ffi.protocol import ResourceRequest


def submit(client, options):
    """Submits one task for each share and waits for all of them; says whether all came to their end."""
    parts = options.out / "parts"
    parts.mkdir(parents=True, exist_ok=True)
    job = Job(default_workdir=Path.cwd(), max_fails=None, name=f"retune {options.study.name}")
    for i in range(1, options.shards + 1):
        job.program(
            [
                options.retune, "optimize", str(options.study), "--out", str(options.out),
                "--shard", f"{i}/{options.shards}", "--threads", str(options.cpus), "--quiet", "--resume",
            ],
            stdout=str(parts / f"log-{i:05}.txt"),
            stderr=str(parts / f"log-{i:05}.err.txt"),
            resources=ResourceRequest(cpus=options.cpus),
            crash_limit=10,
        )
    return client.wait_for_jobs([client.submit(job)], raise_on_error=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", type=Path)
    parser.add_argument("--shards", type=int, required=True, help="number of shares; a minute of work each is a good size")
    parser.add_argument("--out", type=Path, help="directory of the results [default: results/<name of the study file>]")
    parser.add_argument("--cpus", type=int, default=1, help="cores of a task")
    parser.add_argument("--retune", default="retune", help="the program")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--server-dir", type=Path, help="directory of a running HyperQueue server")
    where.add_argument("--local", type=int, metavar="WORKERS", help="start this many workers on this machine")
    options = parser.parse_args()
    options.out = options.out or Path("results") / options.study.stem

    if options.server_dir:
        done = submit(Client(options.server_dir), options)
    else:
        with LocalCluster() as cluster:
            for _ in range(options.local):
                cluster.start_worker(WorkerConfig(cores=options.cpus))
            done = submit(cluster.client(), options)
    if not done:
        print("some shares failed: see log-*.err.txt beside the parts, then start this command again", file=sys.stderr)
    return subprocess.run([options.retune, "merge", options.study, "--out", options.out, "--resume"]).returncode


if __name__ == "__main__":
    sys.exit(main())
