"""Which file imports which, checked: no circles of files, arrows between crates one way, sizes.

    python3 tests/imports.py            from the root of the repository; fails with every fault named

A *circle* is a set of files of one crate each of which imports, directly or through others, something of every other. A *room* is a file
beside `lib.rs` with the folder of its name; rooms make no circles either. `tests/modules.py` defines what an import is.
"""

import re
import sys
from pathlib import Path

import modules

ROOT = Path(__file__).resolve().parent.parent

# What each crate may depend on.
BELOW = {
    "model": "",
    "solver": "model",
    "dynamics": "model solver",
    "optim": "model solver dynamics",
    "proof": "model",
    "store": "",
    "report": "",
    "study": "model solver optim dynamics",
    "jobs": "model solver optim dynamics proof study store report",
    "explore": "model solver optim dynamics study report jobs",
    "retune": "model solver optim dynamics study store report jobs explore",
    "testkit": "model solver dynamics optim jobs",
    "python": "model solver optim dynamics study store jobs retune",
    "lab": "model solver optim dynamics study store report jobs testkit",
}

MOST_LINES = 400
MOST_SHARE = 0.25

# Known exceptions, each with the size that it may have and the reason. One that is no longer needed is named, and goes.
LONG_FILES = {}
LARGE_CRATES = {"jobs": (0.36, "twelve jobs, which share no more than the modules beside them")}

# Crates that are to be read whole by whoever is to believe them: lines without blanks, comments and tests, whose modules end their files.
MOST_CODE = {"proof": 2000}


def code(file):
    """The lines of a file without blanks, comments and tests."""
    text = re.split(r"(?m)^#\[cfg\(test\)\]\n(?:pub\(crate\) )?mod tests \{", file.read_text(encoding="utf-8"))[0]
    return sum(bool(line.strip()) and not line.strip().startswith("//") for line in text.splitlines())


def circles(edges):
    """The sets of files that all reach one another, each with a shortest circle."""

    def reached(file):
        found, ways = set(), [file]
        while ways:
            for other in edges.get(ways.pop(), set()) - found:
                found.add(other)
                ways.append(other)
        return found

    reach = {file: reached(file) for file in edges}
    parts = {frozenset(b for b in reach[a] if a in reach.get(b, ())) for a in edges if a in reach[a]}
    return [(part, shortest(edges, part)) for part in sorted(parts, key=min)]


def shortest(edges, part):
    """A shortest circle within a set of files."""
    best = None
    for start in sorted(part):
        ways, reached = [[start]], {start}
        while ways:
            way = ways.pop(0)
            for other in sorted(edges.get(way[-1], set()) & part):
                if other == start and (best is None or len(way) < len(best)):
                    best = way
                if other not in reached:
                    reached.add(other)
                    ways.append([*way, other])
    return [*best, best[0]]


def rooms(crate, edges):
    """Which rooms of a crate import which. Its `lib.rs` or `main.rs` is none: it names them all."""

    def room(file):
        first = file.relative_to(crate / "src").parts[0].removesuffix(".rs")
        return None if first in ("lib", "main", "bin") else first

    found = {}
    for file, others in edges.items():
        found.setdefault(room(file), set()).update(room(other) for other in others)
    return {own: others - {own, None} for own, others in found.items() if own}


def dependencies(manifest):
    """The dependencies of a crate, those of single targets included, those of tests and build scripts not."""
    names, section = set(), ""
    for line in manifest.read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            section = line.strip().strip("[]")
            if match := re.fullmatch(r"(?:target\..*\.)?dependencies\.([\w-]+)", section):
                names.add(match.group(1))
        elif re.fullmatch(r"(?:target\..*\.)?dependencies", section):
            if match := re.match(r"([\w-]+)\s*[.=]", line):
                names.add(match.group(1))
    return names


def main():
    faults, rows = [], []
    crates = sorted(path.parent for path in ROOT.glob("crates/*/Cargo.toml"))
    packages = {re.search(r'(?m)^name\s*=\s*"([^"]+)"', (c / "Cargo.toml").read_text()).group(1): c.name for c in crates}
    for crate in crates:
        sources = sorted((crate / "src").rglob("*.rs"))
        lines = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in sources}
        edges = modules.imports(crate)
        found = circles(edges)
        for part, circle in found:
            part, circle = ([str(file.relative_to(crate / "src")) for file in files] for files in (sorted(part), circle))
            faults.append(f"{crate.name}: a circle of {len(part)} files ({', '.join(part)}): {' → '.join(circle)}")
        for part, circle in circles(rooms(crate, edges)):
            faults.append(f"{crate.name}: a circle of {len(part)} rooms ({', '.join(sorted(part))}): {' → '.join(circle)}")
        used = {packages[name] for name in dependencies(crate / "Cargo.toml") if name in packages}
        if crate.name not in BELOW:
            faults.append(f"{crate.name}: a crate that tests/imports.py does not know: say in BELOW what it may depend on")
        else:
            for other in sorted(used - set(BELOW[crate.name].split())):
                faults.append(f"{crate.name} depends on {other}: this arrow points the wrong way")
        for file, count in lines.items():
            name = file.relative_to(ROOT).as_posix()
            most, _ = LONG_FILES.get(name, (MOST_LINES, ""))
            if count > most:
                faults.append(f"{name}: {count} lines, and {most} are allowed")
        if crate.name in MOST_CODE and (own := sum(map(code, sources))) > MOST_CODE[crate.name]:
            faults.append(f"{crate.name}: {own} lines of code, and {MOST_CODE[crate.name]} are allowed")
        rows.append((crate.name, len(sources), sum(lines.values()), max(lines.values(), default=0), len(found), used))
    total = sum(row[2] for row in rows)
    print(f"{'crate':<11}{'files':>6}{'lines':>8}{'share':>8}{'longest':>9}{'circles':>9}  depends on")
    for name, files, count, longest, rounds, used in rows:
        share = count / total
        print(f"{name:<11}{files:>6}{count:>8}{share:>8.1%}{longest:>9}{rounds:>9}  {' '.join(sorted(used)) or '-'}")
        most, _ = LARGE_CRATES.get(name, (MOST_SHARE, ""))
        if share > most:
            faults.append(f"{name}: {share:.1%} of all lines, and {most:.0%} are allowed")
        if name in LARGE_CRATES and share <= MOST_SHARE:
            print(f"  {name} needs no exception any more")
    for name, (_, reason) in LONG_FILES.items():
        if not (ROOT / name).is_file() or len((ROOT / name).read_text().splitlines()) <= MOST_LINES:
            print(f"  {name} needs no exception any more ({reason})")
    for fault in faults:
        print(f"fault: {fault}")
    print(f"{total} lines in {len(rows)} crates, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
