"""Folds of Duffing's oscillator by harmonic balance: x'' + 2 zeta x' + x + gamma x^3 = f cos(omega t).

The response is a sum of odd harmonics of omega/n, for the main resonance n = 1, for the subharmonic resonance n = 3. The cubic is exact on the
grid of times. A fold solves F = 0, J v = 0, |v| = 1 by Newton's iteration. With one harmonic these are the folds of the textbook's frequency
response [omega^2 - 1 - 3/4 gamma a^2]^2 + (2 zeta omega)^2 = (f/a)^2 (A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, 1979, section 4.1),
which is checked. With twice the harmonics no fold may move by more than 1e-9.

    python3 tests/reference/duffing.py          writes tests/reference/duffing.json (numpy only, some seconds)
"""

import json
import pathlib
import platform

import numpy as np

SYSTEM = {"zeta": 0.02, "gamma": 0.2, "f": 3.0}
# The name, the order of the subharmonic, a frequency at which the motion exists, the size of its first harmonic there.
MOTIONS = [("main", 1, 7.0, 0.1), ("subharmonic", 3, 4.0, 2.0)]
RANGE = (1.5, 8.0)


class Balance:
    """Harmonic balance with the first `harmonics` odd harmonics of omega/n."""

    def __init__(self, system, n, harmonics):
        self.zeta, self.gamma, self.f = (system[key] for key in ("zeta", "gamma", "f"))
        self.n, self.orders = n, np.arange(1, 2 * harmonics, 2)
        grid = 2 * np.pi * np.arange(8 * harmonics) / (8 * harmonics)
        angles = np.outer(grid, self.orders)
        self.basis = np.hstack([np.cos(angles), np.sin(angles)])
        self.project = self.basis.T * 2 / len(grid)
        self.force = np.zeros(2 * harmonics)
        self.force[list(self.orders).index(n)] = self.f

    def linear(self, omega, order=0):
        """The matrix of the linear part, or its derivative by omega of an order."""
        rate = self.orders / self.n
        square = {0: 1 - (rate * omega) ** 2, 1: -2 * rate**2 * omega, 2: -2 * rate**2}[order]
        drag = {0: 2 * self.zeta * rate * omega, 1: 2 * self.zeta * rate, 2: 0 * rate}[order]
        return np.block([[np.diag(square), np.diag(drag)], [-np.diag(drag), np.diag(square)]])

    def residual(self, c, omega):
        return self.linear(omega) @ c + self.gamma * self.project @ (self.basis @ c) ** 3 - self.force

    def jacobian(self, c, omega):
        return self.linear(omega) + 3 * self.gamma * (self.project * (self.basis @ c) ** 2) @ self.basis

    def corrected(self, c, omega, normal):
        """The solution nearest to (c, omega) in the plane across `normal`."""
        x, start = np.append(c, omega), np.append(c, omega)
        for _ in range(30):
            matrix = np.vstack([self.extended(x), normal])
            change = np.linalg.solve(matrix, -np.append(self.residual(x[:-1], x[-1]), normal @ (x - start)))
            x = x + change
            if np.linalg.norm(change) < 1e-12 * np.linalg.norm(x):
                return x
        raise RuntimeError("no solution")

    def extended(self, x):
        return np.column_stack([self.jacobian(x[:-1], x[-1]), self.linear(x[-1], 1) @ x[:-1]])

    def tangent(self, x, before):
        direction = np.linalg.solve(np.vstack([self.extended(x), before]), np.append(0 * x[:-1], 1))
        return direction / np.linalg.norm(direction)

    def folds(self, seed, step):
        """The folds along the branch from a solution towards lower frequencies, until it leaves the range or comes back."""
        down = np.append(0 * seed[:-1], -1.0)
        start = x = seed
        direction, found, away = self.tangent(x, down), [], 0.0
        for _ in range(100_000):
            guess = x + step * direction
            x = self.corrected(guess[:-1], guess[-1], direction)
            turned = self.tangent(x, direction)
            if turned[-1] * direction[-1] < 0:
                found.append(self.fold(x[:-1], x[-1]))
            direction = turned
            distance = np.linalg.norm(x - start)
            away = max(away, distance)
            if not RANGE[0] < x[-1] < RANGE[1]:
                return found, False
            if away > 4 * step and distance < step:
                return found, True
        raise RuntimeError("a branch without end")

    def fold(self, c, omega):
        v = np.linalg.svd(self.jacobian(c, omega))[2][-1]
        size = len(c)
        for _ in range(50):
            own, by_omega = self.jacobian(c, omega), self.linear(omega, 1)
            bend = 6 * self.gamma * (self.project * ((self.basis @ c) * (self.basis @ v))) @ self.basis
            matrix = np.zeros((2 * size + 1, 2 * size + 1))
            matrix[:size, :size], matrix[:size, -1] = own, by_omega @ c
            matrix[size:-1, :size], matrix[size:-1, size:-1], matrix[size:-1, -1] = bend, own, by_omega @ v
            matrix[-1, size:-1] = 2 * v
            right = np.concatenate([self.residual(c, omega), own @ v, [v @ v - 1]])
            change = np.linalg.solve(matrix, -right)
            c, v, omega = c + change[:size], v + change[size:-1], float(omega + change[-1])
            if np.linalg.norm(change) < 1e-13 * np.linalg.norm(c):
                break
        return self.named(np.append(c, omega))

    def named(self, x):
        """A solution by its state at a crest of the force."""
        cosines, sines = np.split(x[:-1], 2)
        speed = (self.orders / self.n * x[-1] * sines).sum()
        return {"omega": float(x[-1]), "x": float(cosines.sum()), "v": float(speed)}


