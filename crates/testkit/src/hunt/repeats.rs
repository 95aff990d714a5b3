//! Compares runs that end when their motion repeats with the same runs to the end.

use super::Hunt;
use crate::scenes::{Numbers, SSVI, Spread};
use rayon::prelude::*;
use retune_solver::{Also, Ask, Settings, Window, extremes, simulate};

/// A damper as in searches: any bodies, springs and gaps, at any practical frequency.
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

/// Relative differences of the largest E1, stroke and contact force over the window between a run that may end when it repeats and one that
/// does not. A contact force smaller than the force on the structure is compared relative to the latter.
pub fn differences(number: u64) -> [f64; 3] {
    let window = Window { from: 50.0, to: 100.0 };
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

/// Largest difference allowed for a run that ends early, in units of its rtol, at most 1e-5. Energies are squares, and a force grows faster
/// than the stroke.
const ALLOWED: f64 = 15.0;

/// Compares runs that may end when they repeat with complete ones on `count` scenes.
pub fn repeats(count: u64) -> Hunt {
    let looked: Vec<_> = (0..count).into_par_iter().map(|number| (number, differences(number))).collect();
    let mut hunt = Hunt::default();
    for exponent in 4..=10 {
        let rtol = 10_f64.powi(-exponent);
        let own = looked.iter().filter(|(number, _)| 10 - number % 7 == exponent as u64);
        let own: Vec<_> =
            own.map(|&(number, shares)| (number, shares.map(|share| share / rtol.min(1e-5)))).collect();
        let ended = own.iter().filter(|(_, missed)| missed.iter().any(|missed| *missed > 0.0)).count();
        let [e1, stroke, force] =
            [0, 1, 2].map(|i| own.iter().map(|(_, missed)| missed[i]).fold(0.0, f64::max));
        hunt.row(format!("| {rtol:e} | {} | {ended} | {e1:.2} | {stroke:.2} | {force:.2} |", own.len()));
        hunt.check(ended > own.len() / 5, || format!("few runs ended early: {ended} of {}", own.len()));
        for (number, missed) in own {
            let holds = missed.iter().all(|missed| *missed <= ALLOWED);
            hunt.check(holds, || format!("{number} {missed:?} {:?}", drawn(number)));
        }
    }
    hunt
}
