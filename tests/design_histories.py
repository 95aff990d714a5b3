#!/usr/bin/env python3
"""Random requests to `retune design` under shocks and records, beside an exact linear simulation and SciPy's optimiser and integrator.

A request has a structure from a kilogram to a thousand tonnes, a pulse or a record of a force or of the acceleration of the base, a goal, a time from
which largest values count, up to two limits, and for some a k1 that may be off. The motion of the structure alone and of a TMD is summed from its
eigenvectors, exactly between the samples of a grid of hundreds of points a period: every value that is told is compared with its maxima, limits with what
is reached over the whole run, at 17 and at 65 stiffnesses, and the goal with the least that Nelder-Mead's simplex finds from several starts. An SSVI NES
is followed by SciPy's DOP853. Numbers of the table that is printed are compared with design.json. Writes the rows of
results/robustness/design-histories.md; `just lab hunt-design-histories` puts them behind tests/design_histories.md.

    python3 tests/design_histories.py target/release/retune SHOCKS RECORDS [tmd|both]
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize
from scipy.signal import lfilter

GOALS = ["E1max", "x1max", "v1max", "a1max", "ground-force"]
LIMITS = ["stroke", "x1max", "a1max", "ground-force", "k2"]
G = 9.80665
# Points a period of the fastest oscillation, for checks and for searches; stiffnesses of the program and of a finer check.
FINE, COARSE, STIFFNESSES, MANY = 400, 100, 17, 65
# Shares by which a value may be off, a limit exceeded, and a goal above the least that is found.
OFF, OVER, WORSE = 1e-3, 3e-3, 5e-3
# A search here keeps off its limits by this share, more than its coarse grid is off.
MARGIN = 1e-3
UNITS = {"µm": 1e-6, "mm": 1e-3, "m": 1, "mm/s": 1e-3, "m/s": 1, "mm/s²": 1e-3, "m/s²": 1, "mN": 1e-3, "N": 1, "kN": 1e3, "MN": 1e6,
         "µJ": 1e-6, "mJ": 1e-3, "J": 1, "kJ": 1e3, "MJ": 1e6, "Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}


def request(kind, number, place):
    """A request: its numbers, and the words of the command line. A record is written to `place`."""
    random = np.random.default_rng([number, {"shock": 1, "record": 2}[kind]])
    log = lambda low, high: math.exp(random.uniform(math.log(low), math.log(high)))
    typed = lambda value, digits=5: float(f"{value:.{digits}g}")
    m1, f1, zeta, share, static = log(1, 1e6), log(0.2, 100), log(2e-3, 0.05), log(0.003, 0.12), log(1e-6, 1e-2)
    asked = {"m1": typed(m1), "f1": typed(f1), "zeta": typed(zeta), "mass": typed(share * m1)}
    omega = 2 * math.pi * asked["f1"]
    k1, period = asked["m1"] * omega**2, 1 / asked["f1"]
    words = ["--m1", f"{asked['m1']}kg", "--f1", f"{asked['f1']}Hz", "--zeta", f"{100 * asked['zeta']}%", "--mass", f"{asked['mass']}kg"]
    of = ["force", "base acceleration"][random.integers(2)]
    size = static * (k1 if of == "force" else omega**2)
    if kind == "shock":
        shape = ["half-sine", "versed-sine", "rectangle"][random.integers(3)]
        duration = typed(log(0.02, 5) * period)
        unit = {"force": ["N", "kN"], "base acceleration": ["g", "m/s2", "m/s²"]}[of]
        unit = unit[random.integers(len(unit))]
        scale = {"N": 1, "kN": 1e3, "g": G, "m/s2": 1, "m/s²": 1}[unit]
        peak = typed(size / scale) * (-1 if random.random() < 0.1 else 1)
        in_ms = random.random() < 0.5
        told = f"{typed(1e3 * duration, 9)}ms" if in_ms else f"{duration}s"
        asked["history"] = {"kind": "pulse", "shape": shape, "of": of, "peak": peak * scale, "duration": duration}
        words += ["--shock", f"{shape},{told},{peak}{unit}"]
        end = duration
    else:
        times, values = record(random, log, period)
        values = np.array([typed(size * value) for value in values])
        unit = {"force": ["", "N", "kN"], "base acceleration": ["", "m/s²", "g", "mm/s²"]}[of]
        unit = unit[random.integers(len(unit))]
        factor = {"": 1, "N": 1, "kN": 1e3, "m/s²": 1, "g": G, "mm/s²": 1e-3}[unit]
        scale = [None, -1.5, 0.37][random.integers(3)]
        column = [None, "a", 3][random.integers(3)]
        rows = ["t,b,a" if column else "t,a"]
        rows += [f"{t!r},{'7,' if column else ''}{value!r}" for t, value in zip(times.tolist(), (values / factor).tolist())]
        file = place / "record.csv"
        file.write_text("\n".join(rows) + "\n")
        values = factor * (values / factor) * (scale or 1)
        asked["history"] = {"kind": "record", "of": of, "times": times, "values": values}
        word = str(file) + ("" if of == "base acceleration" and random.random() < 0.5 else f",of={of.replace(' ', '-')}")
        words += ["--record", word + (f",unit={unit}" if unit else "") + (f",column={column}" if column else "") + (f",scale={scale}" if scale else "")]
        end = times[-1]
    asked["after"] = [0.0, typed(end + random.uniform(0, 8) * period), typed(end * random.uniform(0.1, 1))][random.integers(3) if random.random() < 0.7 else 0]
    if asked["after"] or random.random() < 0.1:
        words += ["--after", f"{asked['after']}s"]
    asked["to"] = max(end, asked["after"]) + 10 * period
    asked["goal"] = GOALS[random.integers(len(GOALS))]
    words += ["--goal", asked["goal"]]
    asked["off"] = typed(log(0.01, 0.15), 3) if random.random() < 0.3 else 0.0
    if asked["off"]:
        words += ["--k1-error", f"{typed(100 * asked['off'])}%"]
    asked["limits"] = {}
    _, whole = values_of(asked, den_hartog(asked), COARSE, stiffnesses(asked, 5))
    for name in random.choice(LIMITS, random.integers(3), replace=False):
        name = str(name)
        value = asked["mass"] * omega**2 * log(0.2, 2) if name == "k2" else whole[name] * log(0.3, 2)
        asked["limits"][name] = typed(value)
        unit = {"stroke": "m", "x1max": "m", "a1max": "m/s²", "ground-force": "N", "k2": "N/m"}[name]
        words += ["--limit", f"{name}={asked['limits'][name]}{unit}"]
    return asked, words


def record(random, log, period):
    """Times (s) and values of a record, of size 1."""
    length, what = log(0.5, 30) * period, random.integers(7)
    step = log(0.01, 0.3) * period
    count = max(2, min(600, int(length / step)))
    step = float(f"{step:.3g}")
    times = np.arange(count + 1) * step
    turn = 2 * np.pi * times / period
    if what == 0:
        values = random.standard_normal(count + 1)
    elif what == 1:
        values = np.sin(turn * log(0.7, 1.4)) * np.exp(-((times - times[-1] / 2) / (0.2 * times[-1] + 1e-9)) ** 2)
    elif what == 2:
        values = np.cumsum(random.standard_normal(count + 1)) / math.sqrt(count)
    elif what == 3:  # few samples, far apart
        times = np.cumsum(np.concatenate([[random.choice([0, 0.3])], random.uniform(0.05, 3, random.integers(1, 8))])) * period
        values = random.uniform(-1, 1, len(times))
    elif what == 4:  # dense and sparse
        times = np.cumsum(np.concatenate([[0], np.exp(random.uniform(-6, 0, min(count, 300)))])) * period
        values = random.standard_normal(len(times))
    elif what == 5:
        values = np.sin(turn * log(0.3, 3))
    else:  # ends with a jump; begins late
        times = times + random.integers(1, 50) * step
        values = 1 + 0 * times
        values[0] = 0
    times = np.array([float(f"{t:.9g}") for t in times])
    if np.any(np.diff(times) <= 0):
        times = np.arange(len(times)) * step
    return times, values


def stiffnesses(asked, count):
    own = asked["m1"] * (2 * math.pi * asked["f1"]) ** 2
    return own * np.linspace(1 - asked["off"], 1 + asked["off"], count) if asked["off"] else np.array([own])


def den_hartog(asked, mass=None):
    m1, m2 = asked["m1"], mass or asked["mass"]
    mu = m2 / m1
    omega2 = 2 * math.pi * asked["f1"] / (1 + mu)
    return [m2, m2 * omega2**2, 2 * m2 * omega2 * math.sqrt(3 * mu / (8 * (1 + mu)))]


def phi(z):
    """(e^z - 1)/z and ((e^z - 1)/z - 1)/z."""
    small = abs(z) < 1e-2
    safe = np.where(small, 1, z)
    first = np.where(small, 1 + z / 2 * (1 + z / 3 * (1 + z / 4 * (1 + z / 5 * (1 + z / 6)))), (np.exp(safe) - 1) / safe)
    return first, np.where(small, 0.5 + z / 6 * (1 + z / 4 * (1 + z / 5 * (1 + z / 6 * (1 + z / 7)))), (first - 1) / safe)


def grid(asked, fastest, points):
    """Times of a grid with every jump of the history twice, and the forcing there (after the end none)."""
    history, to = asked["history"], asked["to"]
    dt = 2 * math.pi / fastest / points
    if history["kind"] == "pulse":
        end = history["duration"]
        forced = with_start(np.linspace(0, end, max(points, int(end / dt)) + 1), asked["after"])
    else:
        times = with_start(history["times"], asked["after"])
        parts = [np.linspace(a, b, max(1, math.ceil((b - a) / dt)) + 1)[:-1] for a, b in zip(times[:-1], times[1:])]
        forced = np.concatenate(parts + [times[-1:]])
        end = times[-1]
    return forced, with_start(np.linspace(end, to, max(points, int((to - end) / dt)) + 1), asked["after"])


def with_start(times, after):
    return np.insert(times, np.searchsorted(times, after), after) if times[0] < after < times[-1] and after not in times else times


def motion(asked, damper, points, k1):
    """Times, states (x1, v1, x2, v2) and accelerations of the structure, for each k1; exact at the points of a grid."""
    m1, history = asked["m1"], asked["history"]
    c1 = 2 * asked["zeta"] * 2 * math.pi * asked["f1"] * m1
    count = len(k1)
    size = 2 if damper is None else 4
    A = np.zeros((count, size, size))
    A[:, 0, 1] = 1
    A[:, 1, 0], A[:, 1, 1] = -k1 / m1, -c1 / m1
    b = np.zeros(size)
    b[1] = 1 / m1 if history["of"] == "force" else -1
    fastest = math.sqrt(k1[-1] / m1)
    if damper is not None:
        m2, k2, c2 = damper
        A[:, 2, 3] = 1
        A[:, 1] += np.array([-k2, -c2, k2, c2]) / m1
        A[:, 3] = np.array([k2, c2, -k2, -c2]) / m2
        if history["of"] != "force":
            b[3] = -1
        # What a strong dashpot holds does not oscillate.
        fastest = max(fastest, math.sqrt(k2 / m2 + k2 / m1) if c2 < 2 * math.sqrt(k2 * m2) * 1.5 else 0)
    for shift in [0, 1e-9, 1e-7, 1e-6]:
        own = A * (1 + shift * np.arange(size)[None, :, None] / 7)
        values, vectors = np.linalg.eig(own)
        weights = np.linalg.solve(vectors.astype(complex), np.broadcast_to(b, (count, size))[..., None].astype(complex))[..., 0]
        # Bodies of very different mass and stiffness are scaled before vectors are told apart.
        scale = np.linalg.norm(vectors, axis=-1, keepdims=True)
        if np.all(np.linalg.cond(vectors / np.where(scale > 0, scale, 1)) < 1e8):
            break
    forced, free = grid(asked, fastest, points)
    if history["kind"] == "pulse":
        p, T = history["peak"], history["duration"]
        waves = {"rectangle": [(p, 0)], "half-sine": [(-1j * p, math.pi / T)], "versed-sine": [(p / 2, 0), (-p / 2, 2 * math.pi / T)]}[history["shape"]]
        force = sum(np.real(F * np.exp(1j * W * forced)) for F, W in waves)
        y = 0
        for F, W in waves:
            # Real part of the answer to F e^{iWt}: modes by their weights.
            one = F * weights[..., None] * (np.exp(1j * W * forced) - np.exp(values[..., None] * forced)) / (1j * W - values[..., None])
            y = y + np.real(vectors @ one)
        last = y[..., -1]
    else:
        force = np.interp(forced, history["times"], history["values"])
        steps = np.diff(forced)
        z = np.zeros((count, size, len(forced)), complex)
        u = lambda h, f0, f1: (lambda both: h * ((both[0] - both[1]) * f0 + both[1] * f1))(phi(values[..., None] * h))
        drive = weights[..., None] * u(steps, force[:-1], force[1:])
        if np.ptp(steps) < 1e-9 * steps[0]:
            growth = np.exp(values * steps[0])
            for i in range(count):
                for j in range(size):
                    z[i, j, 1:] = lfilter([1], [1, -growth[i, j]], drive[i, j])
        else:
            growth = np.moveaxis(np.exp(values[..., None] * steps), -1, 0)
            drive, now, all_z = np.moveaxis(drive, -1, 0), np.zeros((count, size), complex), np.moveaxis(z, -1, 0)
            for i in range(len(steps)):
                now = growth[i] * now + drive[i]
                all_z[i + 1] = now
        y = np.real(vectors @ z)
        last = y[..., -1]
    begin = np.linalg.solve(vectors, last[..., None].astype(complex))
    later = np.real(vectors @ (begin * np.exp(values[..., None] * (free - free[0]))))
    base = history["of"] != "force"
    accelerate = lambda y, f: np.einsum("kn,knt->kt", A[:, 1], y) + (0 if base else f / m1)
    # The absolute acceleration is that by springs and dashpots alone.
    a = np.concatenate([accelerate(y, force), accelerate(later, 0)], axis=-1)
    return np.concatenate([forced, free]), np.concatenate([y, later], axis=-1), a, c1


def values_of(asked, damper, points, k1, each=False):
    """The largest values from `after` on, and over the whole run, over all k1 (or for each)."""
    t, y, a, c1 = motion(asked, damper, points, k1)
    m1 = asked["m1"]
    x, v = y[:, 0], y[:, 1]
    courses = {
        "E1max": 0.5 * (m1 * v**2 + k1[:, None] * x**2), "x1max": abs(x), "v1max": abs(v), "a1max": abs(a), "ground-force": abs(k1[:, None] * x + c1 * v),
        "stroke": abs(y[:, 2] - x) if damper is not None else 0 * x,
    }
    window = t >= asked["after"]
    over = (lambda course: np.max(course, axis=-1)) if each else (lambda course: float(np.max(course)))
    return {name: over(course[:, window]) for name, course in courses.items()}, {name: over(course) for name, course in courses.items()}


def broken(asked, damper, whole):
    """By how much the worst limit is broken, as a share of it."""
    whole = whole | {"k2": damper[1]}
    return max([whole[name] / most - 1 for name, most in asked["limits"].items()], default=-1.0)


def least(asked, told, evaluations=None):
    """The least goal of a TMD that keeps the limits, by the simplex from several starts; none where none was found."""
    m2, k2, c2 = den_hartog(asked)
    evaluations = evaluations or (100 if asked["history"]["kind"] == "pulse" else 60)
    k1 = stiffnesses(asked, STIFFNESSES)
    few = stiffnesses(asked, 3)
    scale = values_of(asked, None, COARSE, few)[0][asked["goal"]]

    def value(u, k1):
        if max(abs(u)) > 12 or u[0] > 3:
            return 1e30
        damper = [m2, k2 * math.exp(u[0]), c2 * math.exp(u[1])]
        window, whole = values_of(asked, damper, COARSE, k1)
        over = broken(asked, damper, whole) + MARGIN
        return 1e6 * (1 + over) if over > 0 else window[asked["goal"]] / scale

    starts = [(0, 0), (-0.7, 0.5), (-1.5, 1.5), (0.5, 2.5), (-3, 0.5)]
    if told:
        starts.append((math.log(max(told[1], 1e-5 * k2) / k2), math.log(max(told[2], 1e-5 * c2) / c2)))
    ends = []
    for at in starts:
        found = minimize(value, at, args=(few,), method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-7, "maxfev": evaluations, "initial_simplex": [at, (at[0] + 0.25, at[1]), (at[0], at[1] + 0.4)]})
        ends.append((found.fun, found.x))
    ends.sort(key=lambda end: end[0])
    best = None
    for _, at in ends[:2]:
        for size in [0.1, 0.02] if asked["history"]["kind"] == "pulse" else [0.05]:
            found = minimize(value, at, args=(k1,), method="Nelder-Mead", options={"xatol": 1e-6, "fatol": 1e-9, "maxfev": evaluations, "initial_simplex": [at, at + [size, 0], at + [0, size]]})
            at = found.x
        if best is None or found.fun < best[0]:
            best = (found.fun, at)
    return [m2, k2 * math.exp(best[1][0]), c2 * math.exp(best[1][1])] if best[0] < 1e5 else None


def wall_stiffness(contact):
    delta = lambda young, nu: (1 - nu**2) / (math.pi * young)
    number = lambda name: contact[name]
    R, q = number("R"), number("q")
    return [4 / 3 * q / ((delta(number(f"E{a}"), number(f"nu{a}")) + delta(number(f"E{a + 1}"), number(f"nu{a + 1}"))) * math.sqrt(1 / R)) for a in (1, 3)]


def struck(asked, design, k1):
    """Largest values of a damper with Hertz's walls without loss, by DOP853, from `after` on and over the whole run; with the largest contact force."""
    m1, m2, k2, c2, D, C = asked["m1"], design["m2"], design["k2"], design["c2"], design["D"], design["C"]
    c1 = 2 * asked["zeta"] * 2 * math.pi * asked["f1"] * m1
    K1, K3 = wall_stiffness(design["contact"])
    history = asked["history"]
    base = history["of"] != "force"
    if history["kind"] == "pulse":
        p, T = history["peak"], history["duration"]
        shape = {"rectangle": lambda t: p, "half-sine": lambda t: p * math.sin(math.pi * t / T), "versed-sine": lambda t: p / 2 * (1 - math.cos(2 * math.pi * t / T))}[history["shape"]]
        pieces = [(0, T, shape), (T, asked["to"], lambda t: 0.0)]
    else:
        times, samples = history["times"], history["values"]
        pieces = [(0, times[0], lambda t: 0.0)] if times[0] > 0 else []
        straight = lambda i: lambda t: samples[i] + (samples[i + 1] - samples[i]) * (t - times[i]) / (times[i + 1] - times[i])
        pieces += [(times[i], times[i + 1], straight(i)) for i in range(len(times) - 1)]
        pieces += [(times[-1], asked["to"], lambda t: 0.0)]

    def parts(y):
        r = y[2] - y[0]
        wall = K1 * max(-r, 0.0) ** 1.5 - K3 * max(r - D - C, 0.0) ** 1.5
        spring = k2 * (r - D) + c2 * (y[3] - y[1])
        return wall, spring

    def rate(t, y, force):
        f = force(t)
        wall, spring = parts(y)
        a1 = (-c1 * y[1] - k1 * y[0] + spring - wall) / m1
        a2 = (-spring + wall) / m2
        return [y[1], a1 - f if base else a1 + f / m1, y[3], a2 - f if base else a2]

    y, window, whole = [0.0, 0.0, D, 0.0], {}, {}
    step = 1 / asked["f1"] / 20
    for begin, end, force in pieces:
        if end <= begin:
            continue
        ran = solve_ivp(rate, (begin, end), y, method="DOP853", rtol=1e-9, atol=1e-13, args=(force,), max_step=step, dense_output=False)
        y = list(ran.y[:, -1])
        # Between steps by the steps of DOP853 alone they are too far apart for maxima: cubics from state and rate.
        for i in range(len(ran.t) - 1):
            t0, h = ran.t[i], ran.t[i + 1] - ran.t[i]
            ya, yb = ran.y[:, i], ran.y[:, i + 1]
            fa, fb = np.array(rate(t0, ya, force)), np.array(rate(t0 + h, yb, force))
            for s in np.linspace(0, 1, 9):
                z = (1 + 2 * s) * (1 - s) ** 2 * ya + s * (1 - s) ** 2 * h * fa + s * s * (3 - 2 * s) * yb + s * s * (s - 1) * h * fb
                t = t0 + s * h
                wall, spring = parts(z)
                a1 = (-c1 * z[1] - k1 * z[0] + spring - wall + (0 if base else force(t))) / m1
                now = {"E1max": 0.5 * (m1 * z[1] ** 2 + k1 * z[0] ** 2), "x1max": abs(z[0]), "v1max": abs(z[1]), "a1max": abs(a1),
                       "ground-force": abs(k1 * z[0] + c1 * z[1]), "stroke": abs(z[2] - z[0] - D), "contact-force": abs(wall)}
                for name, value in now.items():
                    whole[name] = max(whole.get(name, 0), value)
                    if t >= asked["after"]:
                        window[name] = max(window.get(name, 0), value)
    return window, whole


