//! The invariants of a motion through hundreds of impacts: energy, momentum, and its symmetries.

use crate::problems::{Watch, assert_close, assert_states};
use retune_model::Coupled;
use retune_solver::{Hybrid, Motion, Phase};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TWO_SIDED};
use std::f64::consts::PI;

const RTOL: f64 = 1e-11;

/// Follows a motion and looks at every moment of it; returns the last one and the touch-downs.
fn follow(system: &Coupled, from: Motion, to: f64, look: impl FnMut(&[f64; 4])) -> (Motion, [u64; 2]) {
    let mut look = look;
    let mut watch = Watch::new(|knot: &retune_solver::observe::Knot<4>| look(&knot.y));
    let mut hybrid = Hybrid::new(system, RTOL, to - from.t, 10_000_000);
    let end = hybrid.propagate(from, to, &mut watch).expect("a run");
    (end, watch.touches)
}

fn start(numbers: &Numbers, v1: f64, v2: f64) -> Motion {
    Motion { t: 0.0, y: [0.01, v1, 0.01 + numbers.d, v2], phase: Phase::Flight }
}

/// Kinetic energy, both springs and `(2/5) K z^(5/2)` a contact, with nothing that takes or gives any.
#[test]
fn invariant_energy_through_impacts() {
    let still = Numbers { p: 0.0, c1: 0.0, c2: 0.0, ..SSVI };
    for (numbers, v2, t) in [
        (Numbers { d: 0.06, c: 0.36, ..still }, 2.0, 60.0),
        (Numbers { d: 0.0, c: 5.0, k2: 2400.0, ..still }, 0.7, 60.0),
        (Numbers { k2: 0.0, k1: 0.0, ..still }, 1.0, 120.0),
        (Numbers { r: 1e-6, k2: 2400.0, ..still }, 2.0, 100.0),
        (Numbers { m2: 600.0, r: 100.0, ..still }, 2.0, 60.0),
        (Numbers { m2: 0.01, k2: 0.04, ..still }, 3.0, 60.0),
    ] {
        let system = numbers.coupled();
        let begin = start(&numbers, 0.3, v2);
        let energy = system.total_energy(&begin.y);
        let mut worst: f64 = 0.0;
        let (_, touches) =
            follow(&system, begin, t, |y| worst = worst.max((system.total_energy(y) / energy - 1.0).abs()));
        assert!(touches.iter().sum::<u64>() >= 100, "{touches:?} {numbers:?}");
        assert!(worst < 1e-8, "{worst:e} {numbers:?}");
    }
}

#[test]
fn invariant_momentum_through_impacts() {
    let free = Numbers { p: 0.0, c1: 0.0, k1: 0.0, ..SSVI };
    for (numbers, t) in [
        (Numbers { k2: 215.0, c2: 0.0, ..free }, 150.0),
        (Numbers { k2: 0.0, c2: 0.2, d: 0.02, c: 0.02, ..free }, 60.0),
        (Numbers { k2: 0.0, c2: 0.0, m2: 1000.0, ..free }, 150.0),
    ] {
        let system = numbers.coupled();
        let begin = start(&numbers, -0.4, 2.0);
        let momentum = system.momentum(&begin.y);
        let size = numbers.m1 * 0.4 + numbers.m2 * 2.0;
        let mut worst: f64 = 0.0;
        let (_, touches) =
            follow(&system, begin, t, |y| worst = worst.max((system.momentum(y) - momentum).abs() / size));
        assert!(touches.iter().sum::<u64>() >= 100, "{touches:?} {numbers:?}");
        assert!(worst < 1e-8, "{worst:e} {numbers:?}");
    }
}

/// Energy never grows without a force.
#[test]
fn invariant_energy_only_falls_in_free_decay() {
    let numbers = Numbers { p: 0.0, c1: 50.0, c2: 20.0, d: 0.02, ..SSVI };
    let system = numbers.coupled();
    let begin = start(&numbers, 0.8, 2.0);
    let mut least = system.total_energy(&begin.y);
    let first = least;
    let (_, touches) = follow(&system, begin, 40.0, |y| {
        let now = system.total_energy(y);
        assert!(now <= least * (1.0 + 1e-10) + 1e-10 * first, "{now} {least}");
        least = now;
    });
    assert!(touches[0] >= 10 && least < 0.2 * first, "{touches:?} {least} {first}");
}

