#!/usr/bin/env python3
"""Reference values for scenes whose contacts lose energy, from SciPy alone.

Integrates equation (1) of the paper with the contact law of Hunt and Crossley, F = K z^1.5 (1 + lambda z'), never pulling, by SciPy's
DOP853 with events, and writes `loss_scenes.json` beside this file. Nothing here comes from Retune.

    python3 tests/reference/loss_scenes.py        every scene; writes loss_scenes.json (some minutes, two processes)

Every piece of a run has one right side: flight, in contact with a wall, or inside a wall that would pull and therefore exerts no force. It
ends at an event: a gap closes, an indentation falls to zero, or 1 + lambda z' changes its sign. Each scene is integrated twice, at
rtol 1e-13 and, with other steps, at rtol 1e-12; one whose values differ by more than 1e-9 is no reference.

Units are SI throughout.
"""

import json
import math
import multiprocessing
import platform
import random
import sys
from pathlib import Path

import numpy
import scipy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

PRIMARY = dict(rtol=1e-13, atol=1e-15, max_step=0.004)
CROSS_CHECK = dict(rtol=1e-12, atol=1e-14, max_step=0.0027)
PREDICTABLE = 1e-9
T = 6.0


def stiffness(R, q, young):
    """K of a sphere on a plane: steel of the wall, and the damper's surface."""
    delta = lambda E, nu: (1.0 - nu**2) / (math.pi * E)
    return 4.0 / 3.0 * q / ((delta(2.1e11, 0.3) + delta(young, 0.4)) * math.sqrt(1.0 / R))


def right_side(s, phase):
    K = {"primary": stiffness(s["R"], 0.318, 2.21e7), "obstacle": stiffness(s["R"], 0.318, 2.05e7)}
    wall, acts = phase

    def f(t, y):
        x1, v1, x2, v2 = y.tolist()
        on_damper = -s["c2"] * (v2 - v1) - s["k2"] * (x2 - x1 - s["D"])
        if acts:
            on_damper += (1 if wall == "primary" else -1) * force(s, K, wall, y)
        a1 = (s["P"] * math.cos(s["omega"] * t) - s["c1"] * v1 - s["k1"] * x1 - on_damper) / s["m1"]
        return [v1, a1, v2, on_damper / s["m2"]]

    return f, K


def depth(s, wall, y):
    r = y[2] - y[0]
    return -r if wall == "primary" else r - s["D"] - s["C"]


def rate(wall, y):
    return (y[1] - y[3]) if wall == "primary" else (y[3] - y[1])


def force(s, K, wall, y):
    """Odd in z: a trial step may reach past the lift-off."""
    z = depth(s, wall, y)
    return K[wall] * z * math.sqrt(abs(z)) * (1.0 + s["lambda"] * rate(wall, y))


def event(function, direction):
    function.terminal, function.direction = True, direction
    return function


def ways_out(s, phase):
    """(event, next phase)"""
    wall, acts = phase
    if wall is None:
        return [(event(lambda t, y, w=w: depth(s, w, y), 1), (w, True)) for w in ("primary", "obstacle")]
    push = lambda t, y: 1.0 + s["lambda"] * rate(wall, y)
    return [
        (event(lambda t, y: depth(s, wall, y), -1), (None, False)),
        (event(push, -1), (wall, False)) if acts else (event(push, 1), (wall, True)),
    ]


def largest(value, slope, solution, best):
    """The largest value at a sign change of its slope, between samples of every step."""
    times = solution.t
    for a, b in zip(times[:-1], times[1:]):
        samples = [a + (b - a) * i / 4 for i in range(5)]
        slopes = [slope(t, solution.sol(t)) for t in samples]
        for (left, right), (g, h) in zip(zip(samples, samples[1:]), zip(slopes, slopes[1:])):
            best = max(best, value(right, solution.sol(right)))
            if g > 0.0 > h:
                t = brentq(lambda t: slope(t, solution.sol(t)), left, right, xtol=1e-15)
                best = max(best, value(t, solution.sol(t)))
    return best