def table(text):
    """The rows of the printed table: a name, and a value in SI units for each candidate (none for a dash)."""
    lines = text.split("\n")
    first = next((i for i, line in enumerate(lines) if line.startswith("largest  ")), None)
    rows = {}
    for line in lines[first + 1:] if first is not None else []:
        if not line.strip():
            break
        cells = re.split(r"\s{2,}", line.strip())
        of = lambda cell: None if cell == "-" else float(cell.split(" ")[0]) * UNITS[cell.split(" ")[1]] if cell != "no bound" else math.inf
        rows[cells[0].split(" <=")[0]] = [of(cell) for cell in cells[1:]]
    return rows


def examine(retune, kind, number, counts, which="tmd"):
    """What is wrong with the answer to a request, in words."""
    faults = []
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        asked, words = request(kind, number, place)
        line = " ".join(words)
        out = place / "out"
        begin = time.time()
        try:
            ran = subprocess.run([retune, "design", *words, "--damper", which, "--threads", "1", "--out", str(out)], capture_output=True, text=True, timeout=300)
        except subprocess.TimeoutExpired:
            return [f"{number}: 300 s: {line}"]
        took = time.time() - begin
        counts["slowest"] = max(counts["slowest"], took)
        if took > 60:
            faults.append(f"the program took {took:.0f} s")
        counts["requests"] += 1
        if ran.returncode not in (0, 3):
            return [f"{number}: exit {ran.returncode}: {ran.stderr.strip()}: {line}"]
        text = ran.stdout
        for odd in re.findall(r".*(?:\bNaN\b|\binf\b|[ =(]0 (?:m|mm|µm|N|J|m/s²|kg)\b|panick|^(?!.*(?:sine|rectangle) of).* -\d+(?:\.\d+)? (?:m|N|J|kN|mm)\b.*|\b1 (?:designs|samples|structures)\b).*", text + ran.stderr):
            faults.append(f"odd words: {odd.strip()}")
        answer = json.loads((out / "design.json").read_text())
        of = {candidate["damper"]: candidate for candidate in answer["candidates"]}
        goal = asked["goal"].replace("-", "_")
        k1, many = stiffnesses(asked, STIFFNESSES), stiffnesses(asked, MANY)
        counts["off"] += asked["off"] > 0
        printed = table(text)
        names = [candidate["damper"] for candidate in answer["candidates"]]
        for quantity in of["TMD"]["in_window"]:
            row = printed.get(quantity.replace("_", " "))
            if row is None:
                if quantity not in ("contact_force", "contact_pressure"):
                    faults.append(f"no row of {quantity}")
                continue
            for name, cell in zip(names, row):
                told = of[name]["in_window"][quantity]["value"]
                if (cell or 0) == 0 and told == 0:
                    continue
                if cell is None or abs(cell / told - 1) > 6e-4:
                    faults.append(f"{quantity} of {name} printed as {cell}, in design.json {told}")
        of_tmd = None
        for name in ["no damper", "TMD"]:
            design = of[name]["design"]
            damper = design and [design["m2"], design["k2"], design["c2"]]
            window, whole = values_of(asked, damper, FINE, k1)
            differs = lambda quantity: abs(window[quantity] / max(of[name]["in_window"][quantity.replace("-", "_")]["value"], 1e-300) - 1) > OFF
            if any(differs(quantity) for quantity in window if window[quantity]):
                window, whole = values_of(asked, damper, 10 * FINE, k1)
            for quantity, value in window.items():
                told = of[name]["in_window"][quantity.replace("-", "_")]["value"]
                if abs(value - told) > OFF * max(value, told) and max(value, told) > 1e-9 * whole[quantity]:
                    faults.append(f"{quantity} of {name} told as {told}, is {value}")
            for quantity, value in whole.items():
                if "from_rest" in of[name]:
                    told = of[name]["from_rest"][quantity.replace("-", "_")]["value"]
                    if abs(value - told) > OFF * max(value, told):
                        faults.append(f"{quantity} of {name} from rest told as {told}, is {value}")
            if asked["off"]:
                wide, wide_whole = values_of(asked, damper, FINE, many)
                told = of[name]["in_window"][goal]["value"]
                counts["between"] = max(counts["between"], wide[asked["goal"]] / told - 1)
                if wide[asked["goal"]] > told * (1 + OVER):
                    faults.append(f"between k1: {goal} of {name} told as {told}, within k1 ± {asked['off']} up to {wide[asked['goal']]}")
                if name == "TMD" and of[name]["keeps_limits"] and broken(asked, damper, wide_whole) > OVER:
                    faults.append(f"between k1: the TMD is said to keep limits for all k1, and breaks one by {broken(asked, damper, wide_whole)}")
                rows = answer["k1_off"][names.index(name)]
                own = stiffnesses(asked, 3)[[1, 0, 2]]
                each = values_of(asked, damper, FINE, np.sort(own), True)[0][asked["goal"]][[1, 0, 2]]
                if np.any(abs(each / np.array(rows) - 1) > OFF):
                    faults.append(f"k1 off of {name}: told {rows}, is {each}")
            if name == "TMD":
                of_tmd = (damper, window, whole)
        damper, window, whole = of_tmd
        keeps = of["TMD"]["keeps_limits"]
        counts["kept"] += keeps
        if keeps and broken(asked, damper, whole) > 1e-4:
            faults.append(f"the TMD is said to keep limits that it breaks by {broken(asked, damper, whole)}")
        best = least(asked, damper)
        if best:
            found, found_whole = values_of(asked, best, FINE, k1)
            if broken(asked, best, found_whole) <= 0:
                if not keeps:
                    faults.append(f"no TMD is said to keep the limits, and {best} does: {found[asked['goal']]}; the told one breaks them by {broken(asked, damper, whole)}")
                elif window[asked["goal"]] > found[asked["goal"]] * (1 + WORSE):
                    faults.append(f"a better TMD is {best}: {found[asked['goal']]} instead of {window[asked['goal']]}, told with {damper}")
                if keeps:
                    counts["worse"] = max(counts["worse"], window[asked["goal"]] / found[asked["goal"]] - 1)
        for formula in answer["formulas"]:
            design = formula["damper"]["design"]
            own = [design["m2"], design["k2"], design["c2"]]
            window, whole = values_of(asked, own, FINE, k1)
            told = formula["damper"]["in_window"][goal]["value"]
            if abs(told / window[asked["goal"]] - 1) > OFF:
                faults.append(f"a formula has {told}, is {window[asked['goal']]}")
            over = broken(asked, own, whole)
            if abs(over) > 1e-3 and formula["damper"]["keeps_limits"] != (over <= 0):
                faults.append(f"a formula: keeps limits {formula['damper']['keeps_limits']}, breaks by {over}")
        # What each limit costs: the best without it.
        for name, cost in answer["limits"].items() if kind == "shock" or number % 4 == 0 else []:
            free = asked | {"limits": {own: most for own, most in asked["limits"].items() if own.replace("-", "_") != name}}
            design = cost["TMD_without"]["design"]
            own = [design["m2"], design["k2"], design["c2"]]
            best = least(free, own, 80)
            if best:
                found, found_whole = values_of(free, best, FINE, k1)
                value, value_whole = values_of(free, own, FINE, k1)
                if broken(free, best, found_whole) <= 0:
                    if not cost["TMD_without"]["keeps_limits"]:
                        faults.append(f"without {name} no TMD keeps the others, and {best} does")
                    elif value[asked["goal"]] > found[asked["goal"]] * (1 + WORSE):
                        faults.append(f"without {name} a better TMD is {best}: {found[asked['goal']]} instead of {value[asked['goal']]}")
        if answer["lightest_TMD"]:
            counts["lightest"] += 1
            share = re.search(r"give --mass ([0-9.e-]+%)", " ".join(text.split()))
            more = list(words)
            more[more.index("--mass") + 1] = share.group(1)
            again = subprocess.run([retune, "design", *more, "--damper", "tmd", "--threads", "1", "--json", "--out", str(place / "again")], capture_output=True, text=True)
            if again.returncode != 0:
                faults.append(f"--mass {share.group(1)} is said to keep the limits: exit {again.returncode}")
        elif not keeps and number % 3 == 0 and asked["mass"] < 0.3 * asked["m1"]:
            counts["none"] += 1
            heavy = asked | {"mass": 0.3 * asked["m1"]}
            best = least(heavy, None, 80)
            if best and broken(heavy, best, values_of(heavy, best, FINE, k1)[1]) <= 0:
                faults.append(f"no TMD of up to 30 % is said to keep the limits, and {best} does")
        ssvi = of.get("SSVI NES")
        if ssvi:
            counts["walls"] += 1
            at = ssvi["in_window"][goal].get("k1", float(stiffnesses(asked, 1)[0]))
            window, whole = struck(asked, ssvi["design"], at)
            told = ssvi["in_window"][goal]["value"]
            if abs(window[asked["goal"]] / told - 1) > OVER:
                faults.append(f"{goal} of the SSVI NES told as {told}, by DOP853 {window[asked['goal']]}; build {answer['build']}")
            if ssvi["keeps_limits"]:
                all_k1 = k1 if len(k1) == 1 else k1[::4]
                for one in all_k1:
                    _, whole = struck(asked, ssvi["design"], one)
                    over = broken(asked, [0, ssvi["design"]["k2"]], whole)
                    if over > OVER:
                        faults.append(f"the SSVI NES is said to keep limits that it breaks by {over} at k1 = {one}; build {answer['build']}")
    return [f"{number}: {fault}: {line}" for fault in faults]


def main():
    retune, wanted = sys.argv[1], {"shock": int(sys.argv[2]), "record": int(sys.argv[3])}
    which = sys.argv[4] if len(sys.argv) > 4 else "tmd"
    every = 0
    for kind, requests in wanted.items():
        counts = {"requests": 0, "off": 0, "kept": 0, "walls": 0, "lightest": 0, "none": 0, "between": 0.0, "worse": 0.0, "slowest": 0.0}
        faults = 0
        for number in range(requests):
            for fault in examine(retune, kind, number, counts, which):
                faults += 1
                print(f"{kind} {fault}", file=sys.stderr, flush=True)
        every += faults
        kept, worse = counts["kept"], max(counts["worse"], 0.0)
        print(f"| {kind}s | {counts['requests']} | {counts['off']} | {kept} | {counts['lightest']} | {worse:.1e} | {counts['between']:.1e} | {faults} |", flush=True)
    return bool(every)


if __name__ == "__main__":
    sys.exit(main())
