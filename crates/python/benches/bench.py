"""What the Python package costs beside Rust, and what it saves beside SciPy. Each comparison is made in many short turns, and the least times
are compared: the machine may have other work, which only ever adds.

    just lab bench-python
"""

from __future__ import annotations

import json
import os
import platform
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy

import retune as rt

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "reference" / "external"))
import scipy_methods  # noqa: E402

TURNS = 15


def least(*calls: Callable[[], object], turns: int = TURNS) -> list[float]:
    """The least time of each, s, taken in turns."""
    times = [[] for _ in calls]
    for _ in range(turns):
        for call, own in zip(calls, times):
            begun = time.perf_counter()
            call()
            own.append(time.perf_counter() - begun)
    return [min(own) for own in times]


def in_rust(problem: rt.Problem, X: np.ndarray, threads: int, turns: int = TURNS) -> Callable[[], float]:
    """The least time of the same batch without Python, s."""
    file = Path(tempfile.mkdtemp()) / "study.json"
    file.write_text(json.dumps(problem.study))
    lines = "\n".join(" ".join(repr(float(value)) for value in row) for row in X)
    program = ROOT / "target" / "wheel" / "examples" / "rust_batch"

    def measure() -> float:
        command = [program, file, str(threads), str(turns)]
        said = subprocess.run(command, input=lines, capture_output=True, text=True, check=True).stdout.split()
        values = problem.batch(X).value
        assert abs(float(said[1]) / values.sum() - 1) < 1e-9, "the same designs"
        return float(said[0])

    return measure


def designs(problem: rt.Problem, count: int) -> np.ndarray:
    low, high = np.array(problem.bounds).T
    return low + (high - low) * np.random.default_rng(1).random((count, len(low)))


def row(name: str, value: str, wanted: str) -> None:
    print(f"{name:<58}{value:>22}   {wanted}", flush=True)


def batches(name: str, problem: rt.Problem, count: int, rounds: int, turns: int) -> None:
    X = designs(problem, count)
    for threads in (1, 2):
        rust = python = np.inf
        measure = in_rust(problem, X, threads, turns)
        for _ in range(rounds):
            rust = min(rust, measure())
            python = min(python, *least(lambda: problem.batch(X, threads=threads), turns=turns))
        row(f"batch of {count} {name}, {threads} thread{'s'[: threads - 1]}: over Rust", f"{python / rust - 1:+.1%} of {rust * 1e3:.1f} ms", "at most +5 %")


def main() -> None:
    structure = rt.Structure(m1=1000, c1=452, k1=3.95e4)
    bounds = {"k2": (100, 600), "c2": (20, 400), "D": (0.02, 0.24), "C": (0.06, 0.78)}
    tmd = rt.Problem(
        structure,
        rt.TMD(60, k2=1900, c2=150),
        P=800,
        window=(50, 100),
        band=(5, 8),
        vary=["k2", "c2"],
        bounds={"k2": (500, 4000), "c2": (10, 1000)},
        response="steady",
    )
    ssvi = rt.Problem(structure, rt.SSVI(60, k2=215, c2=232, D=0.06, C=0.36), P=800, omega=6.28, window=(50, 100), vary=list(bounds), bounds=bounds)

    print("What the Python package costs, and what it saves: `just test-python && just lab bench-python`\n")
    print(f"retune {rt.__version__}, Python {platform.python_version()}, numpy {np.__version__}, SciPy {scipy.__version__}")
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the beginning; least times, taken in turns\n")

    batches("TMD (steady over a band)", tmd, 10_000, 60, 5)
    batches("SSVI NES (runs of 100 s)", ssvi, 10_000, 5, 1)

    x = np.array(tmd.start)
    many = 20_000
    one = in_rust(tmd, np.tile(x, (many, 1)), 1, 3)
    rust = python = np.inf
    for _ in range(5):
        rust = min(rust, one())
        python = min(python, *least(lambda: [tmd(x) for _ in range(many)], turns=3))
    row("one evaluation of a TMD: over Rust", f"{(python - rust) / many * 1e6:.2f} us of {rust / many * 1e6:.2f} us", "at most 3 us")

    X = designs(ssvi, 100)

    def on_threads(count: int) -> None:
        ahead = iter(X)  # each thread takes the next design: some cost ten times as much as others

        def work() -> None:
            for design in ahead:
                ssvi(design)

        threads = [threading.Thread(target=work) for _ in range(count)]
        [thread.start() for thread in threads]
        [thread.join() for thread in threads]

    one_thread, two_threads = least(lambda: on_threads(1), lambda: on_threads(2), turns=200)
    row("100 SSVI NES one by one: two Python threads beside one", f"{one_thread / two_threads:.2f} x", "at least 1.8 x")
    alone, both = least(lambda: ssvi.batch(X, threads=1), lambda: ssvi.batch(X, threads=2), turns=200)
    row("100 SSVI NES in a batch: threads=2 beside threads=1", f"{alone / both:.2f} x", "at least 1.8 x")

    code = "import time, numpy; begun = time.perf_counter(); import retune; print(time.perf_counter() - begun)"
    whole = code.replace("time, numpy", "time")
    for words, text in (("numpy included", whole), ("after numpy", code)):
        took = min(float(subprocess.run([sys.executable, "-c", text], capture_output=True, check=True).stdout) for _ in range(7))
        row(f"import retune, {words}", f"{took:.3f} s", "at most 0.15 s")
    (wheel,) = (ROOT / "target" / "wheels").glob("retune_dampers-*.whl")
    row("wheel", f"{wheel.stat().st_size / 1e6:.2f} MB", "at most 5 MB")

    peaks = []
    for _ in range(3):
        for design in np.tile(x, (10**6 // 3, 1)):
            tmd(design)
        peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
    row("peak memory after 1/3, 2/3 and all of 10^6 evaluations", " ".join(f"{peak:.1f}" for peak in peaks) + " MB", "flat")

    print("\nE1max of the paper's SSVI NES from rest to 20 s, beside the same in SciPy (contacts as terminal events)\n")
    scenes = {scene["scene"]: scene for scene in json.loads((ROOT / "tests/reference/external/scenes.json").read_text())}
    scene = scenes["two-sided"]
    parts = rt.SSVI(scene["m2"], k2=scene["k2"], c2=scene["c2"], D=scene["D"], C=scene["C"])
    same = rt.Problem(structure, parts, P=scene["P"], omega=scene["omega"], window=(0, scene["T"]), vary=["k2"], bounds={"k2": (1, 9999)})
    design = np.array(same.start)
    (own,) = least(lambda: same(design), turns=50)
    value = same(design)
    print(f"{'':<28}{'time':>12}{'E1max, J':>16}{'difference':>14}{'times as long':>16}")
    print(f"{'Retune, rtol 1e-10':<28}{own * 1e3:>9.3f} ms{value:>16.6f}{'':>14}{1:>16}")
    for method in ("DOP853", "Radau"):
        for rtol in (1e-6, 1e-9):
            found = []

            def by_scipy() -> None:
                _, best, _, _, pieces = scipy_methods.run(scene, scipy_methods.scipy_piece, method, rtol)
                found.append((best, pieces))

            (took,) = least(by_scipy, turns=3)
            energy = scipy_methods.e1max(scene, *found[-1])
            print(f"{f'SciPy {method}, rtol {rtol:.0e}':<28}{took * 1e3:>9.1f} ms{energy:>16.6f}{energy - value:>14.1e}{took / own:>16.0f}", flush=True)


if __name__ == "__main__":
    main()
