//! Runs that end when their motion repeats, beside the same runs to the end.
//!
//! `just lab hunt-repeats` draws as many scenes as it is told to (`RETUNE_REPEATS`); the test suite draws few.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a hunt says what it looked at")]

use rayon::prelude::*;
use retune_solver::{Also, Ask, Settings, Window, extremes, simulate};
use retune_testkit::scenes::{Numbers, SSVI, Spread};

/// A damper of those that searches meet: any bodies, springs and gaps, at any frequency of an engineer's.
fn drawn(number: u64) -> (Numbers, Settings) {
    let mut draw = Spread::new(number + 1);
    let mut within = |low: f64, high: f64| low + (high - low) * draw.unit();
    let mut numbers = Numbers {
        k1: within(2e4, 6e4),
        k2: within(10.0, 2500.0),
        c2: within(1.0, 400.0),
        d: within(0.0, 0.2),
        c: within(0.0, 0.6),
        omega: within(4.0, 9.0),
        ..SSVI
    };
    for value in [&mut numbers.d, &mut numbers.c] {
        if draw.unit() < 0.1 {
            *value = 0.0;
        }
    }
    let rtol = [1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4][(number % 7) as usize];
    (numbers, Settings { rtol, ..Settings::default() })
}

/// By how much the largest E1, stroke and contact force over the window differ in a run that may end when it repeats from those of one that
/// does not, as shares; of a force that is smaller than that on the structure, as a share of the latter.
fn both(number: u64, window: Window) -> [f64; 3] {
    let (numbers, settings) = drawn(number);
    let ask = Ask { also: Some(Also::walls(window.from)), ..Ask::default() };
    let early = extremes(&numbers.scene(), window, &settings, ask).expect("a run");
    let whole = simulate(&numbers.scene(), window, &settings).expect("a run");
    let force = whole.force_max[0].max(whole.force_max[1]);
    let pairs = [
        (early.largest.value, whole.e1_max.value, whole.e1_max.value),
        (early.stroke(), whole.spring_deflection_max, whole.spring_deflection_max),
        (early.force(), force, force.max(numbers.p)),
    ];
    pairs.map(|(a, b, size)| if a == b { 0.0 } else { (a - b).abs() / size })
}

/// What a run that ends early may miss, in tolerances of the run, the loosest of which counts as 1e-5: energies are squares, and a force
/// grows faster than the stroke.
const ALLOWED: f64 = 15.0;

#[test]
fn invariant_a_run_that_repeats_has_seen_its_largest_values() {
    let count: u64 = std::env::var("RETUNE_REPEATS").ok().and_then(|n| n.parse().ok()).unwrap_or(1400);
    let window = Window { from: 50.0, to: 100.0 };
    let looked: Vec<_> = (0..count).into_par_iter().map(|number| (number, both(number, window))).collect();
    let mut faults = Vec::new();
    for exponent in 4..=10 {
        let rtol = 10_f64.powi(-exponent);
        let own = looked.iter().filter(|(number, _)| 10 - number % 7 == exponent as u64);
        let own: Vec<_> =
            own.map(|&(number, shares)| (number, shares.map(|share| share / rtol.min(1e-5)))).collect();
        let ended = own.iter().filter(|(_, missed)| missed.iter().any(|missed| *missed > 0.0)).count();
        let [e1, stroke, force] =
            [0, 1, 2].map(|i| own.iter().map(|(_, missed)| missed[i]).fold(0.0, f64::max));
        println!("| {rtol:e} | {} | {ended} | {e1:.2} | {stroke:.2} | {force:.2} |", own.len());
        assert!(ended > own.len() / 5, "few runs ended early: {ended} of {}", own.len());
        faults.extend(
            own.into_iter()
                .filter(|(_, missed)| missed.iter().any(|missed| missed.is_nan() || *missed > ALLOWED)),
        );
    }
    for (number, missed) in faults.iter().take(12) {
        eprintln!("{number} {missed:?} {:?}", drawn(*number));
    }
    assert!(faults.is_empty(), "{} of {count}", faults.len());
}

/// Irregular runs that once come close to a motion, look ahead in vain, and go on: to the last bit as if they had not looked.
#[test]
fn regress_a_look_ahead_in_vain_changes_nothing() {
    for number in [1834, 1940, 7228, 10769, 12980, 13042, 15339, 15802, 17454, 21079, 22424, 35212] {
        let missed = both(number, Window { from: 50.0, to: 100.0 });
        assert!(missed.iter().all(|missed| *missed == 0.0), "{number}: {missed:?}");
    }
}
