"""Removes each rounding and each remainder of crates/proof in turn, and sees whether one of its tests fails: results/robustness/proof-mutants.md.

python3 tests/proof_mutants.py [WORD ...]: only those whose words hold one of these; the others stay as the table has them.
"""

import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).parent.parent
COPY = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "proof-mutants"
OUT = ROOT / "results" / "robustness" / "proof-mutants.md"
# Of a test that does not end.
SECONDS = 900
# Each mutant is built anew: faster, if its code is slower.
LITTLE = ["--config", "profile.test.package.retune-proof.opt-level=1"]

# What is removed: in words, in which file, which text, and what stands there instead.
MUTANTS = [
    ("rounding of lower bounds", "interval", "{ f64::NEG_INFINITY } else { x.next_down() }", "{ f64::NEG_INFINITY } else { x }"),
    ("rounding of upper bounds", "interval", "{ f64::INFINITY } else { x.next_up() }", "{ f64::INFINITY } else { x }"),
    ("rounding of the least square", "interval", "below(lo * lo).max(0.0)", "lo * lo"),
    ("rounding of the least root", "interval", "below(self.lo.sqrt()).max(0.0)", "self.lo.sqrt()"),
    ("unit in the last place of decimals", "interval", "Self::new(x.next_down(), x.next_up())", "Self::point(x)"),
    ("pi/2 beyond its double", "elementary", "Interval::new(FRAC_PI_2, FRAC_PI_2.next_up())", "Interval::point(FRAC_PI_2)"),
    ("width of an angle", "elementary", "(value + away).meet(all)", "value.meet(all)"),
    ("remainder of sine and cosine", "elementary", "Interval::around_zero(left_out), |sum", "Interval::ZERO, |sum"),
    ("rounding of a sum of polynomials", "taylor", "bound(sum.rest + UNIT * sum.size())", "sum.rest"),
    ("rounding of a product of polynomials", "taylor", "beyond + rounded + a", "beyond + a"),
    ("what a product cuts off", "taylor", "beyond + rounded + a", "rounded + a"),
    ("rests in a product", "taylor", " + a * other.rest + b * self.rest + self.rest * other.rest", ""),
    ("rest in the range of a polynomial", "taylor", "fold(self.rest(), |sum, k| sum + range(k))", "fold(Interval::ZERO, |sum, k| sum + range(k))"),
    ("width of an interval as a polynomial", "taylor", "rest: (x - Interval::point(middle)).magnitude(), ..", "rest: 0.0, .."),
    ("what a reciprocal leaves out", "taylor", "bound(p.size() * (off / (1.0 - off)))", "0.0"),
    ("what a series of the sine leaves out", "taylor", "bound(sum.rest + term.hull().magnitude())", "sum.rest"),
    ("rest on a part of a family", "taylor", "bound(all.rest + self.rest)", "all.rest"),
    ("remainder of a step", "step", "at(from_middle.iter().map(|c| c[i]), h) + Taylor::from(anywhere[order][i])", "at(from_middle.iter().map(|c| c[i]), h)"),
    ("remainder of its derivatives", "step", "at(series.iter().map(|c| c[i].by[j]), h) + Taylor::from(by_left_out[i][j])", "at(series.iter().map(|c| c[i].by[j]), h)"),
    ("last coefficient anywhere in a step", "step", "flow.series(&Gradient::coordinates(&e), order)", "{ let _ = e; flow.series(&Gradient::coordinates(&all.map(Taylor::hull)), order) }"),
    ("derivatives anywhere in a step", "step", "c.by.map(|by| by * power)), &within)", "c.by.map(|by| by * power)), &{ let _ = within; identity() })"),
    ("derivatives over a box", "step", "flow.series(&Gradient::coordinates(&all), order - 1)", "flow.series(&Gradient::coordinates(&states.centre()), order - 1)"),
    ("rounding of the centre", "step", "spread[i] = spread[i] + column[i] * states.spread[j]", "spread[i] = column[i] * Interval::ZERO"),
    ("box about the centre", "step", "plus(&self.centre(), &array::from_fn(moved))", "{ let _ = moved; self.centre() }"),
    ("way of a step within its box", "step", "if (0..STATE).all(|i| next[i].is_in(e[i]))", "if next[0].is_bounded()"),
    ("frame that is orthogonal to rounding", "number", "Some(b.map(|b| b + off))", "{ let _ = off; Some(b) }"),
    ("centre among the states of a box", "segment", "wide[i] = away.hull(Interval::ZERO)", "wide[i] = *away"),
    ("gaps during a segment", "segment", "if !Range::new(piece.series_of(section)).is_positive(starts, ends)", "if false && starts && ends"),
    ("gaps about its end", "segment", "if !section.is_towards(left)", "if left.hi().is_nan()"),
    ("force of a contact that may end", "segment", "all.push((Event::Pull, -(Interval::ONE / lambda)));", "let _ = lambda;"),
    ("sign of the slope at a crossing", "crossing", "section.is_towards(slope.hull()).then(", "(slope.hull().is_positive() || slope.hull().is_negative()).then("),
    ("time of a crossing by the state", "crossing", "by[i][j] - slopes[i] * per_slope * by[fixed][j]", "{ let _ = per_slope; by[i][j] }"),
    ("way to a crossing within its time", "crossing", "if next.hull().is_in(tried)", "if next.hull().is_bounded()"),
    ("state on the way to a crossing", "crossing", "start[i] + Taylor::from(way * rough[i])", "{ let _ = (way, &rough); start[i] }"),
    ("derivatives on the way to a crossing", "crossing", "times(&within.map(|row| row.map(Taylor::from)), &states.by)", "{ let _ = within; states.by }"),
    ("slope of a range", "range", "self.value(middle) + self.slope(t) * (t - Interval::point(middle))", "self.value(middle)"),
    ("last term of a range", "step", "series.extend(quantity.series(self.mode, &self.anywhere).pop().map(Taylor::from));", ""),
    ("whether a motion reaches a value", "range", "if t <= sure", "if sure >= 0.0"),
    ("largest value about the end", "largest", "most = most.max(Interval::new(most.lo(), value.hull().hi().max(most.lo())));", "let _ = value;"),
    ("gaps of a steady motion", "theorem", "if !(gap - stroke).is_positive()", "if (gap - stroke).is_negative()"),
    ("mass or spring in the energy of a steady motion", "theorem", "(half * k1).hull().max(", "{ let _ = k1; Interval::ZERO }.max("),
    ("whether a steady motion is alone and stable", "equations", "k2.is_positive() && is_damped", "(k2.is_positive() || is_damped)"),
    ("shift of the determinant of a steady motion", "theorem", "all[k] = all[k] - sigma * all[k - 1]", "all[k] = all[k] - Interval::ZERO * sigma"),
    ("steps of Routh's scheme for a steady motion", "theorem", "second.is_positive() && is_next()", "second.is_positive() && (is_next() || true)"),
    ("last term of Krawczyk's operator", "theorem", "terms.fold(-moved.hull(), |sum, term| sum + term)", "{ drop(terms); -moved.hull() }"),
    ("box that is mapped into itself", "theorem", "all(|(image, away)| image.is_inside(*away))", "all(|(image, away)| image.is_bounded() && away.is_bounded())"),
    # `== Some(true)` of what is stable has no mutant: a form that falls is negative somewhere only if the largest multiplier is above 1, and that was asked before.
    ("sign of a form", "stability", ".is_negative().then_some(false)", ".is_negative().then_some(true)"),
    ("whether forms fall", "stability", "if are_falling(&scaled, &forms) {", "if are_falling(&scaled, &forms) || true {"),
    ("pivots of a form", "stability", "if !a[k][k].is_positive()", "if a[k][k].is_negative()"),
    ("rounding of chi", "loss", "let [low, high] = [low - off * 16.0 * low, high + off * 16.0 * high];\n        let holds = ", "let [low, high] = [low, low * (1.0 + 0.0 * off)];\n        let holds = true || "),
]


