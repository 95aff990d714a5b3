"""Whether the tests see a mistake: mutants drawn at random, each against the tests of its own crate. `just lab mutants`.

cargo-mutants makes the mutants; which of them are drawn follows from the seed and from what they change, not from the lines that they
stand on, so that a draw stays nearly the same when code moves. Those of each crate are built in a copy of the project inside
`target/mutants`. What became of a mutant is remembered in `results/robustness/mutants` until its file changes: a pass that was stopped goes
on, on any machine, and passes over different crates (`--package`) may run at once. A survivor whose name stands in `tests/mutants.json`
changes nothing, for the reason given there.
"""

import argparse, collections, fnmatch, functools, hashlib, json, os, pathlib, shutil, subprocess, sys

DRAWN = 345
# As many are tried before what became of them is written down.
AT_ONCE = 10
# Files of each crate, and its tests: quick and decisive ones first, what they miss to the next; after an @ those of another crate, after
# two dashes words for the test programs themselves.
CRATES = {
    "retune-model": (["crates/model/src/*"], ["--tests", "@retune-solver --lib --test solver", "@retune-dynamics --tests", "@retune-jobs --lib"]),
    "retune-solver": (["crates/solver/src/*"], [
        "--test solver -- extremes:: reference:: work::",
        "--lib --test allocation --test solver -- --skip any_scene:: --skip edge:: --skip hunt::",
        "--test solver -- any_scene:: edge:: hunt::"]),
    "retune-optim": (["crates/optim/src/*"], ["--tests"]),
    "retune-store": (["crates/store/src/*"], ["--tests", "@retune-jobs --tests -- --include-ignored", "@retune --tests -- --include-ignored"]),
}
HOME = pathlib.Path("target/mutants")
REASONS = pathlib.Path("tests/mutants.json")
TABLE = pathlib.Path("results/robustness/mutants.md")
KNOWN = pathlib.Path("results/robustness/mutants")


@functools.cache
def made(package):
    """Every mutant of a crate."""
    said = subprocess.run(["cargo", "mutants", "--no-config", "--list", "--json", "--package", package], capture_output=True, check=True, text=True)
    return [mutant["name"] for mutant in json.loads(said.stdout)]


def listed(package):
    """The mutants of a crate that may be drawn, each with the name that it keeps when lines move."""
    files, counted = CRATES[package][0], collections.Counter()
    for mutant in made(package):
        file, _, _, change = mutant.split(":", 3)
        if any(fnmatch.fnmatch(file, pattern) for pattern in files):
            name = f"{file}:{change}"
            counted[name] += 1
            yield f"{name} #{counted[name]}", mutant, file


def drawn(seed, count):
    """`count` mutants, shared among the crates by their lines."""
    lists = {package: list(listed(package)) for package in CRATES}
    lines = {package: sum(len(pathlib.Path(file).read_text().splitlines()) for file in {m[2] for m in mutants}) for package, mutants in lists.items()}
    rank = lambda mutant: hashlib.sha256(f"{seed} {mutant[0]}".encode()).digest()
    share = lambda package: round(count * lines[package] / sum(lines.values()))
    return {package: sorted(mutants, key=rank)[: share(package)] for package, mutants in lists.items()}


def copy(tree):
    """Brings the copy of the project up to date; only what differs is written, so that cargo builds no more than that."""
    said = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], capture_output=True, check=True, text=True)
    files = {file for file in said.stdout.split("\0") if file and os.path.isfile(file)}
    for file in files:
        target = tree / file
        if not target.is_file() or target.read_bytes() != pathlib.Path(file).read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, target)
            shutil.copymode(file, target)
    for target in [path for path in tree.rglob("*") if path.is_file() and str(path.relative_to(tree)) not in files]:
        target.unlink()


def ended(package):
    """What became of each mutant of the latest run of cargo-mutants, which may have been stopped."""
    written = HOME / package / "mutants.out/outcomes.json"
    outcomes = json.loads(written.read_text())["outcomes"] if written.exists() else []
    return {o["scenario"]["Mutant"]["name"]: o["summary"].removesuffix("Mutant").lower() for o in outcomes if o["scenario"] != "Baseline"}


def tried(package, names, tests, timeout):
    """What becomes of these mutants of a crate with these of its tests, and the time in seconds that tests may take; without such a time
    they are run without a mutant first, and may take ten times as long afterwards."""
    home = HOME / package
    # Taken for caught are all others: cargo-mutants has no other choice that holds for every kind of mutant.
    shutil.rmtree(home / "mutants.out", ignore_errors=True)
    (home / "mutants.out").mkdir(parents=True)
    (home / "mutants.out/caught.txt").write_text("".join(f"{name}\n" for name in set(made(package)) - set(names)))
    limit = ["--timeout", str(timeout), "--baseline=skip"] if timeout else ["--timeout-multiplier", "10", "--minimum-test-timeout", "60"]
    other, tests = tests[1:].split(" ", 1) if tests.startswith("@") else (package, tests)
    tests, dashes, words = tests.partition(" -- ")
    choices = [f"--cargo-arg={choice}" for choice in tests.split()] + [f"--cargo-test-arg={word}" for word in (dashes + words).split()]
    command = ["cargo", "mutants", "--no-config", "--in-place", "--dir", str(home / "tree"), "--output", str(home), "--package", package, "--test-package", other,
               "--profile", "mutants", *limit, "--build-timeout", "600", "--no-times", "--jobserver=false", "--iterate", *choices]
    environment = {**os.environ, "CARGO_TARGET_DIR": str((home / "build").absolute())}
    status = subprocess.run(command, env=environment).returncode
    if status not in (0, 2, 3):
        sys.exit(f"cargo mutants ended with {status}: do the tests pass without a mutant?")
    if not timeout:
        baseline = json.loads((home / "mutants.out/outcomes.json").read_text())["outcomes"][0]
        timeout = max(60, round(10 * baseline["phase_results"][-1]["duration"]))
    return ended(package), timeout


