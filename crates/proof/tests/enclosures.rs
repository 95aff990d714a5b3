//! Operations on intervals against MPFR's results, rounded down and up: `tests/reference/enclosures.py`, by gmpy2, as a build of MPFR in C is no
//! task for each test run. `just lab proof-draws` compares a million.

use retune_proof::{Interval, cos_sin};
use std::fs;

/// A small table, or that of another path.
fn table() -> String {
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/enclosures.csv");
    fs::read_to_string(std::env::var("RETUNE_ENCLOSURES").unwrap_or(own.to_owned())).expect("a table")
}

fn of(name: &str, x: Interval, y: Interval) -> Interval {
    match name {
        "add" => x + y,
        "sub" => x - y,
        "mul" => x * y,
        "div" => x / y,
        "sqrt" => x.abs().sqrt(),
        "square" => x.square(),
        "cos" => cos_sin(x)[0],
        "sin" => cos_sin(x)[1],
        other => panic!("{other}"),
    }
}

#[test]
fn reference_mpfrs_results_are_enclosed() {
    let mut draws = 0;
    for line in table().lines() {
        let (name, numbers) = line.split_once(',').expect("a name");
        let numbers: Vec<f64> = numbers.split(',').map(|x| x.parse().expect("a number")).collect();
        let [x, y, down, up] = numbers[..] else { panic!("{line}") };
        let own = of(name, Interval::point(x), Interval::point(y));
        assert!(own.lo() <= down && up <= own.hi(), "{line}: {own:?}");
        // And it is narrow: some units in the last place, or some of 1 of an angle.
        let most = if matches!(name, "cos" | "sin") { 1e-15 * (1.0 + x.abs()) } else { 1e-15 * up.abs() };
        assert!(own.width() <= most, "{line}: {own:?}");
        draws += 1;
    }
    assert!(draws >= 1000, "{draws}");
}
