#!/usr/bin/env python3
"""Makes quake.csv: a synthetic earthquake by the Kanai-Tajimi model, the same at every run.

White noise shakes a layer of ground, a damped oscillator on rock; what its surface feels is the record (K. Kanai, Bull. Earthq. Res. Inst.
35 (1957), 309; H. Tajimi, Proc. 2nd World Conf. Earthq. Eng. (1960), 781). An envelope lets it rise, shake and fade (P. C. Jennings,
G. W. Housner and N. C. Tsai, Simulated earthquake motions, Caltech 1968). Only the standard library is used.
"""

import math
import random
from pathlib import Path

SEED = 1940
STEP, COUNT = 0.01, 4001  # s
OMEGA, ZETA = 15.6, 0.6  # of firm ground, rad/s
PEAK = 3.0  # m/s²


def envelope(t: float) -> float:
    """Rises for 3 s, stays up to 15 s, fades by a factor e each 4 s."""
    if t < 3.0:
        return (t / 3.0) ** 2
    return 1.0 if t < 15.0 else math.exp(-(t - 15.0) / 4.0)


def ground() -> list[float]:
    """What the surface of the layer feels, of a size of its own: -(2 ζ ω v + ω² x) of x'' + 2 ζ ω x' + ω² x = -w."""
    noise = random.Random(SEED)
    x, v, felt = 0.0, 0.0, []
    for _ in range(COUNT):
        w = noise.gauss(0.0, 1.0)
        felt.append(-(2.0 * ZETA * OMEGA * v + OMEGA * OMEGA * x))
        # The noise is constant over a step: some small steps of the semi-implicit Euler method.
        for _ in range(20):
            v += STEP / 20 * (-w - 2.0 * ZETA * OMEGA * v - OMEGA * OMEGA * x)
            x += STEP / 20 * v
    return felt


def main() -> None:
    shaped = [envelope(i * STEP) * a for i, a in enumerate(ground())]
    scale = PEAK / max(abs(a) for a in shaped)
    rows = (f"{i * STEP:.2f},{scale * a:.5f}" for i, a in enumerate(shaped))
    Path(__file__).with_suffix(".csv").write_text("\n".join(["t,a", *rows]) + "\n")


if __name__ == "__main__":
    main()
