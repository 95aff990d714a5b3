#!/usr/bin/env python3
"""SciPy's Radau, LSODA and DOP853 on the scenes of `scenes.json`.

Writes `scipy.csv` beside this file: one row a run, failures kept. Contacts are located as terminal events and the phase
(flight, touching the structure, touching the obstacle) is frozen in between: each program at its best. The time is that of the
second of two runs (of the first, where it took over a second).

    python3 -m pip install numpy scipy
    python3 tests/reference/external/scipy_methods.py [SCENE...]    (those scenes alone, beside the other rows of the table)

Contacts that lose energy follow Hunt and Crossley's law by their lambda; walls that are rigid throw the damper back at their
restitution. The law of one restitution at every speed is left out, an equation to be solved at each evaluation, and so is the chatter.
"""

import csv
import json
import math
import platform
import sys
import time
from pathlib import Path

import numpy
import scipy
from scipy.integrate import solve_ivp

HERE = Path(__file__).parent
LONGEST_RUN = 8.0  # s; tighter tolerances of a method that took longer are left out
FIELDS = ["program", "method", "scene", "rtol", "seconds", "evaluations", "E1max", "x1", "v1", "x2", "v2", "impacts", "failure"]


class Motion:
    """Equation (1) with one phase at a time: 0 flight, 1 on the structure, 2 on the obstacle."""

    def __init__(self, s):
        self.s = s
        self.phase = 0
        self.evaluations = 0

    def f(self, t, y):
        s = self.s
        self.evaluations += 1
        x1, v1, x2, v2 = y
        push = 0.0
        lost = s.get("lambda", 0.0)
        if self.phase == 1:
            push = s["K1"] * max(x1 - x2, 0.0) ** 1.5 * (1.0 + lost * (v1 - v2))
        elif self.phase == 2:
            push = -s["K3"] * max(x2 - x1 - s["D"] - s["C"], 0.0) ** 1.5 * (1.0 + lost * (v2 - v1))
        damper = push - s["c2"] * (v2 - v1) - s["k2"] * (x2 - x1 - s["D"])
        force = s["P"] * math.cos(s["omega"] * t)
        return [v1, (force - s["c1"] * v1 - s["k1"] * x1 - damper) / s["m1"], v2, damper / s["m2"]]

    def gaps(self, y):
        """What keeps the phase going; an event is a fall through zero."""
        r = y[2] - y[0]
        far = r - self.s["D"] - self.s["C"]
        return [[r, -far], [-r, 1.0], [far, 1.0]][self.phase]

    def after(self, y, which):
        """The phase after event `which`, begun a hair beyond the wall."""
        sign = {0: [-1.0, 1.0][which], 1: 1.0, 2: -1.0}[self.phase]
        if self.s.get("rigid"):
            m1, m2 = self.s["m1"], self.s["m2"]
            kick = (1.0 + self.s["restitution"]) * (y[3] - y[1]) / (m1 + m2)
            return numpy.array([y[0], y[1] + m2 * kick, y[2] - sign * 1e-15, y[3] - m1 * kick])
        self.phase = which + 1 if self.phase == 0 else 0
        y = numpy.array(y)
        y[2] += sign * 1e-15
        return y


def piece(motion, method, t, y, end, rtol):
    def event(i):
        def g(_t, y):
            return motion.gaps(y)[i]
        g.terminal, g.direction = True, -1
        return g

    out = solve_ivp(motion.f, (t, end), y, method=method, rtol=rtol, atol=rtol * 1e-3, dense_output=True,
                    events=[event(0), event(1)])
    if out.status < 0:
        raise RuntimeError(out.message)
    which = next((i for i in (0, 1) if len(out.t_events[i])), None)
    return out.t, out.y.T, which, out.sol


def run(s, method, rtol):
    motion = Motion(s)
    t, y = 0.0, numpy.array([0.0, 0.0, s["D"], 0.0])
    impacts, best = 0, 0.0
    energy = lambda y: 0.5 * (s["m1"] * y[1] ** 2 + s["k1"] * y[0] ** 2)
    pieces = []
    while t < s["T"]:
        ts, ys, which, dense = piece(motion, method, t, y, s["T"], rtol)
        pieces.append((ts, dense))
        t, y = ts[-1], ys[-1]
        best = max([best] + [energy(v) for v in ys])
        if which is None:
            break
        impacts += motion.phase == 0
        y = motion.after(y, which)
        if len(pieces) > 5000:
            raise RuntimeError(f"more than 5000 contacts at t = {t}")
    return motion.evaluations, best, y, impacts, pieces


def e1max(s, best, pieces):
    """The largest E1 on a fine grid of the dense output, and between its points by the parabola through three."""
    for ts, dense in pieces:
        x, v = dense(numpy.linspace(ts[0], ts[-1], max(513, int((ts[-1] - ts[0]) / 2e-4))))[:2]
        e = 0.5 * (s["m1"] * v**2 + s["k1"] * x**2)
        i = int(numpy.argmax(e))
        best = max(best, e[i])
        if 0 < i < len(e) - 1:
            a, b, c = e[i - 1 : i + 2]
            if 2 * b - a - c > 0:
                best = max(best, b + (c - a) ** 2 / (8 * (2 * b - a - c)))
    return best


def main():
    scenes = json.loads((HERE / "scenes.json").read_text())
    version = f"SciPy {scipy.__version__}"
    methods = ("DOP853", "LSODA", "Radau")
    print("Python", platform.python_version(), "numpy", numpy.__version__, version, file=sys.stderr)
    wanted = sys.argv[1:] or [s["scene"] for s in scenes]
    scenes = [s for s in scenes if s["scene"] in wanted and (s.get("rigid") or s.get("restitution") is None)]
    table = HERE / "scipy.csv"
    kept = [r for r in csv.DictReader(table.open()) if r["scene"] not in wanted] if sys.argv[1:] else []
    with open(table, "w", newline="") as file:
        out = csv.DictWriter(file, FIELDS, lineterminator="\n")
        out.writeheader()
        out.writerows(kept)
        for method in methods:
            for s in scenes:
                for exponent in range(3, 13, 1 if method == "DOP853" else 2):
                    rtol = 10.0**-exponent
                    row = dict.fromkeys(FIELDS, "") | {"program": version, "method": method, "scene": s["scene"], "rtol": rtol}
                    begun = time.perf_counter()
                    try:
                        evaluations, best, y, impacts, pieces = run(s, method, rtol)
                        took = time.perf_counter() - begun
                        if took < 1.0:
                            begun = time.perf_counter()
                            run(s, method, rtol)
                            took = min(took, time.perf_counter() - begun)
                        row |= {"seconds": f"{took:.4g}", "evaluations": evaluations, "impacts": impacts,
                                "E1max": repr(float(e1max(s, best, pieces)))}
                        row |= dict(zip(("x1", "v1", "x2", "v2"), map(lambda v: repr(float(v)), y)))
                    except Exception as error:  # a failure is a result
                        took = time.perf_counter() - begun
                        row["failure"] = str(error).strip()[:120] or type(error).__name__
                    out.writerow(row)
                    file.flush()
                    if took > LONGEST_RUN:
                        break


if __name__ == "__main__":
    main()
