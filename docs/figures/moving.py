"""Draws one period of the tuned SSVI NES of results/ssvi at its worst frequency, as a picture that moves: docs/figures/moving.svg.

Usage: docs/figures/moving.py PATH_OF_RETUNE > docs/figures/moving.svg (`just lab moving`). Lengths are to scale, the block widths are not.
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

RESULTS = Path(__file__).resolve().parents[2] / "results" / "ssvi"
FRAMES = 60
SCALE = 330  # pixels a metre
FLASH = 0.05  # of a period: a contact is shown longer than it lasts
WALL, LEFT, TOP = 20, 150, 40  # left ends of the spring of the structure and of the structure at rest, px
SIDE, MASS, BOTTOM = 46, 70, 190  # widths of the sides of the structure and of the damper

SPRING = "M0 0h8l5 -9l10 18l10 -18l10 18l10 -18l10 18l5 -9h8"  # 76 px long
LENGTH = 76


def motion(program, omega):
    """Time, x1 and x2 over one period, and when the damper touches the structure, all times as shares of the period."""
    period = 2 * math.pi / omega
    with tempfile.NamedTemporaryFile(suffix=".csv") as file:
        subprocess.run([program, "simulate", RESULTS, "--set", f"omega={omega!r}", "--trajectory", file.name, "--interval",
                        repr(period / FRAMES)], check=True, stdout=subprocess.DEVNULL)
        rows = list(csv.DictReader(open(file.name)))
    begin = float(rows[0]["t"])
    grid = [(float(r["x1"]), float(r["x2"])) for r in rows if r["moment"] == "grid"][:FRAMES + 1]
    touched = [(float(r["t"]) - begin) / period for r in rows if r["moment"] == "touch-down"]
    return period, grid, [share for share in touched if share < 1]


def keyframes(name, frames):
    """A CSS animation through values at even times."""
    steps = "".join(f"{100 * i / FRAMES:.4g}%{{transform:{frame}}}" for i, frame in enumerate(frames))
    return f"@keyframes {name}{{{steps}}}"


def main():
    optimum = json.loads((RESULTS / "optimum.json").read_text())
    period, grid, touched = motion(sys.argv[1], optimum["objective"]["worst_omega"])
    cavity = SCALE * (optimum["D"] + optimum["C"]) + MASS
    x1 = [SCALE * a for a, _ in grid]
    gap = [SCALE * (b - a) for a, b in grid]
    width = 2 * SIDE + cavity
    right = LEFT + width + 60
    (flash,) = touched
    styles = [
        keyframes("structure", [f"translateX({a:.1f}px)" for a in x1]),
        keyframes("damper", [f"translateX({a:.1f}px)" for a in gap]),
        keyframes("outer", [f"scaleX({(LEFT - WALL + a) / LENGTH:.3f})" for a in x1]),
        keyframes("inner", [f"scaleX({max(a, 1) / LENGTH:.3f})" for a in gap]),
        f"@keyframes touch{{0%,{100 * flash:.4g}%{{opacity:0}}{100 * flash + 0.01:.4g}%{{opacity:1}}{100 * (flash + FLASH):.4g}%,100%{{opacity:0}}}}",
        *(f".{name}{{animation:{name} {2 * period:.4g}s linear infinite}}" for name in ("structure", "damper", "outer", "inner", "touch")),
        "@media (prefers-reduced-motion:reduce){*{animation-play-state:paused!important}}",
        "@media (prefers-color-scheme:dark){.ink{stroke:#e8eaee}.word{fill:#e8eaee}.block{fill:#32506f}.mass{fill:#8a6a3a}}",
    ]
    middle = (TOP + BOTTOM) / 2
    print(f"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {right:.0f} 225" width="{right:.0f}" height="225" font-family="Helvetica, Arial, sans-serif" font-size="15" role="img" aria-labelledby="t d">
<title id="t">One period of the tuned damper, at half the speed</title>
<desc id="d">A structure on a spring moves to and fro; in its cavity a mass on a softer spring, which strikes the left wall once a period.</desc>
<style>.ink{{stroke:#222;stroke-width:2;vector-effect:non-scaling-stroke}}.word{{fill:#222}}.block{{fill:#c9d6e6}}.mass{{fill:#f3d9b1}}.outer,.inner{{fill:none}}.touch{{fill:#c4122f;opacity:0}}
{chr(10).join(styles)}</style>
<path class="ink" fill="none" d="M{WALL} {TOP}V{BOTTOM + 8}H{right:.0f}"/>
<g transform="translate({WALL} {middle})"><path class="ink outer" d="{SPRING}"/></g>
<g class="structure"><path class="ink block" fill-rule="evenodd" d="M{LEFT} {TOP}h{width:.0f}v{BOTTOM - TOP}h-{width:.0f}zM{LEFT + SIDE} {TOP + 30}v{BOTTOM - TOP - 60}h{cavity:.0f}v-{BOTTOM - TOP - 60}z"/>
<text class="word" x="{LEFT + SIDE / 2}" y="{middle + 5}" text-anchor="middle">m₁</text>
<g transform="translate({LEFT + SIDE} {middle})"><path class="ink inner" d="{SPRING}"/></g>
<rect class="touch" x="{LEFT + SIDE - 6}" y="{TOP + 32}" width="7" height="{BOTTOM - TOP - 64}"/>
<g class="damper"><rect class="ink mass" x="{LEFT + SIDE}" y="{TOP + 38}" width="{MASS}" height="{BOTTOM - TOP - 76}" rx="12"/>
<text class="word" x="{LEFT + SIDE + MASS / 2}" y="{middle + 5}" text-anchor="middle">m₂</text></g></g>
<text class="word" x="{WALL}" y="218">the tuned damper at its worst frequency, {optimum["objective"]["worst_omega"] / 2 / math.pi:.3f} Hz, at half the speed; red: it strikes</text>
</svg>""")


if __name__ == "__main__":
    main()