def copied():
    """The workspace without what no test of the crate needs."""
    COPY.mkdir(parents=True, exist_ok=True)
    for name in ["crates", "tests/reference"]:
        shutil.rmtree(COPY / name, ignore_errors=True)
        # With new times: cargo would take a mutant of the last run for what was built of an older file.
        shutil.copytree(ROOT / name, COPY / name, copy_function=shutil.copy)
    for name in ["Cargo.toml", "Cargo.lock", "README.md"]:
        shutil.copy(ROOT / name, COPY / name)


def failed_of(*tests):
    """The first of some tests that fails; none if all pass."""
    command = ["cargo", "test", "--quiet", *LITTLE, "--package", "retune-proof", *tests]
    environment = {**os.environ, "CARGO_TARGET_DIR": str(COPY / "target"), "RUSTFLAGS": "--cap-lints allow"}
    try:
        run = subprocess.run(command, cwd=COPY, env=environment, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return "no end"
    if run.returncode == 0:
        return None
    failed = [line.split(" ")[1] for line in run.stdout.splitlines() if line.startswith("---- ")]
    if not failed:
        sys.exit(f"no test ran:\n{run.stdout[-2000:]}{run.stderr[-2000:]}")
    return failed[0]


def tested(last=None):
    """The first test that fails: that which did the last time, if it is known; or of the library, whose tests are short; or else of whole proofs."""
    lib, whole = ["--lib"], ["--test", "enclosures", "--test", "prove"]
    # Modules may have other names since.
    own = last and failed_of(*(lib if "::" in last else whole), last.split("::")[-1])
    return own or failed_of(*lib) or failed_of(*whole)


def known():
    """Which test caught which mutant, by the table."""
    cells = [line.split(" | ") for line in OUT.read_text().splitlines() if line.count(" | ") == 2] if OUT.exists() else []
    return {first.removeprefix("| "): test.removesuffix(" |") for first, _, test in cells[2:]}


def write(found):
    """The table, with what is known of each mutant."""
    tests = [found.get(words, "not run") for words, *_ in MUTANTS]
    caught = sum(test not in ("none", "not run") for test in tests)
    head = (
        "# Mutants of the proof\n\n`just lab proof-mutants` removed each rounding, remainder and check of `crates/proof` in turn (with words: those that its line holds); "
        f"a test that then fails:\n\n{caught} of {len(MUTANTS)} are caught, {tests.count('none')} are not, {tests.count('not run')} were not run.\n\n"
        "| removed | in | caught by |\n| --- | --- | --- |\n"
    )
    OUT.write_text(head + "".join(f"| {words} | {name}.rs | {test} |\n" for (words, name, *_), test in zip(MUTANTS, tests)))


def main():
    copied()
    if (failed := tested()) is not None:
        sys.exit(f"a test fails as it is: {failed}")
    last = known()
    found = dict(last) if sys.argv[1:] else {}
    for words, name, before, after in MUTANTS:
        if sys.argv[1:] and not any(word in words for word in sys.argv[1:]):
            continue
        file = COPY / "crates" / "proof" / "src" / f"{name}.rs"
        text = file.read_text()
        if text.count(before) != 1:
            sys.exit(f"{words}: {name}.rs has this {text.count(before)} times: {before}")
        file.write_text(text.replace(before, after))
        found[words] = tested(last.get(words)) or "none"
        file.write_text(text)
        print(f"| {words} | {name}.rs | {found[words]} |", flush=True)
        write(found)


if __name__ == "__main__":
    main()
