"""A grid of a million designs on dask.distributed, one of whose workers is killed on the way: the bytes of one process.

    python dask_sweep.py [--points 1000] [--threads 1]

A problem is pickled with each chunk, and a chunk depends on its number alone. Any cluster takes the place of the LocalCluster.
"""

import argparse
import hashlib
import os
import signal
import time

import numpy as np
from dask.distributed import Client, LocalCluster, as_completed

import retune as rt

PROBLEM = rt.Problem(
    rt.Structure(m1=1000, c1=452, k1=3.95e4),
    rt.TMD(60, k2=1900, c2=150),
    P=800,
    window=(50, 100),
    band=(5, 8),
    vary=["k2", "c2"],
    bounds={"k2": (500, 4000), "c2": (10, 1000)},
    response="steady",
)


def chunk(problem: rt.Problem, points: int, row: int) -> bytes:
    """The values of a row of the grid."""
    (k2_from, k2_to), (c2_from, c2_to) = problem.bounds
    k2 = k2_from + (k2_to - k2_from) * row / (points - 1)
    X = np.column_stack([np.full(points, k2), np.linspace(c2_from, c2_to, points)])
    return problem.batch(X, threads=1).value.tobytes()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=1000, help="along each axis")
    points: int = parser.parse_args().points

    begun = time.perf_counter()
    alone = [chunk(PROBLEM, points, row) for row in range(points)]
    took = time.perf_counter() - begun
    print(f"{points * points} designs in one process: {took:.1f} s")

    begun = time.perf_counter()
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster, Client(cluster) as client:
        rows = {client.submit(chunk, PROBLEM, points, row, pure=False): row for row in range(points)}
        found: dict[int, bytes] = {}
        for future in as_completed(rows):
            found[rows[future]] = future.result()
            if len(found) == max(points // 4, 1):
                victim = client.run(os.getpid).popitem()[1]
                os.kill(victim, signal.SIGKILL)
                print(f"{len(found)} of {points} chunks are done: a worker is killed")
    print(f"two processes: {time.perf_counter() - begun:.1f} s, with the start of the cluster")

    together = [found[row] for row in range(points)]
    assert together == alone, "every byte is that of one process"
    values = np.frombuffer(b"".join(together))
    best = divmod(int(values.argmin()), points)
    print(f"the same bytes: SHA-256 {hashlib.sha256(values.tobytes()).hexdigest()[:16]}; least {values.min():.3f} J at point {best}")


if __name__ == "__main__":
    main()
