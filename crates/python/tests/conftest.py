"""The studies and problems of the tests."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import retune as rt

ROOT = Path(__file__).resolve().parents[3]
STUDIES = ROOT / "studies"


@pytest.fixture(scope="session")
def program() -> Path:
    """The command line that the package must agree with."""
    path = Path(os.environ.get("RETUNE", ROOT / "target" / "release" / "retune"))
    assert path.is_file(), f"{path} is not there: build it with `cargo build --release`, or name it in RETUNE"
    return path


@pytest.fixture(scope="session")
def tmd() -> rt.Problem:
    """A tuned mass damper without walls, steady, in closed form."""
    return rt.Problem(
        rt.Structure(m1=1000, c1=452, k1=3.95e4),
        rt.TMD(60, k2=1900, c2=150),
        P=800,
        band=(5, 8),
        vary=["k2", "c2"],
        bounds={"k2": (10, 4000), "c2": (0, 1000)},
        response="steady",
    )


@pytest.fixture(scope="session")
def ssvi() -> rt.Problem:
    """The paper's SSVI NES at one frequency, with limits."""
    return rt.Problem(
        rt.Structure(m1=1000, c1=452, k1=3.95e4),
        rt.SSVI(60, k2=215, c2=232, D=0.06, C=0.36),
        P=800,
        omega=6.28,
        window=(50, 100),
        vary=["k2", "c2", "D", "C"],
        bounds={"k2": (10, 600), "c2": (1, 1000), "D": (0, 1), "C": (0, 2)},
        limits={"stroke": 0.35, "contact_force": 2e4},
    )


def designs(problem: rt.Problem, count: int, seed: int = 1) -> np.ndarray:
    """Designs within the bounds of a problem."""
    low, high = np.array(problem.bounds).T
    return low + (high - low) * np.random.default_rng(seed).random((count, len(low)))
