#!/usr/bin/env python3
"""Reference values for scenes of predictable motion, from SciPy alone.

Integrates equation (1) of the paper with SciPy's own integrators and writes `scipy_scenes.json` beside this file.
Nothing here comes from Retune, so agreement between the two is evidence.

    python3 tests/reference/scipy_scenes.py            every scene; writes scipy_scenes.json (some minutes, two processes)
    python3 tests/reference/scipy_scenes.py NAME...    these scenes only; prints, writes nothing

Each scene is integrated by DOP853 at rtol 1e-13 (the values written), again by DOP853 at another tolerance and step
limit, and, where the run is short, by Radau, another family of methods, some thirty times slower. All of them
 - freeze the contact phase (flight, touching the primary structure, touching the obstacle) over each piece, so that the
   right side is smooth inside a piece, and restart at every touch-down and lift-off;
 - look for phase changes between turning points of the gap inside each step, so that no contact is jumped over;
 - locate the maxima where the derivative is zero, and integrate (not interpolate) to the events and to the maxima.
A scene on which they differ by more than PREDICTABLE in E1max or another measure, or in an impact count, is an error: its
motion is not predictable at this horizon and it is no reference.

Units are SI throughout.
"""

import json
import math
import multiprocessing
import platform
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, NamedTuple, Optional

import numpy
import scipy
from scipy.integrate import DOP853, Radau
from scipy.optimize import brentq

PREDICTABLE = 1e-9  # largest allowed relative difference in a measure between two integrations
NUDGE = 1e-9  # shift of x1(0), m, that measures how much a scene amplifies errors


# ---------------------------------------------------------------------------------------------------------------------
# The scene and equation (1)
# ---------------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Scene:
    """One run. The defaults are the paper's; m2 = None means that there is no damper."""

    name: str
    T: float  # end of the run and of the window
    t0: float = 0.0  # start of the window
    m1: float = 1000.0
    c1: float = 452.0
    k1: float = 3.95e4
    m2: Optional[float] = 60.0
    k2: Optional[float] = None
    c2: Optional[float] = None
    D: Optional[float] = None
    C: Optional[float] = None
    P: float = 800.0
    omega: float = 6.28
    R: Optional[float] = 2.0
    q: Optional[float] = 0.318

    def __post_init__(self):
        delta_steel = compliance(2.1e11, 0.3)  # the surfaces of the primary structure and of the obstacle
        if self.m2 is not None:
            k_primary = hertz_stiffness(self.R, self.q, delta_steel, compliance(2.21e7, 0.4))
            k_obstacle = hertz_stiffness(self.R, self.q, delta_steel, compliance(2.05e7, 0.4))
            object.__setattr__(self, "K", {"primary": k_primary, "obstacle": k_obstacle})


def compliance(young, poisson):
    """delta of one surface."""
    return (1.0 - poisson**2) / (math.pi * young)


def hertz_stiffness(radius, q, delta_a, delta_b):
    """K of a sphere of this radius on a plane: A = B = 1/(2R)."""
    a_plus_b = 1.0 / radius
    return 4.0 / 3.0 * q / ((delta_a + delta_b) * math.sqrt(a_plus_b))


def approach(s, side, x1, x2):
    """z: how far the damper is pressed into this side; negative when apart."""
    return x1 - x2 if side == "primary" else x2 - x1 - (s.D + s.C)


def contact_force(s, phase, x1, x2):
    """Hertz force K z^(3/2) of the side being touched. Odd in z: a trial step may reach past the lift-off."""
    if phase == "flight":
        return 0.0
    z = approach(s, phase, x1, x2)
    return s.K[phase] * z * math.sqrt(abs(z))


def accelerations(s, phase, t, y):
    """(a1, a2) of equation (1), the phase frozen; a2 = 0 without a damper."""
    x1, v1, x2, v2 = y
    outer = s.P * math.cos(s.omega * t) - s.c1 * v1 - s.k1 * x1
    if s.m2 is None:
        return outer / s.m1, 0.0
    on_damper = -s.c2 * (v2 - v1) - s.k2 * (x2 - x1 - s.D)
    if phase == "primary":
        on_damper += contact_force(s, phase, x1, x2)
    elif phase == "obstacle":
        on_damper -= contact_force(s, phase, x1, x2)
    return (outer - on_damper) / s.m1, on_damper / s.m2