def textbook(system):
    """The folds of the frequency response of one harmonic: where omega has an extremum as the amplitude changes."""
    zeta, gamma, f = (system[key] for key in ("zeta", "gamma", "f"))
    # With w = omega^2 and s = 3/4 gamma a^2: (w - 1 - s)^2 + 4 zeta^2 w = f^2/a^2; its derivative by a at constant w is zero.
    found = []
    for sign in (-1, 1):
        def w(a):
            middle = 1 + 0.75 * gamma * a**2 - 2 * zeta**2
            return middle + sign * np.sqrt(middle**2 - (1 + 0.75 * gamma * a**2) ** 2 + (f / a) ** 2)

        a = np.linspace(0.05, 30, 2_000_001)
        with np.errstate(invalid="ignore"):
            values = w(a)
        inner = (values[1:-1] - values[:-2]) * (values[2:] - values[1:-1]) < 0
        for place in np.flatnonzero(inner):
            low, high = a[place], a[place + 2]
            turn = 1 if values[place + 1] > values[place] else -1
            for _ in range(200):
                p, q = low + (high - low) / 3, high - (high - low) / 3
                low, high = (low, q) if turn * w(p) > turn * w(q) else (p, high)
            found.append(float(np.sqrt(w((low + high) / 2))))
    return sorted(found)


def seed(balance, omega, size):
    """A solution with a first harmonic of about this size."""
    normal = np.append(np.zeros(len(balance.force)), 1.0)
    for phase in np.linspace(0, 2 * np.pi, 48, endpoint=False):
        c = np.linalg.solve(balance.linear(omega), balance.force)
        c[0] += size * np.cos(phase)
        c[len(balance.orders)] += size * np.sin(phase)
        try:
            x = balance.corrected(c, omega, normal)
        except (RuntimeError, np.linalg.LinAlgError):
            continue
        if np.hypot(x[0], x[len(balance.orders)]) > 0.5 * size:
            return x
    raise RuntimeError("no motion of this kind")


def folds(n, omega, size, harmonics):
    balance = Balance(SYSTEM, n, harmonics)
    start = seed(balance, omega, size)
    found, closed = balance.folds(start, 0.04)
    return sorted(found, key=lambda fold: fold["omega"]), closed, balance.named(start)


def run():
    answer = {"system": SYSTEM}
    for name, n, omega, size in MOTIONS:
        coarse, *_ = folds(n, omega, size, 16)
        fine, closed, start = folds(n, omega, size, 32)
        moved = max(abs(a[key] - b[key]) for a, b in zip(coarse, fine, strict=True) for key in a)
        if moved > 1e-9:
            raise RuntimeError(f"{name}: a fold moves by {moved} with twice the harmonics")
        answer[name] = {"periods": n, "closed": closed, "motion": start, "folds": fine, "moved_by_twice_the_harmonics": moved}
    ours = [fold["omega"] for fold in folds(1, *MOTIONS[0][2:], 1)[0]]
    known = textbook(SYSTEM)
    if not np.allclose(ours, known, rtol=1e-7):
        raise RuntimeError(f"one harmonic: {ours}, but the textbook's response has folds at {known}")
    answer["main"]["one_harmonic"] = known
    answer["provenance"] = f"tests/reference/duffing.py, Python {platform.python_version()}, numpy {np.__version__}"
    return answer


if __name__ == "__main__":
    text = json.dumps(run(), indent=2)
    pathlib.Path(__file__).with_suffix(".json").write_text(text + "\n")
    print(text)
