"""The proven bands in results/proof: their pieces and what they leave out cover them without a hole, and README.md says what they say.

python3 tests/proof.py [--write]
"""

import json
import math
import pathlib
import sys

PLACE = pathlib.Path(__file__).parent.parent / "results" / "proof"
README = PLACE / "README.md"
HEAD = """# Proven bands

`just proof` made these files: [a proof by interval arithmetic](../../docs/proof.md) that at every frequency of a band, but for what is named, there is a stable
periodic motion with at most so much energy. The JSON files have the pieces with bounds on E1max, stroke and contact force over each, and why the rest is left out.
[orbits.md](orbits.md) has single motions. `python3 tests/proof.py` checks that pieces and gaps cover the band without a hole, and that this page says what they say.

| file | omega, rad/s | pieces | E1max is at most, J | impacts | not proven, rad/s |
| --- | --- | --- | --- | --- | --- |
"""


def runs(pieces):
    """The sequences of impacts in turn, each once for all pieces that follow one another."""
    names = [piece["impacts"] or "none" for piece in pieces]
    return [name for k, name in enumerate(names) if k == 0 or names[k - 1] != name]


def cover(name, proof):
    """Faults of a cover."""
    parts = sorted(part["omega"] for part in proof["pieces"] + proof["left_out"])
    ends = [proof["omega"][0]] + [part[1] for part in parts]
    starts = [part[0] for part in parts] + [proof["omega"][1]]
    faults = [f"{name}: a hole or an overlap at {b} rad/s" for a, b in zip(ends, starts) if a != b]
    most = max(piece["largest"]["E1max"][1] for piece in proof["pieces"])
    if most != proof["E1max"][1]:
        faults.append(f"{name}: E1max {proof['E1max']}, but a piece has {most}")
    if not all(piece["multipliers"] <= 1 for piece in proof["pieces"]):
        faults.append(f"{name}: a piece is not stable")
    return faults


def row(name, proof):
    left = [f"{a:.6g} to {b:.6g}" for a, b in (part["omega"] for part in proof["left_out"])]
    share = sum(b - a for a, b in (part["omega"] for part in proof["left_out"]))
    impacts = runs(proof["pieces"])
    shown = ", ".join(impacts) if len(impacts) < 8 else f"{', '.join(impacts[:3])}, … ({len(impacts)} in turn)"
    some = "; ".join(left) if len(left) < 9 else f"{len(left)} parts from {left[0].split()[0]} to {left[-1].split()[-1]}"
    rest = f"{some} ({share:.4f} in all)" if left else "none"
    a, b = proof["omega"]
    # What it is at most may not be rounded down.
    most = math.ceil(proof["E1max"][1] * 1e5) / 1e5
    return f"| [{name}]({name}) | {a:g} to {b:g} | {len(proof['pieces'])} | {most:.5f} | {shown} | {rest} |\n"


def main():
    proofs = {file.name: json.loads(file.read_text()) for file in sorted(PLACE.glob("*.json"))}
    faults = [fault for name, proof in proofs.items() for fault in cover(name, proof)]
    text = HEAD + "".join(row(name, proof) for name, proof in proofs.items())
    if "--write" in sys.argv:
        README.write_text(text)
    elif README.read_text() != text:
        faults.append(f"{README}: not what the proofs say")
    print(*faults, f"{len(proofs)} proven bands, {len(faults)} faults", sep="\n")
    sys.exit(bool(faults))


main()
