"""Finds periodic motions of results/branches again with SciPy, and their Floquet multipliers.

    python3 tests/reference/orbits.py [--each N]      from the root of the repository; needs numpy and scipy

Nothing of Retune is used but its tables: equation (1) is written down here, integrated by DOP853 together with its variational
equations, restarted at every touch-down and lift-off, and Newton's iteration finds each motion from a first state that is rounded to
three digits (five or seven where three lead to another motion). Compared are the state at a crest of the force (1e-8 of the motion's size) and the modulus of the largest multiplier
(1e-6). Exits with 1 if one differs.
"""

import argparse
import csv
import json
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

PLACES = ["paper", "tuned", "global", "isola"]


class Scene:
    def __init__(self, scene, omega):
        primary, damper = scene["primary"], scene["damper"]
        self.m1, self.c1, self.k1 = primary["m1"], primary["c1"], primary["k1"]
        self.P, self.omega = scene["forcing"]["P"], omega
        self.m2, self.k2, self.c2 = damper["m2"], damper["k2"], damper["c2"]
        self.D, self.C = damper["D"], damper["C"]
        contact = damper["contact"]

        def stiffness(a, b):
            delta = sum((1 - contact[f"nu{i}"] ** 2) / (np.pi * contact[f"E{i}"]) for i in (a, b))
            return 4 / 3 * contact["q"] / (delta * np.sqrt(1 / contact["R"]))

        self.K = [stiffness(1, 2), stiffness(3, 4)]

    def depths(self, y):
        r = y[2] - y[0]
        return -r, r - (self.D + self.C)

    def rate(self, t, y, contact):
        """Equation (1) and its variational equations; `contact` is the wall that is touched, or None."""
        x1, v1, x2, v2 = y[:4]
        force, slope = 0.0, 0.0
        if contact is not None:
            z = max(self.depths(y)[contact], 0.0)
            force = (1, -1)[contact] * self.K[contact] * z**1.5  # on the damper
            slope = 1.5 * self.K[contact] * np.sqrt(z)
        on_damper = force - self.c2 * (v2 - v1) - self.k2 * (x2 - x1 - self.D)
        a1 = (self.P * np.cos(self.omega * t) - self.c1 * v1 - self.k1 * x1 - on_damper) / self.m1
        k, c = self.k2 + slope, self.c2
        A = np.array(
            [
                [0, 1, 0, 0],
                [-(self.k1 + k) / self.m1, -(self.c1 + c) / self.m1, k / self.m1, c / self.m1],
                [0, 0, 0, 1],
                [k / self.m2, c / self.m2, -k / self.m2, -c / self.m2],
            ]
        )
        return np.concatenate([[v1, a1, v2, on_damper / self.m2], (A @ y[4:].reshape(4, 4)).ravel()])

    def flow(self, y, periods):
        """The state after some periods and its derivative by the first one."""
        y = np.concatenate([y, np.eye(4).ravel()])
        t, end = 0.0, periods * 2 * np.pi / self.omega
        contact = next((i for i in (0, 1) if self.depths(y)[i] > 0), None)
        while t < end:
            if contact is None:
                events = [lambda t, y, i=i: self.depths(y)[i] for i in (0, 1)]
                directions = (1, 1)
            else:
                events, directions = [lambda t, y, i=contact: self.depths(y)[i]], (-1,)
            for event, direction in zip(events, directions):
                event.terminal, event.direction = True, direction
            # Steps of 0.02 s miss a wall that is hardly touched: events are looked for at the ends of steps only.
            longest = (end - t) if contact is not None else 0.002
            run = solve_ivp(
                lambda t, y: self.rate(t, y, contact), (t, end), y, "DOP853", rtol=1e-12, atol=1e-14, events=events,
                max_step=longest,
            )
            assert run.success, run.message
            t, y = run.t[-1], run.y[:, -1]
            if run.status == 1:
                touched = [i for i, found in enumerate(run.t_events) if len(found)]
                contact = touched[0] if contact is None else None
        return y[:4], y[4:].reshape(4, 4)

    def periodic(self, y, periods):
        for _ in range(12):
            end, M = self.flow(y, periods)
            change = np.linalg.solve(np.eye(4) - M, end - y)
            y = y + change
            if np.abs(change).max() < 1e-11:
                break
        return y, self.flow(y, periods)[1]


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--each", type=int, default=7, help="motions of each damper")
    each = parser.parse_args().each
    worst_state, worst_multiplier, count = 0.0, 0.0, 0
    for place in PLACES:
        place = Path("results/branches") / place
        scene = json.loads((place / "resolved.json").read_text())["dampers"][0]["study"]["scene"]
        first = {
            (row["branch"], row["place"]): np.array([float(row[name]) for name in ("x1", "v1", "x2", "v2")])
            for row in rows(place / "states.csv")
            if row["segment"] == "0"
        }
        # Stable motions of a few periods with impacts, away from bifurcations: beside one there is another motion, which a rounded start
        # may lead to.
        events = {(row["branch"], int(row["place"])) for row in rows(place / "bifurcations.csv")}
        known = [
            row
            for row in rows(place / "branches.csv")
            if int(row["periods"]) <= 3
            and float(row["multiplier"]) < 0.9
            and row["impacts"]
            and not any((row["branch"], int(row["place"]) + k) in events for k in range(-4, 5))
        ]
        for i in range(each):
            row = known[(2 * i + 1) * len(known) // (2 * each)]
            expected = first[row["branch"], row["place"]]
            own = Scene(scene, float(row["omega"]))
            # Nearly hard walls have motions close beside each other: where three digits lead to another one, more are given.
            for digits in (3, 5, 7):
                start = np.array([float(f"{value:.{digits - 1}e}") for value in expected])
                found, M = own.periodic(start, int(row["periods"]))
                state = np.abs(found - expected).max() / np.abs(expected).max()
                multiplier = abs(np.abs(np.linalg.eigvals(M)).max() - float(row["multiplier"]))
                if state < 1e-8:
                    break
            print(
                f"{place.name:>7} omega = {float(row['omega']):.6f}, {row['periods']} periods, impacts {row['impacts']:<4}: "
                f"from {digits} digits state to {state:.1e}, largest multiplier to {multiplier:.1e}"
            )
            worst_state, worst_multiplier = max(worst_state, state), max(worst_multiplier, multiplier)
            count += 1
    print(f"{count} motions: states to {worst_state:.1e}, largest multipliers to {worst_multiplier:.1e}")
    sys.exit(0 if worst_state < 1e-8 and worst_multiplier < 1e-6 else 1)


if __name__ == "__main__":
    main()
