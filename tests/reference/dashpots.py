"""E1max of the primary structure with a locked damper, in 40 digits: crates/solver/tests/solver/dashpots.rs.

    pip install mpmath numpy; python3 tests/reference/dashpots.py

Table 2's damper with a dashpot so strong that it never reaches a wall is a linear system under P cos wt. With the phase of the force as two more
components its motion is exp(B t) y0, here by the eigenvectors of B; the largest E1 of the window is located by the root of its slope.
"""

import numpy as np
from mpmath import mp, mpf

mp.dps = 40
M1, C1, K1, M2, K2, P, OMEGA = (mpf(text) for text in "1000 452 39500 60 215 800 6.28".split())


def e1max(c2, begin=50, end=100):
    b = mp.zeros(6, 6)
    b[0, 1] = b[2, 3] = 1
    b[1, 0], b[1, 1], b[1, 2], b[1, 3], b[1, 4] = -(K1 + K2) / M1, -(C1 + c2) / M1, K2 / M1, c2 / M1, 1 / M1
    b[3, 0], b[3, 1], b[3, 2], b[3, 3] = K2 / M2, c2 / M2, -K2 / M2, -c2 / M2
    b[4, 5], b[5, 4] = -OMEGA, OMEGA
    rates, vectors = mp.eig(b)
    start = mp.zeros(6, 1)
    start[4] = P
    weights = mp.lu_solve(vectors, start)

    def component(row):
        terms = [(sum(row[i] * vectors[i, k] for i in range(6)) * weights[k], rates[k]) for k in range(6)]
        return lambda t: mp.re(sum(weight * mp.exp(rate * t) for weight, rate in terms if mp.re(rate) * t > -100))

    x, v, a = (component(row) for row in ([1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [b[1, j] for j in range(6)]))
    energy = lambda t: (M1 * v(t) ** 2 + K1 * x(t) ** 2) / 2
    slope = lambda t: v(t) * (M1 * a(t) + K1 * x(t))
    times = np.linspace(begin, end, 2001)
    energies = [float(energy(mpf(t))) for t in times]
    most, found = max(energies), []
    for before, t, after, e in zip(times, times[1:], times[2:], energies[1:]):
        if e > 0.99 * most and slope(mpf(before)) > 0 > slope(mpf(after)):
            found.append(energy(mp.findroot(slope, (mpf(before), mpf(after)), solver="anderson", tol=1e-24)))
    return max(found)


for c2 in ["1e4", "1e5", "1e7"]:
    print(c2, mp.nstr(e1max(mpf(c2)), 18))