def right_side(s, phase):
    def f(t, y):
        y = y.tolist()  # plain floats are several times faster than numpy scalars
        a1, a2 = accelerations(s, phase, t, y)
        return [y[1], a1, y[3], a2]

    return f


def first_phase(s):
    """Phase just after t = 0. A gap that is zero there is decided by its acceleration (the start is at rest)."""
    if s.m2 is None:
        return "flight"
    y = start(s)
    a1, a2 = accelerations(s, "flight", 0.0, y)
    for side, closing in (("primary", a1 - a2), ("obstacle", a2 - a1)):
        z = approach(s, side, y[0], y[2])
        if z > 0.0 or (z == 0.0 and closing > 0.0):
            return side
    return "flight"


def start(s):
    return [0.0, 0.0, 0.0 if s.m2 is None else s.D, 0.0]


# ---------------------------------------------------------------------------------------------------------------------
# Steps of a SciPy integrator
# ---------------------------------------------------------------------------------------------------------------------


class Method(NamedTuple):
    solver: type
    rtol: float
    atol: float
    max_step: float  # s


PRIMARY = Method(DOP853, rtol=1e-13, atol=1e-15, max_step=0.02)
CROSS_CHECK = Method(DOP853, rtol=1e-12, atol=1e-14, max_step=0.013)
SLOW_CROSS_CHECK = Method(Radau, rtol=1e-11, atol=1e-14, max_step=0.02)
SLOW_HORIZON = 13.0  # s, longest run that is also integrated by SLOW_CROSS_CHECK


def cross_checks(s):
    return [CROSS_CHECK, SLOW_CROSS_CHECK] if s.T <= SLOW_HORIZON else [CROSS_CHECK]


class Step(NamedTuple):
    """One accepted step, possibly cut short at an event."""

    s: Scene
    method: Method
    phase: str
    t_a: float
    y_a: list
    t_b: float
    y_b: list
    dense: Callable

    def at(self, t):
        """Interpolated state."""
        return self.dense(t).tolist()

    def integrated(self, t):
        """State at t integrated from the start of the step: the dense outputs are of lower order than the methods."""
        return integrate(self.s, self.method, self.phase, self.t_a, self.y_a, t)


def accepted_steps(s, method, phase, t, y, t_end):
    if t >= t_end:
        return
    solver = method.solver(
        right_side(s, phase), t, y, t_end, rtol=method.rtol, atol=method.atol, max_step=method.max_step
    )
    while solver.status == "running":
        t_a, y_a = solver.t, solver.y.tolist()
        problem = solver.step()
        if solver.status == "failed":
            raise RuntimeError(f"{s.name}: t = {t_a}: {problem}")
        yield Step(s, method, phase, t_a, y_a, solver.t, solver.y.tolist(), solver.dense_output())


def integrate(s, method, phase, t, y, t_end):
    """State at t_end, within one phase."""
    if t_end <= t:
        return y
    solver = method.solver(
        right_side(s, phase), t, y, t_end, rtol=method.rtol, atol=method.atol, first_step=t_end - t
    )
    while solver.status == "running":
        problem = solver.step()
    if solver.status == "failed":
        raise RuntimeError(f"{s.name}: t = {t}: {problem}")
    return solver.y.tolist()


def samples(step, pieces=4):
    """[(t, y)] at the ends of the step and between."""
    times = [step.t_a + (step.t_b - step.t_a) * i / pieces for i in range(1, pieces)]
    return [(step.t_a, step.y_a), *zip(times, step.dense(times).T.tolist()), (step.t_b, step.y_b)]


def sign_changes(sampled, function):
    """Brackets (left, right), in order, over which function(t, y) changes sign."""
    values = [function(t, y) for t, y in sampled]
    return [
        (sampled[i][0], sampled[i + 1][0])
        for i in range(len(values) - 1)
        if (values[i] <= 0.0 < values[i + 1]) or (values[i] >= 0.0 > values[i + 1])
    ]


