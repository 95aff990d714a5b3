"""The proven bands in results/proof: their pieces and what they leave out cover them without a hole, and README.md says what they say.

python3 tests/proof.py [--write]
"""

import csv
import decimal
import json
import math
import pathlib
import sys

PLACE = pathlib.Path(__file__).parent.parent / "results" / "proof"
README = PLACE / "README.md"
# Motions of the tuned damper and their bifurcations, computed.
BRANCHES = PLACE.parent / "branches" / "tuned"
HEAD = """# Proven bands

`just lab proof` made these files: [a proof by interval arithmetic](../../docs/proof.md) that at every frequency of a band, but for what is named, there is a stable
periodic motion with at most so much energy. The JSON files have the pieces with bounds on E1max, stroke and contact force over each, and why the rest is left out.
[orbits.md](orbits.md) has single motions. `python3 tests/proof.py` checks that pieces and gaps cover the band without a hole, and that this page says what they say.

| file | omega, rad/s | pieces | E1max is at most, J | proven, share of the band | not proven, rad/s |
| --- | --- | --- | --- | --- | --- |
"""
# The files of the hedged damper, by the restitution of its contacts.
HEDGED = {"0.6": "", "0.7": "-0.7", "0.8": "-0.8", "0.9": "-0.9", "1": "-lossless"}
HOLES = "no band was proven over {}; what [`retune branches`](../branches/tuned/README.md) computes there is below"
SINGLE = """
## Single frequencies

Where no band was proven: what `retune prove` says of the motion that the run from rest settles on.

| file | omega, rad/s | periods | impacts | stable, all multipliers below | E1max is at most, J |
| --- | --- | --- | --- | --- | --- |
"""
INTERVALS = """
## Motions

What was proven from where to where, and what not: at each frequency of a row there is a stable motion that repeats after so many periods of the force and strikes
these walls in turn (S the structure, O the obstacle). Ends are rounded to the side on which less is proven; the JSON files have them in full. What is not proven is
next to a bifurcation, whose kind, multiplier and place are computed, not proven.

| file | omega, rad/s | periods | impacts | E1max is at most, J |
| --- | --- | --- | --- | --- |
"""


def intervals(proof):
    """What was proven from where to where: pieces of like motions, and gaps, in turn."""
    parts = [(part["omega"], part) for part in proof["pieces"] + proof["left_out"]]
    found = []
    for omega, part in sorted(parts, key=lambda part: part[0]):
        kind = (reasons(part),) if "why" in part else (part["periods"], part["impacts"] or "none")
        most = 0.0 if "why" in part else part["largest"]["E1max"][1]
        if found and found[-1][0] == kind:
            (_, ends, least) = found[-1]
            found[-1] = (kind, [ends[0], omega[1]], max(most, least))
        else:
            found.append((kind, omega, most))
    return found


def reasons(part):
    """Why nothing is proven where a gap begins, and where it ends."""
    return "; from above, ".join(part[end] for end in ("why", "from_above") if end in part)


def bifurcations():
    """At stable motions of the tuned damper: frequency, and what it is."""
    rows = read("bifurcations.csv")
    # All other multipliers are inside the unit circle, but for the one or two that reach it.
    size = lambda row: max(math.hypot(float(row[f"re{n}"]), float(row[f"im{n}"])) for n in range(1, 5))
    stable = [row for row in rows if row["kind"] != "grazing" and size(row) < 1 + 1e-6]
    return sorted((float(row["omega"]), f"{row['kind']} of the motion of {row['periods']} {plural(row['periods'])}") for row in stable)


def read(name):
    with (BRANCHES / name).open() as file:
        return list(csv.DictReader(file))


def hole(ends):
    """A row of what no file is about: the bifurcations in it, and between which of them no stable motion is known."""
    stable = [float(row["omega"]) for row in read("branches.csv") if row["stable"] == "1"]
    at = [omega for omega, _ in bifurcations() if ends[0] <= omega <= ends[1]]
    empty = [f"{a:.6f} to {b:.6f}" for a, b in zip(at, at[1:]) if not any(a < omega < b for omega in stable)]
    known = f"; no stable motion is known from {' and from '.join(empty)}" if empty else ""
    return f"| none | {gap(ends)} | - | no band was proven (computed: {computed(ends)}{known}) | - |\n"


def plural(periods):
    return "period" if str(periods) == "1" else "periods"


def computed(ends):
    """The bifurcations of the tuned damper in a gap."""
    return "; ".join(f"{words} at {omega:.6f}" for omega, words in bifurcations() if ends[0] <= omega <= ends[1])


def kind(name, proof, ends):
    """What bifurcation a gap is about: the computed one of the tuned damper in it; of other dampers, what the proven motions beside it say."""
    if "hedged" not in name:
        return computed(ends)
    beside = [piece["periods"] for side in (0, 1) for piece in proof["pieces"] if piece["omega"][1 - side] == ends[side]]
    return f"motions of {beside[0]} {plural(beside[0])} before it, of {beside[1]} beyond: a period doubling" if len(beside) == 2 and beside[1] == 2 * beside[0] else ""


def upwards(energy):
    """What it is at most may not be rounded down."""
    return f"{math.ceil(energy * 1e5) / 1e5:.5f}"


