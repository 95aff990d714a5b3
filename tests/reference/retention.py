#!/usr/bin/env python3
"""Values of results/retune and results/fronts again, from SciPy alone.

    python3 tests/reference/retention.py          every value; writes retention.json beside this file (some minutes, two processes)
    python3 tests/reference/retention.py --quick  those in closed form only; prints, writes nothing

Reads the designs and their E1max from the committed tables and finds E1max, the worst over the band, by itself: with a TMD by solving
the linear equations in complex amplitudes, with an SSVI NES and without a damper by `scipy_scenes.py`, on SCAN frequencies and a bounded
search about the largest. Motions must be regular: a design whose certificate does not say so is not taken. Fails where a value
differs by more than WITHIN.

Units are SI throughout.
"""

import csv
import json
import math
import multiprocessing
import platform
import sys
from pathlib import Path

import numpy
import scipy
from scipy.integrate import DOP853
from scipy.optimize import minimize_scalar

import scipy_scenes
from scipy_scenes import CROSS_CHECK, Method, Scene

HERE = Path(__file__).resolve().parent
RESULTS = HERE.parent.parent / "results"
WITHIN = 1e-6
SCAN = 31
COARSE = Method(DOP853, rtol=1e-8, atol=1e-11, max_step=0.1)
M1, C1, P, M2, NOMINAL = 1000.0, 452.0, 800.0, 60.0, 3.95e4


def linear(k1, omega, k2, c2):
    """Largest E1 of the steady motion: x1 = X cos(omega t + phase), so E1 <= X² max(k1, m1 omega²) / 2."""
    link = k2 + 1j * omega * c2
    matrix = numpy.array([[k1 - M1 * omega**2 + 1j * omega * C1 + link, -link], [-link, link - M2 * omega**2]])
    x = numpy.linalg.solve(matrix, numpy.array([P, 0.0]))[0]
    return 0.5 * abs(x) ** 2 * max(k1, M1 * omega**2)


def striking(k1, omega, method, k2, c2, D, C):
    """E1max from 50 to 100 s of a run from rest."""
    scene = Scene("one", T=100.0, t0=50.0, k1=k1, omega=omega, k2=k2, c2=c2, D=D, C=C)
    return scipy_scenes.run(scene, method)["E1max"]


def bare(k1, omega, method):
    """The same without a damper."""
    scene = Scene("bare", T=100.0, t0=50.0, k1=k1, omega=omega, m2=None)
    return scipy_scenes.run(scene, method)["E1max"]


def worst(value, band, count, coarse=None):
    """The largest value over a band: on evenly spaced frequencies, by `coarse` if given, and about each of their maxima that could be it."""
    omegas = numpy.linspace(*band, count)
    found = [(coarse or value)(omega) for omega in omegas]
    ends = [value(omega) for omega in band]
    best = max(ends)
    for i in range(count):
        left, right = omegas[max(i - 1, 0)], omegas[min(i + 1, count - 1)]
        neighbours = found[max(i - 1, 0) : i + 2]
        if found[i] == max(neighbours) and found[i] > 0.97 * max(found):
            refined = minimize_scalar(
                lambda omega: -value(omega), bounds=(left, right), method="bounded", options={"xatol": 1e-5}
            )
            best = max(best, -refined.fun)
    return best


def again(task):
    name, said, k1, band, design = task
    if design is None:
        found = worst(lambda omega: bare(k1, omega, CROSS_CHECK), band, SCAN, lambda omega: bare(k1, omega, COARSE))
    elif design["D"] > 2.0:
        found = worst(lambda omega: linear(k1, omega, design["k2"], design["c2"]), band, 4001)
    else:
        fine, coarse = (lambda omega, method=method: striking(k1, omega, method, **design) for method in (CROSS_CHECK, COARSE))
        found = worst(fine, band, SCAN, coarse)
    return {"value": name, "retune": said, "scipy": found, "difference": abs(found / said - 1.0)}


def rows(name):
    with open(RESULTS / name, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def design(row):
    return {symbol: float(row[symbol]) for symbol in ("k2", "c2", "D", "C")}


def tasks():
    """(what it is, E1max, k1, band, design) of every value."""
    designs = {(row["damper"], row["tuning"]): row for row in rows("retune/retune.csv")}
    curves = rows("retune/retention.csv")
    wanted = []
    for row in curves:
        k1, tuning, damper = float(row["k1"]), row["tuning"], row["damper"]
        if row["band"] != "own" or k1 not in (2e4, 3e4, NOMINAL, 5e4, 6e4):
            continue
        key = {"re-tuned": f"k1 = {k1:g}", "nominal": f"k1 = {NOMINAL:g}"}.get(tuning, tuning)
        of = designs.get((damper, key))
        regular = of is None or of["verdict"] == "robust" or damper.startswith("TMD")
        striking_one = of is not None and float(of["D"]) < 2.0
        # Where the motion of a kept design is not known to be regular, only its own k1 is taken.
        if not regular or (striking_one and (tuning != "re-tuned" or "600" not in damper)):
            continue
        natural = math.sqrt(k1 / M1)
        band = (0.8 * natural, 1.25 * natural)
        name = f"retune: {damper}, {tuning}, k1 = {k1:g}"
        wanted.append((name, float(row["E1max"]), k1, band, None if of is None else design(of)))
    for row in rows("fronts/k2.csv"):
        bound = float(row["k2_most"])
        striking_one = row["damper"] != "TMD"
        if row["verdict"] != "robust" or (striking_one and bound not in (450, 500, 550, 600, 800)):
            continue
        name = f"fronts: {row['damper']}, k2 at most {bound:g}"
        wanted.append((name, float(row["E1max"]), NOMINAL, (5.0, 8.0), design(row)))
    return wanted


def main(quick):
    wanted = [task for task in tasks() if not quick or task[4] is not None and task[4]["D"] > 2.0]
    with multiprocessing.Pool(2) as pool:
        found = []
        for one in pool.imap(again, wanted):
            print(f"{one['value']:<60} {one['retune']:.9g} {one['scipy']:.9g} {one['difference']:.1e}", flush=True)
            found.append(one)
    beyond = [one for one in found if one["difference"] > WITHIN]
    print(f"{len(found)} values, {len(beyond)} beyond {WITHIN:g}")
    if not quick and not beyond:
        provenance = {
            "script": "tests/reference/retention.py",
            "python": platform.python_version(),
            "numpy": numpy.__version__,
            "scipy": scipy.__version__,
        }
        text = json.dumps({"provenance": provenance, "values": found}, indent=1)
        (HERE / "retention.json").write_text(text + "\n", encoding="utf-8")
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main("--quick" in sys.argv[1:]))