def run(s, method):
    t, y, phase = 0.0, numpy.array([0.0, 0.0, s["D"], 0.0]), (None, False)
    found = {"E1max": 0.0, "force_max_primary": 0.0, "force_max_obstacle": 0.0, "impacts_primary": 0, "impacts_obstacle": 0}
    partings = 0
    while t < T:
        f, K = right_side(s, phase)
        ways = ways_out(s, phase)
        solution = solve_ivp(f, (t, T), y, "DOP853", events=[e for e, _ in ways], dense_output=True, **method)
        if solution.status < 0:
            raise RuntimeError(solution.message)
        energy = lambda t, y: 0.5 * (s["m1"] * y[1] ** 2 + s["k1"] * y[0] ** 2)
        energy_slope = lambda t, y: y[1] * (s["m1"] * f(t, y)[1] + s["k1"] * y[0])
        found["E1max"] = largest(energy, energy_slope, solution, found["E1max"])
        wall, acts = phase
        if acts:

            def force_slope(t, y):
                z, w, dy = max(depth(s, wall, y), 0.0), rate(wall, y), f(t, y)
                bend = dy[1] - dy[3] if wall == "primary" else dy[3] - dy[1]
                return 1.5 * math.sqrt(z) * w * (1.0 + s["lambda"] * w) + z**1.5 * s["lambda"] * bend

            name = f"force_max_{wall}"
            found[name] = largest(lambda t, y: force(s, K, wall, y), force_slope, solution, found[name])
        t, y = solution.t[-1], solution.y[:, -1].copy()
        if solution.status == 1:
            (phase,) = [following for (_, following), times in zip(ways, solution.t_events) if len(times)][:1]
            if wall is None:
                found[f"impacts_{phase[0]}"] += 1
                y[2] = y[0] + (0.0 if phase[0] == "primary" else s["D"] + s["C"])
            elif phase[0] is not None and not phase[1]:
                partings += 1
            elif phase[0] is None:
                y[2] = y[0] + (0.0 if wall == "primary" else s["D"] + s["C"])
    return found | {"partings": partings, "state_T": y.tolist()}


def reference(s):
    values, other = run(s, PRIMARY), run(s, CROSS_CHECK)
    apart = lambda a, b: abs(a - b) / max(abs(a), 1e-3)
    measures = ("E1max", "force_max_primary", "force_max_obstacle")
    values["measures_disagreement"] = max(apart(values[m], other[m]) for m in measures)
    values["state_T_disagreement"] = max(abs(a - b) for a, b in zip(values["state_T"], other["state_T"]))
    counts = ("impacts_primary", "impacts_obstacle", "partings")
    alike = all(values[c] == other[c] for c in counts)
    good = alike and max(values["measures_disagreement"], values["state_T_disagreement"]) <= PREDICTABLE
    return s | {"T": T} | values, good


def scenes():
    draw = random.Random(2026)
    about = lambda value: value * draw.uniform(0.8, 1.2)
    for number in range(60):
        two_sided = number % 2 == 1
        yield {
            "name": f"{'two_sided' if two_sided else 'ssvi'}_{number}",
            "m1": 1000.0,
            "c1": about(452.0),
            "k1": about(3.95e4),
            "P": 800.0,
            "omega": about(6.28),
            "m2": about(60.0),
            "k2": about(2400.0 if two_sided else 215.0),
            "c2": about(100.0 if two_sided else 232.0),
            "D": about(0.1 if two_sided else 0.06),
            "C": about(0.1 if two_sided else 0.36),
            "R": 10.0 ** draw.uniform(-2.0, 1.0),
            "lambda": 10.0 ** draw.uniform(-2.0, 1.5),
        }


def main():
    with multiprocessing.Pool(2) as pool:
        found = []
        for entry, good in pool.imap(reference, scenes()):
            print(
                f"{'ok ' if good else 'BAD'} {entry['name']:14} lambda {entry['lambda']:8.4f} E1max {entry['E1max']:.10g} "
                f"impacts {entry['impacts_primary']} + {entry['impacts_obstacle']}, {entry['partings']} partings, disagreement "
                f"{entry['measures_disagreement']:.1e} {entry['state_T_disagreement']:.1e}",
                flush=True,
            )
            if good:
                found.append(entry)
    if len(found) < 40:
        sys.exit(f"only {len(found)} scenes are references: nothing written")
    provenance = {
        "script": "tests/reference/loss_scenes.py",
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
        "method": f"DOP853 {PRIMARY}, cross-check {CROSS_CHECK}; restarted at every touch-down, lift-off and end of the force",
    }
    output = Path(__file__).with_suffix(".json")
    output.write_text(json.dumps({"provenance": provenance, "scenes": found}, indent=1) + "\n")


if __name__ == "__main__":
    main()