def root(function, left, right):
    """Root in the bracket to rounding; an end of the bracket if rounding has spoilt the sign change."""
    f_left, f_right = function(left), function(right)
    if f_left * f_right > 0.0:
        return left if abs(f_left) < abs(f_right) else right
    return brentq(function, left, right, xtol=1e-16, rtol=4 * numpy.finfo(float).eps)


# ---------------------------------------------------------------------------------------------------------------------
# Contact: touch-down and lift-off
# ---------------------------------------------------------------------------------------------------------------------


def ways_out(phase):
    """(side, sign, next phase): the phase ends where sign * approach(side) rises through zero."""
    if phase == "flight":
        return [("primary", 1.0, "primary"), ("obstacle", 1.0, "obstacle")]
    return [(phase, -1.0, "flight")]


def phase_change(step, sampled):
    """(time, state, next phase) of the first touch-down or lift-off in the step, or None."""
    s = step.s

    def relative_velocity(t, y):
        return y[3] - y[1]

    # Between turning points of x2 - x1 every gap is monotone, so comparing ends misses nothing, however short the contact.
    turns = [
        root(lambda t: relative_velocity(t, step.at(t)), left, right)
        for left, right in sign_changes(sampled, relative_velocity)
    ]
    times = [step.t_a] + turns + [step.t_b]
    states = [step.y_a] + [step.at(t) for t in turns] + [step.y_b]
    found = []
    for side, sign, next_phase in ways_out(step.phase):

        def g(y):
            return sign * approach(s, side, y[0], y[2])

        for i in range(len(times) - 1):
            if g(states[i]) <= 0.0 < g(states[i + 1]):
                t = root(lambda t: g(step.at(t)), times[i], times[i + 1])
                rate = -sign if side == "primary" else sign
                found.append((*polished(step, g, rate, t), next_phase))
                break
    return min(found, default=None, key=lambda event: event[0])


def polished(step, g, rate, t):
    """Newton on the integrated state from the interpolated root t; d(x2 - x1)/dt times `rate` is dg/dt."""
    y = step.integrated(t)
    for _ in range(4):
        slope = rate * (y[3] - y[1])
        shift = -g(y) / slope if slope != 0.0 else 0.0
        if not (step.t_a <= t + shift <= step.t_b) or abs(shift) > 1e-3 * (step.t_b - step.t_a):
            break  # a graze: Newton is of no use, the interpolated root is as good
        if t + shift == t:
            break
        t += shift
        y = step.integrated(t)
        if abs(shift) < 1e-15:
            break
    return t, y


# ---------------------------------------------------------------------------------------------------------------------
# Maxima over the window
# ---------------------------------------------------------------------------------------------------------------------


def primary_energy(s, phase, t, y):
    return 0.5 * (s.m1 * y[1] ** 2 + s.k1 * y[0] ** 2)


def primary_energy_rates(s, phase, t, y):
    """dE1/dt is the product of these two."""
    a1, _ = accelerations(s, phase, t, y)
    return y[1], s.m1 * a1 + s.k1 * y[0]


def damper_energy(s, phase, t, y):
    """The paper's E2."""
    return 0.5 * (s.m2 * y[3] ** 2 + s.k2 * (y[2] - s.D) ** 2)


def damper_energy_rates(s, phase, t, y):
    _, a2 = accelerations(s, phase, t, y)
    return y[3], s.m2 * a2 + s.k2 * (y[2] - s.D)


def force_on(side):
    def force(s, phase, t, y):
        return contact_force(s, phase, y[0], y[2]) if phase == side else 0.0

    return force


def displacement(s, phase, t, y):
    return abs(y[2] - y[0])


def displacement_rates(s, phase, t, y):
    """The relative displacement and the contact forces have their maxima where x2 - x1 turns."""
    return (y[3] - y[1],)


