"""Results of operations on random doubles by MPFR (gmpy2), rounded down and up: an interval holds the exact one if it holds both.

    pip install gmpy2 && python3 tests/reference/enclosures.py 1000 > tests/reference/enclosures.csv
"""

import random
import sys

import gmpy2

DOWN = gmpy2.context(precision=53, round=gmpy2.RoundDown)
UP = gmpy2.context(precision=53, round=gmpy2.RoundUp)
OPERATIONS = {
    "add": lambda to, x, y: to.add(x, y),
    "sub": lambda to, x, y: to.sub(x, y),
    "mul": lambda to, x, y: to.mul(x, y),
    "div": lambda to, x, y: to.div(x, y),
    "sqrt": lambda to, x, y: to.sqrt(abs(x)),
    "square": lambda to, x, y: to.mul(x, x),
    "cos": lambda to, x, y: to.cos(x),
    "sin": lambda to, x, y: to.sin(x),
}


def number(draw, name):
    """A double of either sign over 80 binary orders; of an angle, some next to quarter turns."""
    sign = draw.choice([-1, 1])
    if name in ("cos", "sin"):
        near = round(draw.uniform(0, 60)) * 0.7853981633974483
        return sign * draw.choice([near + draw.uniform(-1, 1) * 10 ** draw.uniform(-16, 0), 10 ** draw.uniform(-9, 3)])
    return sign * draw.uniform(1, 2) * 2.0 ** draw.randint(-40, 40)


def main():
    draw = random.Random(41)
    for _ in range(int(sys.argv[1])):
        name = draw.choice(list(OPERATIONS))
        x, y = number(draw, name), number(draw, name)
        # A sum of like sizes cancels, and of a short product nothing is rounded.
        if draw.random() < 0.2:
            y = -x * (1 + 2.0 ** draw.randint(-52, -1))
        down, up = (float(OPERATIONS[name](to, gmpy2.mpfr(x), gmpy2.mpfr(y))) for to in (DOWN, UP))
        print(f"{name},{x!r},{y!r},{down!r},{up!r}")


if __name__ == "__main__":
    main()
