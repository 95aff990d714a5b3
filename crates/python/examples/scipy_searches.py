"""SciPy's optimisers on a Retune problem: the problem is the function, its bounds are SciPy's bounds."""

import os

import numpy as np
from scipy.optimize import differential_evolution, minimize

import retune as rt

problem = rt.Problem(
    rt.Structure(m1=1000, c1=452, k1=3.95e4),
    rt.TMD(60, k2=1900, c2=150),
    P=800,
    window=(50, 100),
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
# With exact derivatives. At the optimum both peaks are equally high and the value has a kink, so that a method for smooth functions ends
# near it; SLSQP comes near enough.
descent = minimize(problem.value_and_gradient, problem.start, jac=True, method="SLSQP", bounds=problem.bounds)
print(f"{'Nelder-Mead':<24}{simplex.fun:.6f} J after {simplex.nfev} evaluations at {simplex.x.round(3)}")
print(f"{'differential evolution':<24}{evolved.fun:.6f} J after {evolved.nfev}")
print(f"{'the same, vectorized':<24}{together.fun:.6f} J after {together.nfev}")
print(f"{'SLSQP, by derivatives':<24}{descent.fun:.6f} J after {descent.nfev}")
assert np.allclose([simplex.fun, evolved.fun, together.fun, descent.fun], simplex.fun, rtol=1e-5)

# At one frequency the value is smooth: the paper's SSVI NES, four parameters, by derivatives. A limit on the stroke is a constraint with
# derivatives of its own: the stroke is a problem, too.


def largest(quantity: str) -> rt.Problem:
    return rt.Problem(
        rt.Structure(m1=1000, c1=452, k1=3.95e4),
        rt.SSVI(60, k2=584, c2=95, D=0.029, C=1.1),
        P=800,
        window=(50, 100),
        omega=6.63,
        vary=["k2", "c2", "D", "C"],
        bounds={"k2": (10, 600), "c2": (40, 1000), "D": (0, 1), "C": (0, 2)},
        quantity=quantity,
    )


energy, stroke = largest("E1max"), largest("stroke")
kept = {"type": "ineq", "fun": lambda x: 0.45 - stroke(x), "jac": lambda x: -stroke.gradient(x)}
held = minimize(energy.value_and_gradient, energy.start, jac=True, method="SLSQP", bounds=energy.bounds, constraints=[kept])
print(f"from {energy(energy.start):.2f} J, {stroke(energy.start):.4f} m to {held.fun:.2f} J, {stroke(held.x):.4f} m: {held.x.round(3)}")
assert held.fun < energy(energy.start) and stroke(held.x) < 0.45 + 1e-6

# The paper's SSVI NES under a limit on its stroke: the value of a design that breaks it is above 1e100, larger the more it is broken,
# so that a search without constraints finds its way.
study = os.path.join(os.environ.get("RETUNE_STUDIES", "studies"), "ssvi-resonance.json")
read = rt.Problem.from_study(study).study
read["optimize"]["limits"] = {"stroke": 0.35}
limited = rt.Problem.from_study(read)
found = minimize(limited, limited.start, method="Nelder-Mead", bounds=limited.bounds, options={"maxfev": 200})
print(limited.at(found.x).evaluate(found.x))
assert limited.evaluate(found.x).violation == 0
