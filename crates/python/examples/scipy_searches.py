"""SciPy's optimisers on a Retune problem: the problem is the function, its bounds are SciPy's bounds."""

import os

import numpy as np
from scipy.optimize import differential_evolution, minimize

import retune as rt

problem = rt.Problem(
    rt.Structure(m1=1000, c1=452, k1=3.95e4),
    rt.TMD(60, k2=1900, c2=150),
    P=800,
    band=(5, 8),
    vary=["k2", "c2"],
    bounds={"k2": (500, 4000), "c2": (10, 1000)},
    response="steady",
)
simplex = minimize(problem, problem.start, method="Nelder-Mead", bounds=problem.bounds, options={"xatol": 1e-6, "fatol": 1e-9})
evolved = differential_evolution(problem, problem.bounds, rng=1, polish=False, tol=1e-8)
# A population at once, on all cores.
together = differential_evolution(
    lambda X: problem.batch(X.T).value, problem.bounds, rng=1, polish=False, tol=1e-8, vectorized=True, updating="deferred"
)
# Derivatives by differences: the objective is smooth but where its two peaks are equally high.
powell = minimize(problem, simplex.x, method="Powell", bounds=problem.bounds)
print(f"{'Nelder-Mead':<24}{simplex.fun:.6f} J after {simplex.nfev} evaluations at {simplex.x.round(3)}")
print(f"{'differential evolution':<24}{evolved.fun:.6f} J after {evolved.nfev}")
print(f"{'the same, vectorized':<24}{together.fun:.6f} J after {together.nfev}")
print(f"{'Powell':<24}{powell.fun:.6f} J after {powell.nfev}")
assert np.allclose([simplex.fun, evolved.fun, together.fun], min(simplex.fun, evolved.fun, together.fun, powell.fun), rtol=1e-6)

# The paper's SSVI NES under a limit on its stroke: the value of a design that breaks it is above 1e100, larger the more it is broken,
# so that a search without constraints finds its way.
study = os.path.join(os.environ.get("RETUNE_STUDIES", "studies"), "ssvi-resonance.json")
read = rt.Problem.from_study(study).study
read["optimize"]["limits"] = {"stroke": 0.35}
limited = rt.Problem.from_study(read)
found = minimize(limited, limited.start, method="Nelder-Mead", bounds=limited.bounds, options={"maxfev": 200})
print(limited.at(found.x).evaluate(found.x))
assert limited.evaluate(found.x).violation == 0