def table(seed, draw, outcomes, reasons):
    lines = [
        "# Whether the tests see a mistake", "",
        f"`just lab mutants`: mutants of cargo-mutants, drawn at random (seed {seed}), shared among the crates by their lines, each against the tests",
        "of its own crate. Caught: a test fails, or none ends in time. Unviable: does not compile. Without effect: listed below with the reason.", "",
        "| crate | drawn | not yet tried | caught | of these out of time | unviable | without effect | missed | caught of those with effect |",
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    total, survivors = collections.Counter(), []
    for package, mutants in [*draw.items(), ("all", None)]:
        count = collections.Counter()
        for name, *_ in mutants or []:
            outcome = outcomes.get(name, "not tried")
            if outcome == "missed":
                outcome = "without effect" if name in reasons else "missed"
                survivors.append((name, reasons.get(name, "**missed**")))
            count[outcome] += 1
        total += count
        count = count if mutants else total
        caught = count["caught"] + count["timeout"]
        share = f"{100 * caught / (caught + count['missed']):.1f} %" if caught else "–"
        lines.append(f"| {package} | {count.total()} | {count['not tried']} | {caught} | {count['timeout']} | {count['unviable']} | {count['without effect']} | {count['missed']} | {share} |")
    lines += ["", "| survivor | what becomes of it |", "| --- | --- |"]
    lines += [f"| `{name.replace('|', '&#124;')}` | {reason} |" for name, reason in sorted(survivors)]
    return "\n".join(lines) + "\n"


def main():
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--seed", type=int, default=13)
    asked.add_argument("--mutants", type=int, default=DRAWN, help="how many are drawn")
    asked.add_argument("--package", choices=CRATES, action="append", help="only those of this crate")
    asked.add_argument("--file", action="append", help="only those of files that match, for instance crates/solver/src/contact*")
    asked.add_argument("--missed", action="store_true", help="only those that were missed so far")
    asked.add_argument("--list", action="store_true", help="only say what is drawn and what is known of it")
    asked = asked.parse_args()
    draw = drawn(asked.seed, asked.mutants)
    # Tests at the end of a file may be added to without making it another.
    digest = lambda file: hashlib.sha256(pathlib.Path(file).read_bytes().split(b"#[cfg(test)]\n")[0].rstrip()).hexdigest()
    reasons = json.loads(REASONS.read_text())
    outcomes = {}
    print(f"seed {asked.seed}: " + ", ".join(f"{len(mutants)} mutants of {package}" for package, mutants in draw.items()), flush=True)
    for package, mutants in draw.items():
        remembered = KNOWN / f"{package}.json"
        known = json.loads(remembered.read_text()) if remembered.exists() else {}
        by_name = {m[1]: m for m in mutants}
        for name, outcome in ended(package).items():
            key, _, file = by_name.get(name, (None, None, None))
            if key and (HOME / package / "tree" / file).exists():
                known[key] = (digest(HOME / package / "tree" / file), outcome)
        # What was found of a file as it is now.
        outcomes |= {m[0]: known[m[0]][1] for m in mutants if m[0] in known and known[m[0]][0] == digest(m[2])}
        chosen = [m for m in mutants if not asked.package or package in asked.package]
        chosen = [m for m in chosen if not asked.file or any(fnmatch.fnmatch(m[2], pattern) for pattern in asked.file)]
        if asked.list:
            print("\n".join(f"{outcomes.get(m[0], '-'):9} {m[1]} #{m[0].rsplit('#')[1]}" for m in chosen))
            continue
        left = {m[1]: m for m in chosen if outcomes.get(m[0], "missed" if not asked.missed else None) == "missed" and m[0] not in reasons}
        if left:
            copy(HOME / package / "tree")
        for tests in CRATES[package][1]:
            timeout = None
            for names in [list(left)[i : i + AT_ONCE] for i in range(0, len(left), AT_ONCE)]:
                found, timeout = tried(package, names, tests, timeout)
                for name, outcome in found.items():
                    outcomes[left[name][0]] = outcome
                    known[left[name][0]] = (digest(left[name][2]), outcome)
                KNOWN.mkdir(exist_ok=True)
                remembered.write_text(json.dumps(known, indent=0, sort_keys=True) + "\n")
            left = {name: m for name, m in left.items() if outcomes.get(m[0]) == "missed"}
    if not asked.list:
        TABLE.write_text(table(asked.seed, draw, outcomes, reasons))
        print(TABLE.read_text())


main()
