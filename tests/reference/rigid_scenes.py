#!/usr/bin/env python3
"""Reference values for scenes with rigid walls, from SciPy alone.

Integrates the two bodies between impacts, and as one while a wall holds the damper, by SciPy's DOP853 with events, and writes
`rigid_scenes.json` beside this file. Nothing here comes from Retune.

    python3 tests/reference/rigid_scenes.py        every scene; writes rigid_scenes.json (a minute or two, two processes)

An impact turns the relative speed w into -e w and keeps the momentum. A rebound slower than SLOW of a damper that is pressed on the wall is
taken for the end of its chatter; what is left of that is of third order in the speed. A held damper leaves when the force
between them, m2 a + k2 (r - D) on the damper, changes its sign. Each scene is integrated twice, with other tolerances, steps and another
SLOW; one whose values differ by more than 1e-10 is no reference.

Units are SI throughout.
"""

import json
import math
import multiprocessing
import platform
import random
from pathlib import Path

import numpy
import scipy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

PRIMARY = dict(rtol=1e-13, atol=1e-16, max_step=0.02)
CROSS_CHECK = dict(rtol=3e-13, atol=1e-15, max_step=0.013)
SLOW = {0.02: 1e-9, 0.013: 1e-8}
PREDICTABLE = 1e-10
T = 6.0


def flight(s):
    def f(t, y):
        x1, v1, x2, v2 = y.tolist()
        on_damper = -s["c2"] * (v2 - v1) - s["k2"] * (x2 - x1 - s["D"])
        return [v1, (s["P"] * math.cos(s["omega"] * t) - s["c1"] * v1 - s["k1"] * x1 - on_damper) / s["m1"], v2, on_damper / s["m2"]]

    return f


def held(s):
    def f(t, y):
        x1, v1, _, v2 = y.tolist()
        a = (s["P"] * math.cos(s["omega"] * t) - s["c1"] * v1 - s["k1"] * x1) / (s["m1"] + s["m2"])
        return [v1, a, v2, a]

    return f


def gap(s, wall, y):
    r = y[2] - y[0]
    return r if wall == "primary" else s["D"] + s["C"] - r


def push(s, wall, t, y):
    """The force between a wall and the damper that it holds."""
    on_damper = s["m2"] * held(s)(t, y)[1] + s["k2"] * (y[2] - y[0] - s["D"])
    return on_damper if wall == "primary" else -on_damper


def event(function, direction):
    function.terminal, function.direction = True, direction
    return function


def touching(s, wall, t0, left, opening):
    """The gap; that which has just opened over the time since, so that its root there is none."""
    if wall != left:
        return event(lambda t, y: gap(s, wall, y), -1)
    return event(lambda t, y: gap(s, wall, y) / (t - t0) if t > t0 else opening, -1)


def largest(value, slope, solution, best):
    times = solution.t
    for a, b in zip(times[:-1], times[1:]):
        samples = [a + (b - a) * i / 4 for i in range(5)]
        best = max([best] + [value(t, solution.sol(t)) for t in samples])
        slopes = [slope(t, solution.sol(t)) for t in samples]
        for left, right, g, h in zip(samples, samples[1:], slopes, slopes[1:]):
            if g > 0.0 > h:
                t = brentq(lambda t: slope(t, solution.sol(t)), left, right, xtol=1e-15)
                best = max(best, value(t, solution.sol(t)))
    return best


