"""Stable motions of results/branches, proven: is the solver's E1max in the proven interval, and those of the hybrid and of DOP853 from there?

python3 tests/orbits.py target/release/retune NUMBER results/proof/orbits.md
"""

import csv
import decimal
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).parent.parent
STUDIES = {"tuned": "results/ssvi", "isola": "studies/ssvi-isola.json", "global": "results/ssvi-global"}
LONGEST = 4
METHODS = ["hybrid", "dop853"]
HEAD = """# Proven motions beside computed ones

`just lab proven-orbits {number}` made this page: {number} stable motions of at most 4 periods of [branches](../branches), evenly among all such of the
designs `tuned`, `isola` and `global`, each [proven](../../docs/proof.md), and what other numbers of E1max are off the proven interval: that of the branch,
and the largest over the window of a run from there with the default tolerances, by the default method (hybrid) and by DOP853. A value in the interval is off by 0.

{summary}

| design | branch | place | omega, rad/s | periods | E1max, J | proven width, J | branch off by, J | hybrid, J | DOP853, J |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
"""


def rows(name):
    with open(ROOT / "results" / "branches" / name / "branches.csv") as file:
        stable = [row for row in csv.DictReader(file) if row["stable"] == "1" and int(row["periods"]) <= LONGEST]
    with open(ROOT / "results" / "branches" / name / "states.csv") as file:
        states = {(row["branch"], row["place"]): row for row in csv.DictReader(file) if row["segment"] == "0"}
    return [(name, row, states[row["branch"], row["place"]]) for row in stable]


def ask(retune, *arguments):
    done = subprocess.run([retune, *arguments, "--json", "--threads", "1"], capture_output=True, text=True, cwd=ROOT)
    return (json.loads(done.stdout), "") if done.returncode == 0 else (None, done.stderr.strip().splitlines()[0])


def most(x):
    """Two digits of what it is at most, so rounded up."""
    up = decimal.Context(prec=2, rounding=decimal.ROUND_UP)
    return f"{float(up.create_decimal(x)):.1e}" if x else "0"


def off(value, interval):
    return max(0.0, interval[0] - value, value - interval[1])


def examine(retune, name, row, state):
    start = "--from=" + ",".join(state[key] for key in ["x1", "v1", "x2", "v2"])
    study, omega = STUDIES[name], row["omega"]
    proof, why = ask(retune, "prove", study, "--omega", omega, start, "--periods", row["periods"])
    if proof is None:
        return why.split("not proven: ")[-1].split(";")[0]
    known = proof["largest"]["E1max"]
    runs = [ask(retune, "simulate", study, "--set", f"omega={omega}", start, "--solver", m)[0] for m in METHODS]
    values = [float(row["E1max"])] + [run["E1max"] for run in runs]
    return proof["stability"], known, [off(value, known) for value in values]


def main():
    retune, number, target = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    every = [row for name in STUDIES for row in rows(name)]
    chosen = [every[k * len(every) // number] for k in range(number)]
    lines, refused, offs, widths, unstable = [], {}, [], [], 0
    for name, row, state in chosen:
        found = examine(str(pathlib.Path(retune).resolve()), name, row, state)
        place = f"| {name} | {row['branch']} | {row['place']} | {row['omega']} | {row['periods']} |"
        if isinstance(found, str):
            refused[found] = refused.get(found, 0) + 1
            lines.append(f"{place} not proven: {found} | | | | |")
            continue
        stability, known, own = found
        unstable += "stable" not in stability
        offs.append(own)
        widths.append(known[1] - known[0])
        numbers = " | ".join(most(x) for x in [widths[-1], *own])
        lines.append(f"{place} {known[1]:.9f} | {numbers} |")
        print(lines[-1], flush=True)
    middle = sorted(widths)[len(widths) // 2]
    says = [f"- Proven to exist: {len(offs)} of {number}; {unstable} of these are not proven to be stable. The median of the widths of the interval is {middle:.1e} J."]
    for k, what in enumerate(["The value of the branch", "The hybrid's", "DOP853's"]):
        inside = sum(own[k] == 0 for own in offs)
        says.append(f"- {what} is in the interval of {inside}, elsewhere off by at most {most(max(own[k] for own in offs))} J.")
    says += [f"- {count} not proven: {why}." for why, count in refused.items()]
    page = HEAD.format(number=number, summary="\n".join(says)) + "\n".join(lines) + "\n"
    pathlib.Path(target).write_text(page)
    print(*says, sep="\n")


main()