class Maximum:
    """Largest value of `value` seen, at a zero of one of the factors `rates` of its derivative or at an end of the window."""

    def __init__(self, value, rates):
        self.value, self.rates = value, rates
        self.candidates = []  # (value, t, step, bracket, index of the factor that is zero)
        self.best = -math.inf

    def add(self, t, y, step, bracket=None, index=None):
        value = self.value(step.s, step.phase, t, y)
        self.candidates.append((value, t, step, bracket, index))
        self.best = max(self.best, value)

    def look(self, step, sampled):
        s, phase = step.s, step.phase
        if max(self.value(s, phase, t, y) for t, y in (sampled[0], sampled[-1])) < 0.5 * self.best:
            return  # steps are short beside the motion: nothing inside this one can double
        for index in range(len(self.rates(s, phase, *sampled[0]))):
            for left, right in sign_changes(sampled, lambda t, y: self.rates(s, phase, t, y)[index]):
                t = root(lambda t: self.rates(s, phase, t, step.at(t))[index], left, right)
                self.add(t, step.at(t), step, (left, right), index)

    def result(self):
        """(value, t, phase), integrated to the maximum and not interpolated."""
        found = []
        for value, t, step, bracket, index in self.candidates:
            if value < self.best * (1.0 - 1e-8):
                continue  # beaten by more than the interpolation can be wrong
            if bracket is not None:
                t = root(lambda t: self.rates(step.s, step.phase, t, step.integrated(t))[index], *bracket)
            found.append((self.value(step.s, step.phase, t, step.integrated(t)), t, step.phase))
        return max(found)

    def runner_up(self, t_best):
        """Largest other local maximum (interpolated): t of the maximum says little where the two are nearly equal."""
        return max((value for value, t, *_ in self.candidates if abs(t - t_best) > 1e-6), default=None)


# ---------------------------------------------------------------------------------------------------------------------
# One run, and one scene
# ---------------------------------------------------------------------------------------------------------------------


def run(s, method, nudge=0.0):
    """Integrate the scene; the measures over the window [t0, T]. `nudge` shifts x1(0)."""
    maxima = {"E1": Maximum(primary_energy, primary_energy_rates)}
    if s.m2 is not None:
        maxima["E2"] = Maximum(damper_energy, damper_energy_rates)
        maxima["primary"] = Maximum(force_on("primary"), displacement_rates)
        maxima["obstacle"] = Maximum(force_on("obstacle"), displacement_rates)
        maxima["displacement"] = Maximum(displacement, displacement_rates)
    impacts = {"primary": 0, "obstacle": 0}
    longest_contact, touch_down = 0.0, 0.0

    t, y, phase = 0.0, start(s), first_phase(s)
    y[0] += nudge
    for t_end in (s.t0, s.T):
        in_window = t_end == s.T
        first = True
        while t < t_end:
            for step in accepted_steps(s, method, phase, t, y, t_end):
                sampled = samples(step)
                change = None if s.m2 is None else phase_change(step, sampled)
                if change is not None:
                    step = step._replace(t_b=change[0], y_b=change[1])
                    sampled = samples(step)
                t, y = step.t_b, step.y_b
                if in_window:
                    for maximum in maxima.values():
                        if first:
                            maximum.add(step.t_a, step.y_a, step)
                        maximum.look(step, sampled)
                        if t == s.T:
                            maximum.add(t, y, step)
                    first = False
                if change is not None:
                    if phase == "flight":
                        touch_down = t
                    elif in_window:
                        longest_contact = max(longest_contact, t - touch_down)
                    phase = change[2]
                    if in_window and phase != "flight":
                        impacts[phase] += 1
                    break

    e1, t_e1, phase_e1 = maxima["E1"].result()
    measured = {
        "E1max": e1,
        "t_E1max": t_e1,
        "E1max_phase": phase_e1,
        "E1max_runner_up": maxima["E1"].runner_up(t_e1),
    }
    if s.m2 is None:
        nothing = ("E2max", "force_max_primary", "force_max_obstacle", "relative_displacement_max")
        measured |= {name: None for name in nothing + ("impacts_primary", "impacts_obstacle", "longest_contact")}
        return measured | {"state_T": y[:2] + [None, None]}
    return measured | {
        "E2max": maxima["E2"].result()[0],
        "force_max_primary": maxima["primary"].result()[0],
        "force_max_obstacle": maxima["obstacle"].result()[0],
        "relative_displacement_max": maxima["displacement"].result()[0],
        "impacts_primary": impacts["primary"],
        "impacts_obstacle": impacts["obstacle"],
        "longest_contact": longest_contact,
        "state_T": y,
    }


def distance(s, state_a, state_b):
    """Euclidean distance of two states, m, velocities divided by omega."""
    scale = (1.0, s.omega, 1.0, s.omega)
    return math.sqrt(sum(((a - b) / c) ** 2 for a, b, c in zip(state_a, state_b, scale) if a is not None))