def run(s, method):
    t, y, on, left, opening = 0.0, numpy.array([0.0, 0.0, s["D"], 0.0]), None, None, 0.0
    if s["D"] == 0.0:
        on = "primary"
    found = {"E1max": 0.0, "v1max": 0.0, "stroke": 0.0, "impacts_primary": 0, "impacts_obstacle": 0, "holds": 0, "lost": 0.0}
    m1, m2, e = s["m1"], s["m2"], s["e"]
    while t < T:
        if on:
            if push(s, on, t, y) < -1e-12 * s["P"]:
                left, on, opening = on, None, 0.0
                continue
            f, ways = held(s), [(on, event(lambda t, y: push(s, on, t, y), -1))]
        else:
            f, ways = flight(s), [(w, touching(s, w, t, left, opening)) for w in ("primary", "obstacle")]
        dt = dict(method)
        if left and opening > 0.0:
            pressing = max(push(s, left, t, y) * (1 / m1 + 1 / m2), 1e-300)
            dt["first_step"] = min(method["max_step"], max(0.7 * opening / pressing, 1e-13), T - t)
        solution = solve_ivp(f, (t, T), y, "DOP853", events=[g for _, g in ways], dense_output=True, **dt)
        if solution.status < 0:
            raise RuntimeError(solution.message)
        energy = lambda t, y: 0.5 * (m1 * y[1] ** 2 + s["k1"] * y[0] ** 2)
        found["E1max"] = largest(energy, lambda t, y: y[1] * (m1 * f(t, y)[1] + s["k1"] * y[0]), solution, found["E1max"])
        for sign in (1, -1):
            found["v1max"] = largest(lambda t, y: sign * y[1], lambda t, y: sign * f(t, y)[1], solution, found["v1max"])
            stretch = lambda t, y: sign * (y[2] - y[0] - s["D"])
            found["stroke"] = largest(stretch, lambda t, y: sign * (y[3] - y[1]), solution, found["stroke"])
        t, y = solution.t[-1], solution.y[:, -1].copy()
        if solution.status == 0:
            break
        wall = next(w for (w, _), at in zip(ways, solution.t_events) if len(at))
        if on:
            left, on, opening = wall, None, 0.0
            continue
        closing = (y[1] - y[3]) if wall == "primary" else (y[3] - y[1])
        found[f"impacts_{wall}"] += 1
        place = 0.0 if wall == "primary" else s["D"] + s["C"]
        y[2] = y[0] + place
        common = (m1 * y[1] + m2 * y[3]) / (m1 + m2)
        slow = e * closing < SLOW[method["max_step"]] and push(s, wall, t, y) > 0.0
        rebound = 0.0 if slow else e * closing
        found["lost"] += 0.5 * m1 * m2 / (m1 + m2) * (closing**2 - rebound**2)
        w = rebound if wall == "primary" else -rebound
        y[1], y[3] = common - m2 / (m1 + m2) * w, common + m1 / (m1 + m2) * w
        found["E1max"], found["v1max"] = max(found["E1max"], energy(t, y)), max(found["v1max"], abs(y[1]))
        if slow:
            on, found["holds"] = wall, found["holds"] + 1
        else:
            left, opening = wall, rebound
    found["state_T"] = y.tolist()
    return found


def scene(name, rng):
    """A scene near those of the paper, every other one with both walls within reach."""
    s = {"name": name, "m1": 1000.0, "c1": rng.uniform(350, 550), "k1": rng.uniform(3.8e4, 4.1e4), "P": 800.0}
    s["omega"], s["m2"] = rng.uniform(5.5, 7.5), rng.uniform(40, 120)
    if rng.random() < 0.6:
        s |= {"k2": rng.uniform(800, 3000), "c2": rng.uniform(0, 150), "D": rng.uniform(0.02, 0.1), "C": rng.uniform(0.03, 0.12)}
    else:
        s |= {"k2": rng.uniform(0, 600), "c2": rng.uniform(0, 250), "D": rng.choice([0.0, rng.uniform(0.01, 0.08)]), "C": rng.uniform(0.2, 1)}
    return s | {"e": rng.uniform(0.05, 0.95), "T": T}


def measured(number):
    s = scene(f"scene_{number}", random.Random(2000 + number))
    try:
        a, b = run(s, PRIMARY), run(s, CROSS_CHECK)
    except RuntimeError as error:
        return s["name"], str(error)
    close = lambda p, q, size: abs(p - q) <= PREDICTABLE * size
    same = all(close(a[k], b[k], abs(a[k])) for k in ("E1max", "v1max", "stroke", "lost"))
    same &= all(close(p, q, 1.0) for p, q in zip(a["state_T"], b["state_T"])) and a["holds"] == b["holds"]
    return s["name"], (s | a if same else "not predictable")


def main():
    with multiprocessing.Pool(2) as pool:
        results = pool.map(measured, range(60))
    scenes = [found for _, found in results if isinstance(found, dict)]
    dropped = {name: found for name, found in results if isinstance(found, str)}
    provenance = {
        "script": "tests/reference/rigid_scenes.py",
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
        "method": f"DOP853 {PRIMARY}, cross-check {CROSS_CHECK}; restarted at every impact and release",
        "dropped": dropped,
    }
    out = Path(__file__).with_name("rigid_scenes.json")
    out.write_text(json.dumps({"provenance": provenance, "scenes": scenes}, indent=1) + "\n")
    both = sum(s["impacts_primary"] > 0 and s["impacts_obstacle"] > 0 for s in scenes)
    print(len(scenes), "scenes,", both, "on both walls,", sum(s["holds"] > 0 for s in scenes), "with holds;", dropped)


if __name__ == "__main__":
    main()
