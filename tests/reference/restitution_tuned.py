#!/usr/bin/env python3
"""Reference values for the tuned SSVI NES with contacts of one restitution at every speed, from SciPy alone.

Integrates equation (1) of the paper for the damper k2 = 583.9 N/m, c2 = 94.97 N s/m, D = 0.02885 m, C = 1.105 m from rest to 100 s, and prints
the largest E1 from 50 s on at five restitutions, each at a frequency where it is about the largest over 5 to 8 rad/s. Nothing here comes from
Retune but these frequencies; at the maximum over a band the value does not depend on their last digits.

    python3 tests/reference/restitution_tuned.py        prints its numbers (half a minute)

The force of a contact is F = K z^1.5 (1 + chi h), by two laws that agree in an undisturbed collision:

- `state`: h = z'/v with the touch-down speed v of the undisturbed collision through the present z and z' (docs/theory.md), found here by
  Brent's method: (2/5) K/m z^2.5 = v^2 G(h), G(h) the integral of s/(1 + chi s) from h to 1, m the reduced mass;
- `touch`: h = z'/v with the speed v that the contact began with (Lankarani and Nikravesh, with the exact chi).

chi follows from G(-e) = 0. Every piece of a run, flight or contact, ends at an event. Units are SI throughout.
"""

import math

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

M1, C1, K1, P = 1000.0, 452.0, 3.95e4, 800.0
M2, K2, C2, D, C = 60.0, 583.9, 94.97, 0.02885, 1.105
REDUCED = M1 * M2 / (M1 + M2)
FROM, TO = 50.0, 100.0
PLACES = [(1.0, 6.63145), (0.9, 6.54592), (0.8, 6.37573), (0.7, 6.22592), (0.6, 6.21923)]


def stiffness(young):
    """K of a sphere on a plane: steel of the wall, and the damper's surface."""
    delta = lambda E, nu: (1.0 - nu**2) / (math.pi * E)
    return 4.0 / 3.0 * 0.318 / ((delta(2.1e11, 0.3) + delta(young, 0.4)) * math.sqrt(1.0 / 2.0))


K = [stiffness(2.21e7), stiffness(2.05e7)]


def g(h, chi):
    """G(h)"""
    inner = lambda s: s / chi - math.log1p(chi * s) / chi**2
    return inner(1.0) - inner(h)


def chi_of(e):
    return 0.0 if e == 1.0 else brentq(lambda chi: g(-e, chi), 1e-3, (1.0 - 1e-13) / e, xtol=1e-15)


def stage(e, chi, s, w):
    """h of a contact with (2/5) K/m z^2.5 = s and z' = w."""
    if w == 0.0:
        return 0.0
    end = 1.0 if w > 0.0 else -e
    residual = lambda h: w * w * g(h, chi) - h * h * s
    inner, outer = math.copysign(1e-14, w), end * (1.0 - 1e-15)
    return end if residual(inner) * residual(outer) > 0.0 else brentq(residual, inner, outer, xtol=1e-15)


def depth(y, wall):
    r = y[2] - y[0]
    return -r if wall == 0 else r - D - C


def rate(y, wall):
    return y[1] - y[3] if wall == 0 else y[3] - y[1]


def force(y, wall, factor):
    z = depth(y, wall)
    return K[wall] * z**1.5 * factor(z, rate(y, wall)) if z > 0.0 else 0.0


def factor_of(e, chi, law, wall, v):
    if chi == 0.0:
        return lambda z, w: 1.0
    if law == "touch":
        return lambda z, w: 1.0 + chi * w / v
    return lambda z, w: 1.0 + chi * stage(e, chi, 0.4 * K[wall] / REDUCED * z**2.5, w)


def right_side(omega, wall, factor):
    def f(t, y):
        on_damper = -C2 * (y[3] - y[1]) - K2 * (y[2] - y[0] - D)
        if wall is not None:
            on_damper += (1.0 if wall == 0 else -1.0) * force(y, wall, factor)
        a1 = (P * math.cos(omega * t) - C1 * y[1] - K1 * y[0] - on_damper) / M1
        return [y[1], a1, y[3], on_damper / M2]

    return f


def ends(wall):
    """The events that end a piece, each with its wall."""

    def end(w):
        event = lambda t, y: depth(y, w)
        event.terminal, event.direction = True, 1 if wall is None else -1
        return event

    return [(w, end(w)) for w in ((0, 1) if wall is None else (wall,))]


def largest(e, omega, law):
    chi = chi_of(e)
    t, y, wall, factor, most = 0.0, numpy.array([0.0, 0.0, D, 0.0]), None, None, 0.0
    while t < TO:
        events = ends(wall)
        step, rows = (0.02, 1e-4) if wall is None else (0.0015, 2e-6)
        piece = solve_ivp(right_side(omega, wall, factor), (t, TO), y, "DOP853", rtol=1e-10, atol=1e-13,
                          max_step=step, events=[event for _, event in events], dense_output=True)
        end = piece.t[-1]
        if end > FROM:
            begin = max(t, FROM)
            x1, v1 = piece.sol(numpy.linspace(begin, end, 2 + int((end - begin) / rows)))[:2]
            most = max(most, (0.5 * M1 * v1**2 + 0.5 * K1 * x1**2).max())
        t, y = end, piece.y[:, -1].copy()
        if piece.status == 1 and wall is None:
            wall = next(w for (w, _), times in zip(events, piece.t_events) if len(times))
            factor = factor_of(e, chi, law, wall, rate(y, wall))
        else:
            wall = None
    return most


if __name__ == "__main__":
    for e, omega in PLACES:
        values = [f"{law} {largest(e, omega, law):.5f} J" for law in ("state", "touch")]
        print(f"e = {e}, omega = {omega} rad/s: {', '.join(values)}", flush=True)
