"""Counts what kinds of instructions a run is made of, and what lanes over runs could save at most: results/speed/lanes.txt.

    python3 tests/lanes.py          from the root of the repository (needs valgrind and objdump)

Vectors of four doubles are full already, whatever is beside what in them. If as many runs went side by side in perfect step as a vector has
doubles, arithmetic of one or two doubles, all that steers a run and calls of libraries would be done once for all of them, and the full vectors
as often as now. No lane ever waits in this bound, so it is one that cannot be reached.
"""

import collections
import json
import os
import re
import subprocess
import sys
import tempfile

# The bench that counts instructions, for a processor that valgrind knows.
BUILD = "cargo bench --target-dir target/instructions --quiet --package retune-lab --bench instructions --no-run --message-format json"
SCENES = ["SSVI, Table 2", "SSVI, Table 1 row 3"]
# By their place among those of the benchmark.
RTOLS = {"1e-6": 0, "1e-9": 3, "1e-10": 4}
# Counts of runs whose difference is that of the runs alone.
FEW, MANY = 2, 12
KINDS = ["four doubles", "moves of four", "two doubles", "one double", "moves of one or two", "integers, branches", "libraries"]
ARITHMETIC = re.compile(r"v?(f?n?m?(add|sub|mul|div)\w*|sqrt|max|min|cmp\w*|and|andn|or|xor|round|u?comi|cvt\w*)(pd|sd|si)$")


def program():
    """The bench as it is built."""
    environment = {**os.environ, "RUSTFLAGS": "-C target-cpu=x86-64-v3"}
    built = subprocess.run(BUILD.split(), env=environment, text=True, stdout=subprocess.PIPE, check=True).stdout
    messages = map(json.loads, built.splitlines())
    return next(m["executable"] for m in messages if m.get("executable") and m["target"]["name"] == "instructions")


def kind(name, operands):
    """What kind an instruction is."""
    wide = "ymm" in operands
    if found := ARITHMETIC.match(name):
        packed = found.group(3) == "pd"
        return "four doubles" if packed and wide else "two doubles" if packed else "one double"
    if wide or "xmm" in operands or name == "vzeroupper":
        return "moves of four" if wide else "moves of one or two"
    return "integers, branches"


def counted(file):
    """How often each instruction of the bench is carried out; at -1 those of libraries."""
    counts, own, called = collections.Counter(), False, False
    for line in open(file):
        if line.startswith("ob="):
            own = "instructions-" in line
        elif line.startswith("calls="):
            called = True
        elif line.startswith("0x"):
            address, _, count = line.split()[:3]
            if not called:
                counts[int(address, 16) if own else -1] += int(count)
            called = False
    return counts


def kinds(bench, instructions, scene, rtol):
    """Instructions of a run by their kind."""
    counts = []
    for runs in (FEW, MANY):
        with tempfile.NamedTemporaryFile() as file:
            subprocess.run(
                ["valgrind", "--tool=callgrind", "--dump-instr=yes", "--compress-strings=no", "--compress-pos=no",
                 f"--callgrind-out-file={file.name}", bench, "--runs", str(scene), str(rtol), str(runs)],
                check=True, capture_output=True)
            counts.append(counted(file.name))
    few, many = counts
    found = collections.Counter()
    for address, count in many.items():
        found["libraries" if address < 0 else kind(*instructions[address])] += (count - few[address]) / (MANY - FEW)
    return found


def bound(shares, lanes):
    """How many times less instructions `lanes` runs in perfect step would take."""
    full = (shares["four doubles"] + shares["moves of four"]) * 4 / lanes
    double = shares["two doubles"] * 2 / lanes
    single = sum(shares[kind] for kind in KINDS[3:]) / lanes
    return 1 / (full + double + single)


def main():
    bench = program()
    listed = subprocess.run(["objdump", "-d", "--no-show-raw-insn", bench], text=True, capture_output=True, check=True).stdout
    lines = re.findall(r"(?m)^\s*([0-9a-f]+):\s+(\S+)[ \t]*(.*)$", listed)
    instructions = {int(address, 16): (name, operands) for address, name, operands in lines}
    print("`just lab count-lanes`: instructions of a run of 100 s by their kind; what lanes over runs could save at most\n")
    print(f"{'scene':<22}{'rtol':>6}{'instructions':>14}" + "".join(f"{kind:>21}" for kind in KINDS) + f"{'4 lanes':>9}{'8 lanes':>9}")
    for scene, name in enumerate(SCENES):
        for rtol, number in RTOLS.items():
            found = kinds(bench, instructions, scene, number)
            total = sum(found.values())
            shares = collections.Counter({kind: count / total for kind, count in found.items()})
            cells = "".join(f"{100 * shares[kind]:>19.1f} %" for kind in KINDS)
            print(f"{name:<22}{rtol:>6}{total:>14.0f}{cells}{bound(shares, 4):>9.2f}{bound(shares, 8):>9.2f}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
