//! Regimes of motions whose regimes are known.
#![allow(clippy::approx_constant, reason = "6.28 and 0.318 are the paper's inputs, not 2π and 1/π")]

use crate::common::{ROW1, TMD, scene};
use retune_dynamics::{Exponent, Kind, Record, Regime, Stretch, classify, follow};
use retune_solver::Settings;

/// A record of a map of the line, with its exact growth of neighbours.
fn of_map(start: f64, steps: usize, settle: usize, map: impl Fn(f64) -> (f64, f64)) -> Record {
    let mut x = start;
    let (mut samples, mut growth) = (Vec::new(), Vec::new());
    for _ in 0..steps {
        let (next, slope) = map(x);
        growth.push(slope.abs().max(1e-12).ln());
        x = next;
        samples.push([x, 0.0, 0.0, 0.0]);
    }
    Record { period: 1.0, impacts: vec![[1, 0]; steps], samples, growth, settle }
}

fn logistic(r: f64, start: f64, steps: usize, settle: usize) -> Regime {
    classify(&of_map(start, steps, settle, |x| (r * x * (1.0 - x), r * (1.0 - 2.0 * x))))
}

#[test]
fn exact_logistic_cascade() {
    for (r, period) in [(2.8, 1), (3.2, 2), (3.5, 4), (3.55, 8), (3.835, 3)] {
        let regime = logistic(r, 0.3, 2000, 1000);
        assert_eq!((regime.kind, regime.period), (Kind::Periodic, Some(period)), "{r}: {regime:?}");
        assert_eq!(regime.impacts, [period as f64, 0.0]);
        assert!(regime.confidence > 0.95, "{r}: {regime:?}");
    }
}

#[test]
fn exact_logistic_chaos() {
    let regime = logistic(4.0, 0.3, 2000, 500);
    assert_eq!((regime.kind, regime.period), (Kind::Chaotic, None), "{regime:?}");
    assert!(regime.confidence > 0.95);
}

/// Just below the window of period 3 at r = 1 + √8: Pomeau & Manneville's type I (1980).
#[test]
fn exact_logistic_intermittency() {
    let regime = logistic(1.0 + 8.0_f64.sqrt() - 1e-4, 0.3, 4000, 500);
    assert_eq!(regime.kind, Kind::Intermittent, "{regime:?}");
}

/// In a window of period 3 most orbits have a chaotic transient near the former attractor. Long transients are rare:
/// take many starts.
#[test]
fn contract_transient_chaos_is_recognised() {
    let longest = (1..400).map(|i| f64::from(i) / 400.0).map(|start| logistic(3.8285, start, 3000, 2000));
    let chaotic = longest.filter(|regime| regime.transient.is_some()).count();
    assert!(chaotic > 0);
    let straight = logistic(3.2, 0.3, 1000, 500);
    assert_eq!(straight.transient, None, "{straight:?}");
}

/// A rotation by an irrational angle: never repeats, and neighbours keep their distance.
#[test]
fn contract_an_irrational_rotation_is_amplitude_modulated() {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let samples: Vec<[f64; 4]> = (0..1000)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * golden * f64::from(i)).sin_cos();
            [2.0 + cos, sin, 0.0, 0.0]
        })
        .collect();
    let growth = (0..1000).map(|i| 1e-3 * f64::from(i).sin()).collect();
    let regime = classify(&Record { period: 1.0, impacts: vec![[1, 1]; 1000], samples, growth, settle: 500 });
    assert_eq!((regime.kind, regime.label().as_str()), (Kind::AmplitudeModulated, "amplitude-modulated"));
    assert!(regime.confidence > 0.95, "{regime:?}");
}

#[test]
fn exact_tmd_is_periodic_without_impacts() {
    let record = follow(&scene(3.95e4, 6.28, Some(TMD)), None, Stretch::default(), &Settings::default())
        .expect("a run");
    let regime = classify(&record);
    assert_eq!(regime.label(), "T, 0, 0");
    assert!(regime.confidence > 0.95 && regime.transient.is_none(), "{regime:?}");
}

#[test]
fn reference_row_1_of_table_1_is_chaotic() {
    let record = follow(&scene(3.95e4, 6.28, Some(ROW1)), None, Stretch::default(), &Settings::default())
        .expect("a run");
    let regime = classify(&record);
    assert_eq!(regime.kind, Kind::Chaotic, "{regime:?}");
    assert!(regime.confidence > 0.95, "{regime:?}");
}

#[test]
fn contract_too_few_steps_have_an_infinite_error() {
    assert_eq!(Exponent::of(&[1.0; 5], 1.0).error, f64::INFINITY);
    assert_eq!(Exponent::of(&[], 1.0).value, 0.0);
}
