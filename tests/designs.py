#!/usr/bin/env python3
"""Random requests to `retune design`, beside closed forms and SciPy's optimiser.

A request has a structure from a kilogram to a thousand tonnes, a force, an imbalance or a moving base, a band about its resonance or beside it, a goal,
up to two limits, and for some a k1 that may be off. Of the structure alone and of the TMD every value that is told is compared with the closed form on
a fine grid of frequencies and stiffnesses, its limits with what it has there, and its goal with the least that Nelder-Mead's simplex finds from five starts.
An SSVI NES is evaluated again, from rest, on twenty times the frequencies and four times as late. Writes the rows of results/robustness/designs.md;
`just lab hunt-designs` puts them behind tests/designs.md.

    python3 tests/designs.py target/release/retune REQUESTS
    python3 tests/designs.py reference    # the numbers of crates/jobs/tests/jobs/design_answers.rs
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.optimize import minimize

GOALS = ["E1max", "x1max", "v1max", "a1max", "ground-force"]
LIMITS = ["stroke", "x1max", "a1max", "ground-force", "k2"]
# Frequencies and stiffnesses of the closed form.
FINE, COARSE, STIFFNESSES = 4001, 801, 41
# Shares by which a value may be above and below the closed form on its grid, and a goal above the least that is found.
ABOVE, BELOW, WORSE = 3e-3, 1e-4, 2e-3
# An SSVI NES is evaluated on so many times the frequencies, so many times as late, and may have this share more.
FINER, LATER, MORE = 20, 4, 1e-2
# Requests whose best TMD stands in tests: SI units, frequencies in Hz.
REFERENCES = [
    {"m1": 1944.08, "f1": 1.71561, "zeta": 0.024472, "mass": 16.9117, "load": ("base", 0.00011), "band": [1.544, 1.887],
     "goal": "E1max", "limits": {"stroke": 6.5e-3}, "off": 0.1},
    {"m1": 86801.3, "f1": 10.1632, "zeta": 0.0007363, "mass": 1084.09, "load": ("base-acceleration", 0.034946), "band": [9.7571, 10.569],
     "goal": "v1max", "limits": {"stroke": 17.74e-6}, "off": 0.0},
]


def request(number):
    """A request: its numbers, and the words of the command line."""
    random = np.random.default_rng(number)
    log = lambda low, high: math.exp(random.uniform(math.log(low), math.log(high)))
    typed = lambda value: float(f"{value:.5g}")
    m1, f1, zeta, share, static = log(1, 1e6), log(0.2, 100), log(2e-3, 0.05), log(0.003, 0.12), log(1e-6, 1e-2)
    omega = 2 * math.pi * f1
    k1 = m1 * omega**2
    load, unit, size = [("force", "N", k1), ("imbalance", "kg·m", m1), ("base", "m", 1), ("base-acceleration", "m/s²", omega**2)][random.integers(4)]
    asked = {"m1": typed(m1), "f1": typed(f1), "zeta": typed(zeta), "mass": typed(share * m1), "load": (load, typed(static * size))}
    words = ["--m1", f"{asked['m1']}kg", "--f1", f"{asked['f1']}Hz", "--zeta", f"{100 * asked['zeta']}%", "--mass", f"{asked['mass']}kg"]
    words += [f"--{load}", f"{asked['load'][1]}{unit}"]
    middle, half = [(1, 0.1), (1, log(0.02, 0.4)), (random.uniform(0.6, 1.5), random.uniform(0.02, 0.2))][random.integers(3)]
    asked["band"] = [typed(f1 * middle * (1 - half)), typed(f1 * middle * (1 + half))]
    words += ["--band", "{}Hz..{}Hz".format(*asked["band"])]
    asked["goal"] = GOALS[random.integers(len(GOALS))]
    words += ["--goal", asked["goal"]]
    asked["limits"] = {}
    for name in random.choice(LIMITS, random.integers(3), replace=False):
        reach = static * log(1, 100)
        value, unit = {
            "stroke": (reach, "m"), "x1max": (reach, "m"), "a1max": (reach * omega**2, "m/s²"),
            "ground-force": (reach * k1, "N"), "k2": (share * k1 * log(0.2, 2), "N/m"),
        }[str(name)]
        asked["limits"][str(name)] = typed(value)
        words += ["--limit", f"{name}={typed(value)}{unit}"]
    asked["off"] = typed(log(0.01, 0.15)) if random.random() < 0.3 else 0.0
    if asked["off"]:
        words += ["--k1-error", f"{100 * asked['off']}%"]
    return asked, words


def steady(asked, damper, frequencies, stiffnesses):
    """The largest value of each quantity with a damper [m2, k2, c2], or none, in closed form, in its SI unit
    (Den Hartog, Mechanical Vibrations, 1956, section 3.2)."""
    m1, own = asked["m1"], asked["m1"] * (2 * math.pi * asked["f1"]) ** 2
    w = 2 * math.pi * np.linspace(*asked["band"], frequencies)[:, None]
    k1 = own * np.linspace(1 - asked["off"], 1 + asked["off"], stiffnesses if asked["off"] else 1)[None, :]
    c1 = 2 * asked["zeta"] * math.sqrt(own * m1)
    load, amplitude = asked["load"]
    ground = {"base": amplitude, "base-acceleration": amplitude / w**2}.get(load, 0)
    force = {"force": amplitude, "imbalance": amplitude * w**2}.get(load, 0) + (k1 + 1j * w * c1) * ground
    structure = k1 + 1j * w * c1 - m1 * w**2
    if damper is None:
        x, stroke = force / structure, 0 * w
    else:
        m2, k2, c2 = damper
        spring = k2 + 1j * w * c2
        divisor = (structure + spring) * (spring - m2 * w**2) - spring**2
        x = force * (spring - m2 * w**2) / divisor
        stroke = abs(force * m2 * w**2 / divisor)
    size = abs(x)
    values = {
        "E1max": np.maximum(0.5 * k1, 0.5 * m1 * w**2) * size**2, "x1max": size, "v1max": w * size, "a1max": w**2 * size,
        "ground-force": abs((k1 + 1j * w * c1) * (x - ground)), "stroke": stroke,
    }
    return {name: float(np.max(value)) for name, value in values.items()}


def broken(asked, damper, values):
    """By how much the worst limit is broken, as a share of it."""
    values = values | {"k2": damper[1]}
    return max([values[name] / most - 1 for name, most in asked["limits"].items()], default=-1.0)


def least(asked, start):
    """The least goal of a TMD that keeps the limits, by the simplex from several starts; none where none was found."""
    k2, m2 = asked["mass"] * (2 * math.pi * asked["f1"]) ** 2, asked["mass"]
    c2 = 2 * math.sqrt(k2 * m2)
    scale = steady(asked, None, COARSE, 5)[asked["goal"]]

    def value(u):
        damper = [m2, k2 * math.exp(u[0]), c2 * math.exp(u[1])]
        values = steady(asked, damper, COARSE, 9)
        over = broken(asked, damper, values)
        return 1e6 * (1 + over) if over > 0 else values[asked["goal"]] / scale

    starts = [(0, -2), (-0.5, -1.5), (-1, -1), (0, 1)] + ([(math.log(max(start[1], 1e-9 * k2) / k2), math.log(max(start[2], 1e-9 * c2) / c2))] if start else [])
    ends = []
    for at in starts:
        for _ in range(2):
            found = minimize(value, at, method="Nelder-Mead", options={"xatol": 1e-6, "fatol": 1e-9, "maxiter": 400})
            at = found.x
        ends.append((found.fun, [m2, k2 * math.exp(at[0]), c2 * math.exp(at[1])]))
    return min(ends, key=lambda end: end[0])[1] if min(ends)[0] < 1e5 else None


def again(retune, study, design):
    """The goal of an SSVI NES without limits, on more frequencies and later."""
    finer = json.loads(study.read_text())
    span = finer["window"]["T"] - finer["window"]["t0"]
    finer["window"] = {"t0": LATER * finer["window"]["t0"], "T": LATER * finer["window"]["t0"] + span}
    finer["optimize"].pop("limits", None)
    finer["optimize"]["objective"]["omega"]["samples"] *= FINER
    with tempfile.TemporaryDirectory() as place:
        file = pathlib.Path(place, "study.json")
        file.write_text(json.dumps(finer))
        line = " ".join(repr(design[name]) for name in ["k2", "c2", "D", "C"])
        ran = subprocess.run([retune, "evaluate", str(file)], input=line + "\n", capture_output=True, text=True, check=True)
    return float(ran.stdout.split()[0])


def examine(retune, number, counts):
    """What is wrong with the answer to a request, in words."""
    asked, words = request(number)
    faults = []
    with tempfile.TemporaryDirectory() as place:
        out = pathlib.Path(place, "out")
        ran = subprocess.run([retune, "design", *words, "--json", "--out", str(out)], capture_output=True, text=True)
        if ran.returncode not in (0, 3):
            return [f"{number}: exit {ran.returncode}: {ran.stderr.strip()}: {' '.join(words)}"]
        answer = json.loads(ran.stdout)
        of = {candidate["damper"]: candidate for candidate in answer["candidates"]}
        goal = asked["goal"].replace("-", "_")
        counts["requests"] += 1
        counts["off"] += asked["off"] > 0
        for name in ["no damper", "TMD"]:
            design = of[name]["design"]
            damper = design and [design["m2"], design["k2"], design["c2"]]
            values = steady(asked, damper, FINE, STIFFNESSES)
            for quantity, value in values.items():
                told = of[name]["steady"][quantity.replace("-", "_")]["value"]
                if value > told * (1 + BELOW) or value < told * (1 - ABOVE):
                    faults.append(f"{quantity} of {name} told as {told}, in closed form {value}")
            if name == "TMD":
                keeps, best = of[name]["keeps_limits"], least(asked, damper)
                counts["kept"] += keeps
                if keeps and broken(asked, damper, values) > BELOW:
                    faults.append("the TMD is said to keep limits that it breaks")
                if best:
                    found = steady(asked, best, FINE, STIFFNESSES)
                    if broken(asked, best, found) <= 0 and not (keeps and values[asked["goal"]] <= found[asked["goal"]] * (1 + WORSE)):
                        faults.append(f"a better TMD is {best}: {found[asked['goal']]} instead of {values[asked['goal']]}")
        if answer["build"] == "SSVI NES":
            counts["walls"] += 1
            told, later = of["SSVI NES"]["steady"][goal]["value"], again(retune, out / "studies-ssvi.json", of["SSVI NES"]["design"])
            counts["more"] = max(counts["more"], later / told - 1)
            if later > told * (1 + MORE):
                faults.append(f"{goal} of the SSVI NES told as {told}, later and between samples {later}")
    return [f"{number}: {fault}: {' '.join(words)}" for fault in faults]


def reference():
    for asked in REFERENCES:
        best = least(asked, None)
        print(f"m2, k2, c2: {best}\n  {steady(asked, best, FINE, STIFFNESSES)}\n  without: {steady(asked, None, FINE, STIFFNESSES)}")


def main():
    if sys.argv[1:] == ["reference"]:
        return reference()
    retune, requests = sys.argv[1], int(sys.argv[2])
    counts = {"requests": 0, "off": 0, "kept": 0, "walls": 0, "more": 0.0}
    faults = 0
    for number in range(requests):
        for fault in examine(retune, number, counts):
            faults += 1
            print(f"fault: {fault}", file=sys.stderr, flush=True)
    print("| {requests} | {off} | {kept} | {walls} | {more:.1e} | {faults} |".format(**counts, faults=faults))
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
