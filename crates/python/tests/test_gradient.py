"""Derivatives: exact, of the value that the problem has, and of use to SciPy."""

from __future__ import annotations

import json

import numpy as np
import pytest
from conftest import STUDIES, designs
from scipy.optimize import approx_fprime, minimize

import retune as rt


def differences(problem: rt.Problem, x: np.ndarray, share: float) -> np.ndarray:
    """Central differences, extrapolated once."""

    def central(h: float) -> np.ndarray:
        ends = [[problem([*x[:i], x[i] * (1 + sign * h), *x[i + 1 :]]) for sign in (1, -1)] for i in range(len(x))]
        return np.array([(above - below) / (2 * h * value) for (above, below), value in zip(ends, x)])

    return np.asarray((4 * central(share / 2) - central(share)) / 3)


def test_reference_derivatives_are_those_of_the_value(tmd: rt.Problem, ssvi: rt.Problem) -> None:
    for x in designs(tmd, 20):
        value, gradient = tmd.value_and_gradient(x)
        assert value == tmd(x) and gradient.tolist() == tmd.gradient(x).tolist()
        np.testing.assert_allclose(gradient * x, differences(tmd, x, 1e-4) * x, rtol=1e-5, atol=1e-7 * value)
    # A design that strikes, in its first periods, at one frequency and over the band; with a limit that holds, one that does not.
    short = json.loads(json.dumps(ssvi.study))
    short["window"] = {"t0": 2, "T": 8}
    for omega in (None, {"from": 5, "to": 8, "samples": 31}):
        for limits in ({}, {"stroke": 9}, {"stroke": 0.2}):
            short["optimize"]["objective"], short["optimize"]["limits"] = {"omega": omega}, limits
            problem = rt.Problem.from_study(short)
            x = np.array(problem.start)
            value, gradient = problem.value_and_gradient(x)
            assert value == problem(x) and (value > 1e100) == (limits == {"stroke": 0.2})
            np.testing.assert_allclose(gradient * x, differences(problem, x, 1e-5) * x, atol=1e-5 * value)


def test_contract_scipy_descends_by_derivatives(tmd: rt.Problem) -> None:
    exact = minimize(tmd.value_and_gradient, tmd.start, jac=True, bounds=tmd.bounds, method="SLSQP")
    other = minimize(tmd, tmd.start, jac=tmd.gradient, bounds=tmd.bounds, method="SLSQP")
    assert exact.fun == pytest.approx(160.605, abs=1e-3) and exact.nfev < 60
    assert other.x.tolist() == exact.x.tolist() and other.njev == exact.njev


def test_contract_a_limit_is_a_constraint_with_derivatives() -> None:
    """The stroke as a problem of its own, with a gradient of its own."""
    study = json.loads((STUDIES / "tmd-free.json").read_text())
    del study["$schema"]
    energy = rt.Problem.from_study(study)
    study["optimize"]["objective"]["quantity"] = "stroke"
    stroke = rt.Problem.from_study(study)
    # What is made small is known, though no limit asks for it.
    found = stroke.evaluate(stroke.start)
    assert found.stroke == found.largest == found.value == stroke(stroke.start)
    assert stroke.batch([stroke.start])["stroke"][0] == found.stroke
    held = {"type": "ineq", "fun": lambda x: 0.15 - stroke(x), "jac": lambda x: -stroke.gradient(x)}
    found = minimize(energy.value_and_gradient, [2000, 300], jac=True, bounds=energy.bounds, constraints=[held], method="SLSQP")
    assert found.success and stroke(found.x) == pytest.approx(0.15, abs=1e-6), "the limit binds"
    limited = rt.Problem.from_study({**energy.study, "optimize": {**energy.study["optimize"], "limits": {"stroke": 0.15 * (1 + 1e-6)}}})
    best = minimize(limited, found.x, method="Nelder-Mead", options={"xatol": 1e-6, "fatol": 1e-9, "maxfev": 2000})
    assert found.fun == pytest.approx(best.fun, rel=1e-4), "so does a search without derivatives"


def test_contract_wrong_designs_are_refused_as_elsewhere(tmd: rt.Problem) -> None:
    for call in (tmd.gradient, tmd.value_and_gradient):
        with pytest.raises(rt.StudyError, match="one number for each of k2, c2"):
            call([1, 2, 3])
        with pytest.raises(rt.StudyError, match="k2: -1 is not allowed"):
            call([-1, 2])
    with pytest.raises(rt.StudyError, match="optimize: missing"):
        tmd.from_study({key: value for key, value in tmd.study.items() if key != "optimize"}).gradient([])
    assert np.allclose(approx_fprime(tmd.start, tmd, 1e-4), tmd.gradient(tmd.start), rtol=1e-3)
