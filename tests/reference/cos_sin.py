"""Cosine and sine of doubles to 60 digits by mpmath, each as the sum of two doubles, for the intervals of crates/proof.

    python3 tests/reference/cos_sin.py > tests/reference/cos_sin.json
"""

import json
import random

import mpmath

mpmath.mp.dps = 60


def pair(value):
    """The nearest double, and the double nearest to what is left."""
    first = float(value)
    return [first, float(value - mpmath.mpf(first))]


def main():
    draw = random.Random(41)
    points = [draw.uniform(-1, 1) * 10 ** draw.uniform(-6, 3) for _ in range(400)]
    # Near the quarter turns, where the reduction loses digits.
    points += [float(k * mpmath.pi / 4) + draw.uniform(-1, 1) * 1e-9 for k in range(-30, 31)]
    rows = [[x, *pair(mpmath.cos(mpmath.mpf(x))), *pair(mpmath.sin(mpmath.mpf(x)))] for x in points]
    print("[" + ",\n".join(json.dumps(row) for row in rows) + "]")


if __name__ == "__main__":
    main()