/// A motion followed in pieces, cut anywhere, also inside contacts, is the motion.
#[test]
fn invariant_a_motion_may_be_cut_anywhere() {
    let mut spread = Spread::new(9);
    for numbers in [SSVI, TWO_SIDED, Numbers { d: 0.0, r: 1e-6, ..SSVI }] {
        let system = numbers.coupled();
        let begin = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
        let (whole, touches) = follow(&system, begin, 8.0, |_| {});
        let mut cuts: Vec<f64> = (0..400).map(|_| 8.0 * spread.unit()).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.push(8.0);
        let (mut now, mut counted, mut pressed) = (begin, [0, 0], 0);
        for to in cuts {
            let (end, touches) = follow(&system, now, to, |_| {});
            assert_eq!(end.t, to);
            (0..2).for_each(|side| counted[side] += touches[side]);
            pressed += u32::from(matches!(end.phase, Phase::InContact(_)));
            now = end;
        }
        assert!(pressed > 0, "some cuts lie inside contacts");
        assert_eq!(counted, touches, "{numbers:?}");
        assert_states(now.y, whole.y, [0.1, 1.0], 1e-8, &format!("{numbers:?}"));
    }
}

/// The same motion a period of the force later.
#[test]
fn invariant_a_period_later_the_motion_is_the_same() {
    for numbers in [SSVI, TWO_SIDED] {
        let system = numbers.coupled();
        let begin = Motion { t: 0.0, y: [0.01, 0.2, 0.05, -0.3], phase: Phase::Flight };
        let (expected, touches) = follow(&system, begin, 8.0, |_| {});
        let period = 2.0 * PI / numbers.omega;
        let (found, again) = follow(&system, Motion { t: period, ..begin }, 8.0 + period, |_| {});
        assert_eq!(touches, again);
        assert_states(found.y, expected.y, [0.1, 1.0], 1e-9, &format!("{numbers:?}"));
    }
}

/// Seen in a mirror: the walls swapped, the force reversed (half a period later), every displacement reversed.
#[test]
fn invariant_mirror_symmetry() {
    for numbers in [Numbers { c: 0.15, ..SSVI }, TWO_SIDED, Numbers { d: 0.0, c: 0.2, ..SSVI }] {
        let [e1, e2, e3, e4] = numbers.young;
        let mirrored = Numbers { d: numbers.c, c: numbers.d, young: [e3, e4, e1, e2], ..numbers };
        let span = numbers.d + numbers.c;
        let reflect = |[x1, v1, x2, v2]: [f64; 4]| [-x1, -v1, span - x2, -v2];
        let y = [0.02, 0.3, 0.02 + 0.5 * span, -0.4];
        let half = PI / numbers.omega;
        let begin = Motion { t: 0.0, y, phase: Phase::Flight };
        let (expected, touches) = follow(&numbers.coupled(), begin, 8.0, |_| {});
        let begin = Motion { t: half, y: reflect(y), phase: Phase::Flight };
        let (found, swapped) = follow(&mirrored.coupled(), begin, 8.0 + half, |_| {});
        assert_eq!(touches, [swapped[1], swapped[0]]);
        assert!(touches[0] > 5, "{touches:?}");
        assert_states(reflect(found.y), expected.y, [0.1, 1.0], 1e-8, &format!("{numbers:?}"));
    }
}

/// The motion depends on mass, stiffness and force only by their ratios.
#[test]
fn invariant_scale_of_mass() {
    let system = SSVI.coupled();
    let begin = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    let (expected, touches) = follow(&system, begin, 10.0, |_| {});
    let f = 37.0;
    let heavy = Numbers {
        m1: f * SSVI.m1,
        c1: f * SSVI.c1,
        k1: f * SSVI.k1,
        p: f * SSVI.p,
        m2: f * SSVI.m2,
        k2: f * SSVI.k2,
        c2: f * SSVI.c2,
        q: f * SSVI.q,
        ..SSVI
    };
    let (found, again) = follow(&heavy.coupled(), begin, 10.0, |_| {});
    assert_eq!(touches, again);
    assert_states(found.y, expected.y, [0.1, 1.0], 1e-9, "scaled");
    assert_close(
        heavy.coupled().total_energy(&found.y),
        f * system.total_energy(&expected.y),
        1e4,
        1e-7,
        "E",
    );
}