def reference(s):
    """(entry, whether it is a reference, one line for the reader): values by PRIMARY, and how far they can be trusted."""
    clock = time.perf_counter()
    values = run(s, PRIMARY)
    seconds_primary = time.perf_counter() - clock
    others = [run(s, method) for method in cross_checks(s)]
    nudged = run(s, PRIMARY, NUDGE)
    seconds = time.perf_counter() - clock

    def disagreement(measure):
        return max(abs(other[measure] - values[measure]) for other in others) / (abs(values[measure]) or 1.0)

    measures = [m for m in ("E2max", "force_max_primary", "force_max_obstacle", "relative_displacement_max") if values[m] is not None]
    counts = ("impacts_primary", "impacts_obstacle")
    counts_agree = all(run_[count] == values[count] for run_ in (*others, nudged) for count in counts)
    trust = {
        "E1max_disagreement": disagreement("E1max"),
        "other_measures_disagreement": max(map(disagreement, measures), default=None),
        "state_T_disagreement": max(distance(s, values["state_T"], other["state_T"]) for other in others),
        "amplification": distance(s, values["state_T"], nudged["state_T"]) / NUDGE,
    }
    good = counts_agree and max(trust["E1max_disagreement"], trust["other_measures_disagreement"] or 0.0) <= PREDICTABLE
    trust["cross_checks"] = [method.solver.__name__ for method in cross_checks(s)]
    scene = {name: getattr(s, name) for name in "name m1 c1 k1 m2 k2 c2 D C P omega R q T t0".split()}
    if s.m2 is None:
        scene |= {"R": None, "q": None}
    summary = (
        f"{'ok ' if good else 'BAD'} {s.name:28} E1max {values['E1max']:.10g} J at {values['t_E1max']:.4f} s "
        f"({values['E1max_phase']}), impacts {values['impacts_primary']} + {values['impacts_obstacle']}"
        f"{'' if counts_agree else ' COUNTS DIFFER'}; "
        + ", ".join(f"{name} {value:.1e}" for name, value in trust.items() if isinstance(value, float))
        + f", {' and '.join(trust['cross_checks'])}"
        + f"; {seconds_primary:.1f} of {seconds:.1f} s"
    )
    return scene | values | trust, good, summary


# ---------------------------------------------------------------------------------------------------------------------
# The scenes. Horizons are as long as the motion stays predictable, and no longer than 100 s.
# ---------------------------------------------------------------------------------------------------------------------

ROW1 = dict(k2=150.0, c2=218.4, D=0.06, C=0.11)  # Table 1
ROW2 = dict(k2=210.0, c2=218.4, D=0.06, C=0.11)
ROW3 = dict(k2=220.375, c2=233.45, D=0.060375, C=0.36225)
SSVI = dict(k2=215.0, c2=232.0, D=0.06, C=0.36)  # Table 2
TMD = dict(k2=600.0, c2=262.0, D=2.08, C=4.7)

