"""Worst steady responses over bands for dampers with hardly any damping, or none, in 50 digits: needs mpmath.

    python3 tests/reference/tmd_narrow.py        writes tmd_narrow.json beside this file, in some seconds

Nothing here comes from Retune. The squared response at w is N(u)/M(u), u = w^2: its value is taken at the ends of the band, at the
natural frequency of the structure (where the larger of its two energies changes) and at every root of N' M - N M' in the band. These
roots come from mpmath's polyroots and are refined by Newton's method. Bands end at random, or beside a natural frequency by a share
of 1e-12 to 0.1.
"""

import json
import platform
import random
from pathlib import Path

import mpmath
from mpmath import mp, mpf

mp.dps = 50
M1, P, CASES = 1000.0, 800.0, 60
ROUNDING = mpf(2) ** -48  # by which an end of a band may be off: 16 spacings of doubles


def mul(a, b):
    c = [mpf(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            c[i + j] += x * y
    return c


def add(a, b):
    n = max(len(a), len(b))
    return [(a[i] if i < len(a) else 0) + (b[i] if i < len(b) else 0) for i in range(n)]


def slope(a):
    return [i * x for i, x in enumerate(a)][1:]


def value(a, u):
    return mpmath.polyval(a[::-1], u)


def extrema(n, m):
    """Where N/M may have an extremum. A place that is none does no harm: no value in a band is above its largest."""
    w = add(mul(slope(n), m), [-x for x in mul(n, slope(m))])
    while w[-1] == 0:
        w.pop()
    roots, error = mpmath.polyroots(w[::-1], maxsteps=500, extraprec=500, error=True)
    assert error < mpf(10) ** -45 * max(abs(root) for root in roots), error
    found = [mpmath.re(root) for root in roots]
    refined, dw = list(found), slope(w)
    for _ in range(3):
        refined = [u - value(w, u) / value(dw, u) for u in refined]
    return found + refined


class Damper:
    def __init__(self, c1, k1, m2, k2, c2):
        m1, c1, k1, m2, k2, c2 = map(mpf, (M1, c1, k1, m2, k2, c2))
        primary, damper = [k1, -m1], [k2, -m2]
        real = add(mul(primary, damper), [0, -c1 * c2 - m2 * k2])
        imag = add(add([x * c2 for x in primary], [x * c1 for x in damper]), [0, -m2 * c2])
        m = add(mul(real, real), mul([0, 1], mul(imag, imag)))
        x1 = [mpf(P) ** 2 * x for x in add(mul(damper, damper), [0, c2 * c2])]
        stroke = [0, 0, (mpf(P) * m2) ** 2]
        potential, kinetic = [k1 / 2 * x for x in x1], [0, *(m1 / 2 * x for x in x1)]
        self.m, self.up = m, k1 / m1
        self.parts = [[(n, extrema(n, m)) for n in group] for group in ((potential, kinetic), (x1,), (stroke,))]

    def worst(self, low, high):
        """E1max (J), |X1| and |X2 - X1| (m)."""
        low, high = low * low, high * high

        def largest(n, places):
            inside = [u for u in [*places, self.up] if low < u < high]
            return max(value(n, u) / value(self.m, u) for u in [low, high, *inside])

        energy, x1, stroke = (max(largest(n, places) for n, places in group) for group in self.parts)
        return [energy, mpmath.sqrt(x1), mpmath.sqrt(stroke)]


def main():
    draw = random.Random(13)

    def log(a, b):
        return a * (b / a) ** draw.random()

    cases = []
    while len(cases) < CASES:
        c1, c2 = (0.0 if draw.random() < 0.2 else log(1e-9, 1e3) for _ in range(2))
        if c1 == c2 == 0.0:
            continue
        k1, m2 = log(1e4, 1e5), log(1, 3000)
        k2 = 3500 * draw.random() if draw.random() < 0.5 else log(1e-2, 3500)
        m = [mpf(x) for x in (M1, m2, k1, k2, c1, c2)]
        a, b, c = m[0] * m[1], m[0] * m[3] + m[1] * m[2] + m[1] * m[3] + m[4] * m[5], m[2] * m[3]
        upper = (b + mpmath.sqrt(b * b - 4 * a * c)) / (2 * a)
        natural = [mpmath.sqrt(x) for x in (c / (a * upper), upper, m[3] / m[1], m[2] / m[0])]
        ends = []
        for _ in range(2):
            near = draw.choice(natural) * (1 + draw.choice([-1, 1]) * log(1e-12, 0.1))
            ends.append(float(near) if draw.random() < 0.5 else log(0.05, 60))
        low, high = map(mpf, sorted(ends))
        damper = Damper(c1, k1, m2, k2, c2)
        # Nobody can be asked for more digits than a rounding of the band's ends leaves.
        least = damper.worst(low * (1 + ROUNDING), high * (1 - ROUNDING))
        found = damper.worst(low, high)
        most = damper.worst(low * (1 - ROUNDING), high * (1 + ROUNDING))
        rows = zip(("E1max", "x1", "stroke"), least, found, most)
        measures = {name: [float(x) for x in three] for name, *three in rows}
        cases.append(dict(c1=c1, k1=k1, m2=m2, k2=k2, c2=c2, band=[float(low), float(high)], **measures))
    provenance = dict(python=platform.python_version(), mpmath=mpmath.__version__, digits=mp.dps)
    text = ",\n".join("  " + json.dumps(case) for case in cases)
    out = f'{{\n "provenance": {json.dumps(provenance)},\n "m1": {M1}, "P": {P},\n "cases": [\n{text}\n ]\n}}\n'
    Path(__file__).with_suffix(".json").write_text(out)


main()
