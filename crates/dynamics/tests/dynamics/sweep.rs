//! Sweeps: closed forms, the order of points, the number of threads.
#![allow(clippy::approx_constant, reason = "6.28 and 0.318 are the paper's inputs, not 2π and 1/π")]

use crate::common::{SSVI, TMD, scene};
use retune_dynamics::parameter::evenly;
use retune_dynamics::poincare::Periods;
use retune_dynamics::sweep::zones;
use retune_dynamics::{Error, Parameter, Zone, continuation, independent};
use retune_model::{Bare, Coupled};
use retune_solver::{Settings, Window};

const LATE: Window = Window { from: 300.0, to: 310.0 };

#[test]
fn exact_linear_sweeps_meet_the_steady_response() {
    let values = evenly(5.0, 8.0, 7);
    for design in [None, Some(TMD)] {
        let scene = scene(3.95e4, 6.28, design);
        let points =
            independent(&scene, Parameter::Omega, &values, LATE, &Settings::default(), || ()).expect("runs");
        for (point, &omega) in points.iter().zip(&values) {
            let steady = match &scene.damper {
                None => Bare::new(&scene.primary, &scene.forcing).steady(omega),
                Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).steady(omega),
            };
            assert!((point.e1_max / steady.e1_max - 1.0).abs() < 1e-9, "{omega}: {point:?} {steady:?}");
            assert_eq!((point.value, point.zone()), (omega, Zone::None));
            assert!((point.ratios()[0] + point.ratios()[1] - 1.0).abs() < 1e-15);
        }
    }
}

#[test]
fn invariant_continued_linear_sweeps_agree_in_both_directions() {
    let scene = scene(3.95e4, 6.28, Some(TMD));
    let up = evenly(5.0, 8.0, 5);
    let down: Vec<f64> = up.iter().rev().copied().collect();
    let periods = Periods { settle: 120, record: 3 };
    let run = |values: &[f64]| {
        continuation(&scene, Parameter::Omega, values, periods, &Settings::default(), || ()).expect("runs")
    };
    let (there, back) = (run(&up), run(&down));
    for (a, b) in there.iter().zip(back.iter().rev()) {
        assert_eq!((a.value, a.samples.len(), a.impacts), (b.value, 3, [0, 0]));
        assert!((a.samples[2][2] - b.samples[2][2]).abs() < 1e-9 && (a.e1_max / b.e1_max - 1.0).abs() < 1e-9);
    }
}

#[test]
fn contract_results_do_not_depend_on_threads() {
    let scene = scene(3.95e4, 6.28, Some(SSVI));
    let values = evenly(5.5, 7.5, 9);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let window = Window { from: 20.0, to: 40.0 };
            independent(&scene, Parameter::Omega, &values, window, &Settings::default(), || ()).expect("runs")
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn contract_zones_tile_the_sweep() {
    let scene = scene(3.95e4, 6.28, Some(SSVI));
    let window = Window { from: 50.0, to: 100.0 };
    let points =
        independent(&scene, Parameter::Omega, &evenly(4.0, 9.0, 26), window, &Settings::default(), || ())
            .expect("runs");
    let found = zones(&points);
    assert_eq!((found[0].1, found[found.len() - 1].2), (4.0, 9.0));
    assert!(found.windows(2).all(|pair| pair[0].2 == pair[1].1 && pair[0].0 != pair[1].0), "{found:?}");
    assert!(found.iter().any(|(zone, ..)| *zone == Zone::Bilateral));
}

#[test]
fn contract_impossible_sweeps_are_refused() {
    let settings = Settings::default();
    let periods = Periods { settle: 1, record: 1 };
    let bare = scene(3.95e4, 6.28, None);
    let refused = continuation(&bare, Parameter::Omega, &[6.0], periods, &settings, || ());
    assert_eq!(refused.err(), Some(Error::NoDamper));
    let tmd = scene(3.95e4, 6.28, Some(TMD));
    let refused = continuation(&tmd, Parameter::Omega, &[0.0], periods, &settings, || ());
    assert_eq!(refused.err(), Some(Error::NoPeriod));
    let refused = independent(&tmd, Parameter::K1, &[1.0, -1.0, f64::NAN], LATE, &settings, || ());
    assert!(matches!(refused, Err(Error::OutOfRange(wrong)) if wrong.value == -1.0));
}