SCENES = [
    Scene("bare", T=100, m2=None),
    Scene("bare_after_transient", T=100, t0=50, m2=None, k1=3e4, omega=5.5),
    Scene("tmd", T=100, **TMD),
    Scene("tmd_after_transient", T=100, t0=50, omega=5.5, **TMD),
    Scene("tmd_stiff_spring", T=60, t0=20, **(TMD | dict(k2=2083.2, c2=111.76))),
    Scene("tmd_heavy", T=12, m2=200.0, k1=5e4, omega=7.0, **(TMD | dict(k2=6000.0, c2=500.0))),
    Scene("row1", T=13, **ROW1),
    Scene("row2", T=11, **ROW2),
    Scene("row1_omega5.8", T=9.5, t0=4, omega=5.8, **ROW1),
    Scene("row3", T=100, **ROW3),
    Scene("row3_after_transient", T=100, t0=50, **ROW3),
    Scene("ssvi", T=60, **SSVI),
    Scene("ssvi_R0.0133", T=40, R=0.0133, **SSVI),
    Scene("ssvi_R0.1", T=40, R=0.1, **SSVI),
    Scene("ssvi_R10", T=40, R=10.0, **SSVI),
    Scene("ssvi_k2e4", T=13, k1=2e4, omega=5.0, **SSVI),
    Scene("ssvi_k3e4", T=40, k1=3e4, omega=5.6, **SSVI),
    Scene("ssvi_k5e4", T=30, k1=5e4, omega=7.1, **SSVI),
    Scene("ssvi_k6e4", T=40, k1=6e4, omega=8.0, **SSVI),
    Scene("ssvi_omega5.5", T=20, omega=5.5, **SSVI),
    Scene("ssvi_omega7", T=40, t0=10, omega=7.0, **SSVI),
    Scene("light_damper", T=40, m2=20.0, k2=100.0, c2=80.0, D=0.05, C=0.3),
    Scene("heavy_damper", T=20, m2=200.0, k2=800.0, c2=600.0, D=0.06, C=0.36),
    Scene("stiff_spring_two_sided", T=40, k2=2400.0, c2=100.0, D=0.1, C=0.1),
    Scene("small_clearance", T=12, k2=300.0, c2=300.0, D=0.06, C=0.02),
    Scene("no_clearance", T=13, k2=300.0, c2=300.0, D=0.2, C=0.0),
    Scene("no_distance", T=13, k2=600.0, c2=200.0, D=0.0, C=5.0),
    Scene("no_distance_two_sided", T=15, k2=600.0, c2=200.0, D=0.0, C=0.15),
    Scene("soft_contact", T=13, R=1e-6, k2=400.0, c2=150.0, D=0.02, C=0.3),
    Scene("long_contact", T=20, R=1e-8, k2=600.0, c2=100.0, D=0.0, C=5.0),
    Scene("overdamped_one_sided", T=20, k2=600.0, c2=600.0, D=0.05, C=1.0),
    Scene("late_window_two_sided", T=30, t0=12.5, k2=500.0, c2=300.0, D=0.08, C=0.15, R=0.5),
    Scene("medium_damper_R0.03", T=40, m2=120.0, k2=500.0, c2=400.0, D=0.04, C=0.2, R=0.03),
    Scene("k4.5e4_R0.5", T=40, t0=20, k1=4.5e4, omega=6.7, R=0.5, **SSVI),
    Scene("tiny_clearance", T=9.9, k2=300.0, c2=250.0, D=0.03, C=0.004, R=0.0133),
    Scene("half_force", T=40, P=400.0, **SSVI),
    Scene("small_force_without_contact", T=60, P=200.0, **SSVI),
]

ANCHORS = {"row1": 760.98507, "row3": 554.53804, "tmd": 635.1147}  # J, found earlier by other programs


def main(names):
    unknown = set(names) - {s.name for s in SCENES}
    if unknown:
        sys.exit(f"no such scene: {', '.join(sorted(unknown))}")
    chosen = [s for s in SCENES if not names or s.name in names]
    entries, good = [], True
    with multiprocessing.Pool(2) as pool:
        for entry, entry_good, summary in pool.imap(reference, chosen):
            print(summary, flush=True)
            entries.append(entry)
            good &= entry_good
            anchor = ANCHORS.get(entry["name"])
            if anchor is not None and abs(entry["E1max"] - anchor) > 1e-7 * anchor:
                print(f"    but other programs have {anchor} J")
                good = False
    if not good:
        sys.exit("not every scene is a reference: nothing written")
    if names:
        return
    used = (PRIMARY, CROSS_CHECK, SLOW_CROSS_CHECK)
    described = [f"{m.solver.__name__} rtol {m.rtol:g} atol {m.atol:g} max_step {m.max_step:g} s" for m in used]
    provenance = {
        "script": "tests/reference/scipy_scenes.py",
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
        "method": f"{described[0]}; cross-checks: {described[1]}, and where T <= {SLOW_HORIZON:g} s {described[2]}; "
        "restarted at every touch-down and lift-off",
        "rtol": PRIMARY.rtol,
    }
    output = Path(__file__).with_suffix(".json")
    temporary = output.with_suffix(".json.tmp")
    temporary.write_text(json.dumps({"provenance": provenance, "scenes": entries}, indent=1) + "\n")
    temporary.replace(output)


if __name__ == "__main__":
    main(sys.argv[1:])
