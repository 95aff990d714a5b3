"""Whole runs of SciPy's Nelder-Mead from MATLAB's 5 % simplex: the reference for retune-optim's fminsearch.

    python3 tests/reference/fminsearch_scipy.py > tests/reference/fminsearch_scipy.json

Writes every evaluated point in order, with its value, and the best point after each iteration. SciPy takes the
same steps as MATLAB's fminsearch; its stop test differs only in MATLAB's floor of 10 eps, which no run here reaches.

The objectives use + - * / and comparisons alone, in plain Python floats and in the order written. IEEE 754 fixes
the result of each of these, so crates/optim/tests/reference.rs, which repeats the formulas, must agree to the last bit.
"""

import json
import sys

import numpy
import scipy
from scipy.optimize import minimize

TOLERANCE = 1e-4  # TolX and TolFun


def quadratic(x):
    """4-D bowl with coupled coordinates, around (3, -1, 0.5, 2)."""
    a, b, c, d = x[0] - 3.0, x[1] + 1.0, x[2] - 0.5, x[3] - 2.0
    return a * a + 10.0 * b * b + 5.0 * c * c + 2.0 * d * d + a * b + c * d


def rosenbrock(x):
    a, b = 1.0 - x[0], x[1] - x[0] * x[0]
    return a * a + 100.0 * b * b


def terraces(x):
    """3-D, flat steps around (2, 2, -2): runs into ties, failed contractions and shrinks."""
    a, b, c = abs(x[0] - x[1]), abs(x[1] + x[2]), abs(x[0] - 2.0)
    return float(int(64.0 * (a + b + c)))  # int rounds towards zero


def tmd(x):
    """Largest E1 of the steady motion of a main structure with a linear damper, in J; x = (k2, c2).

    Both masses move at omega; their complex amplitudes X1, X2 satisfy
        (k1 + k2 - m1 w^2 + i w (c1 + c2)) X1 - (k2 + i w c2) X2 = P
        -(k2 + i w c2) X1 + (k2 - m2 w^2 + i w c2) X2 = 0
    so X1 = P b / (a b - s^2), and E1 = k1 x1^2 / 2 + m1 v1^2 / 2 has the maximum |X1|^2 max(k1, m1 w^2) / 2.
    """
    m1, c1, k1, m2, force, w = 1000.0, 452.0, 3.95e4, 60.0, 800.0, 6.28
    k2, c2 = x
    a_re, a_im = k1 + k2 - m1 * w * w, w * (c1 + c2)
    b_re, b_im = k2 - m2 * w * w, w * c2
    s_re, s_im = k2, w * c2
    d_re = (a_re * b_re - a_im * b_im) - (s_re * s_re - s_im * s_im)
    d_im = (a_re * b_im + a_im * b_re) - 2.0 * s_re * s_im
    amplitude_squared = force * force * (b_re * b_re + b_im * b_im) / (d_re * d_re + d_im * d_im)
    return 0.5 * amplitude_squared * max(k1, m1 * w * w)


def simplex(start):
    """MATLAB's initial simplex."""
    vertices = [list(start)]
    for j, x in enumerate(start):
        vertex = list(start)
        vertex[j] = (1.0 + 0.05) * x if x != 0.0 else 0.00025
        vertices.append(vertex)
    return vertices


def run(objective, start):
    evaluations, best = [], []

    def recorded(x):
        point = [float(v) for v in x]
        value = objective(point)
        evaluations.append(point + [value])
        return value

    def after_iteration(intermediate_result):
        best.append([float(v) for v in intermediate_result.x] + [float(intermediate_result.fun)])

    limit = 200 * len(start)
    result = minimize(
        recorded,
        start,
        method="Nelder-Mead",
        callback=after_iteration,
        options=dict(
            initial_simplex=simplex(start), xatol=TOLERANCE, fatol=TOLERANCE, maxiter=limit, maxfev=limit, adaptive=False
        ),
    )
    assert result.status == 0, result.message
    return dict(
        name=objective.__name__, start=start, iterations=int(result.nit), func_count=int(result.nfev),
        best=best, evaluations=evaluations,
    )


def main():
    runs = [
        run(quadratic, [1.0, 1.0, 1.0, 0.0]),
        run(rosenbrock, [-1.2, 1.0]),
        run(terraces, [3.0, -1.0, 0.5]),
        run(tmd, [600.0, 262.0]),
    ]
    versions = f"scipy {scipy.__version__}, numpy {numpy.__version__}"
    text = json.dumps(dict(made_with=versions, tolerance=TOLERANCE, runs=runs))
    sys.stdout.write(text.replace("], [", "],\n[") + "\n")  # one point a line


if __name__ == "__main__":
    main()