def rounded(ends, *sides):
    """Six decimals, each end rounded to its side."""
    a, b = (decimal.Decimal(repr(end)).quantize(decimal.Decimal("1e-6"), side).normalize() for end, side in zip(ends, sides))
    return f"{a} to {b}"


def gap(ends):
    """No less than is not proven."""
    return rounded(ends, decimal.ROUND_FLOOR, decimal.ROUND_CEILING)


def interval(name, proof, what, ends, most):
    if len(what) == 1:
        about = kind(name, proof, ends)
        return f"| {name} | {gap(ends)} | - | not proven: {what[0]}{' (' + about + ')' if about else ''} | - |\n"
    proven = rounded(ends, decimal.ROUND_CEILING, decimal.ROUND_FLOOR)
    return f"| {name} | {proven} | {what[0]} | {what[1]} | {upwards(most)} |\n"


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
    unnamed = [part["omega"] for part in proof["left_out"] if not kind(name, proof, part["omega"])]
    faults += [f"{name}: no bifurcation is known from {a} to {b} rad/s" for a, b in unnamed]
    return faults


def row(name, proof):
    left = [part["omega"] for part in proof["left_out"]]
    shown = "; ".join(map(gap, left)) if len(left) < 9 else f"{len(left)} parts from {gap([left[0][0], left[-1][1]])}"
    a, b = proof["omega"]
    share = 1 - sum(b - a for a, b in left) / (b - a)
    # No more than is proven.
    proven = f"{math.floor(share * 1e6) / 1e4:.4f} %" if left else "100 %"
    return f"| [{name}]({name}) | {a:g} to {b:g} | {len(proof['pieces'])} | {upwards(proof['E1max'][1])} | {proven} | {shown or 'none'} |\n"


def gaps(parts):
    return ", ".join(map(gap, parts))


def width(parts):
    """No less than it is."""
    return f"{math.ceil(sum(b - a for a, b in parts) * 1e6) / 1e6:.6f}"


def single(file):
    """A row of a motion at one frequency."""
    proof = json.loads(file.read_text())
    stable = proof["stability"].get("stable", "not proven")
    name = f"single/{file.name}"
    return f"| [{name}]({name}) | {proof['omega']:g} | {proof['periods']} | {proof['impacts']} | {stable} | {upwards(proof['largest']['E1max'][1])} |\n"


def bands(proofs):
    """Those of the tuned damper, and what lies between them."""
    own = sorted((proof for name, proof in proofs.items() if name.startswith("ssvi") and "hedged" not in name), key=lambda p: p["omega"])
    return own, [(a["omega"][1], b["omega"][0]) for a, b in zip(own, own[1:]) if a["omega"][1] < b["omega"][0]]


def tuned(proofs):
    """What the bands of the tuned damper say together, and what lies between them."""
    own, holes = bands(proofs)
    (a, b), most = (own[0]["omega"][0], own[-1]["omega"][1]), max(proof["E1max"][1] for proof in own)
    left, at = [], a
    for start, end in sorted(piece["omega"] for proof in own for piece in proof["pieces"]):
        left += [(at, start)] if start > at else []
        at = max(at, end)
    text = f"- The tuned damper: at each omega from {a:g} to {b:g} rad/s but for {len(left)} parts, {width(left)} rad/s in all ({gaps(left)}), a stable motion with an E1max of at most {upwards(most)} J"
    return text + (f"; {HOLES.format(gaps(holes))}.\n" if holes else ".\n")


def hedged(proofs):
    """What those of the hedged one say together."""
    own = {e: proofs[f"ssvi-hedged{end}.json"] for e, end in HEDGED.items() if f"ssvi-hedged{end}.json" in proofs}
    left = {e: [part["omega"] for part in proof["left_out"]] for e, proof in own.items()}
    (a, b), most = own["0.6"]["omega"], max(proof["E1max"][1] for proof in own.values())
    named = "; ".join(f"{gaps(parts)} at {e}" for e, parts in left.items() if parts)
    all_of = "each restitution" if len(own) == len(HEDGED) else "some restitutions"
    text = f"- The hedged damper: at {all_of} of its objective, {', '.join(own)}, and each omega from {a:g} to {b:g} rad/s, "
    text += f"but for {width(sum(left.values(), []))} rad/s in all ({named}), " if named else ""
    return text + f"a stable motion with an E1max of at most {upwards(most)} J.\n"


def main():
    proofs = {file.name: json.loads(file.read_text()) for file in sorted(PLACE.glob("*.json"))}
    faults = [fault for name, proof in proofs.items() for fault in cover(name, proof)]
    text = HEAD + "".join(row(name, proof) for name, proof in proofs.items())
    text += "\n## Together\n\n" + tuned(proofs) + hedged(proofs)
    text += INTERVALS + "".join(interval(name, proof, *part) for name, proof in proofs.items() for part in intervals(proof))
    text += "".join(map(hole, bands(proofs)[1]))
    text += SINGLE + "".join(single(file) for file in sorted((PLACE / "single").glob("*.json")))
    if "--write" in sys.argv:
        README.write_text(text)
    elif README.read_text() != text:
        faults.append(f"{README}: not what the proofs say")
    print(*faults, f"{len(proofs)} proven bands, {len(faults)} faults", sep="\n")
    sys.exit(bool(faults))


main()
