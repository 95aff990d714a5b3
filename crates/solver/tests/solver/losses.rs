//! Where the energy of a motion goes.

use crate::forcings::decay;
use nalgebra::Complex;
use retune_model::{Amplitude, Bare, Coupled, Finite, Scene, Start};
use retune_solver::{Losses, Settings, Window, simulate_in_detail};
use retune_testkit::scenes::{LOSSY, Numbers, SSVI, TMD, TWO_SIDED};
use std::f64::consts::TAU;

fn tight() -> Settings {
    Settings { rtol: 1e-13, ..Settings::default() }
}

fn lost_in(scene: &Scene, window: Window) -> Losses {
    let (_, lost, _) = simulate_in_detail(scene, window, &tight()).expect("a run");
    lost
}

/// What a free decay has lost is what is missing from its energy; without loss impacts take nothing.
#[test]
fn exact_a_free_decay_loses_what_is_missing() {
    let number = |value: f64| Finite::new(value).expect("a number");
    let start = Start { v1: number(1.0), x2: Some(number(0.05)), v2: number(-1.0), ..Start::default() };
    for numbers in [SSVI, TWO_SIDED, LOSSY, Numbers { lambda: 20.0, ..TWO_SIDED }, TMD] {
        let scene = decay(numbers, start);
        let system = Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper"));
        let window = Window { from: 0.0, to: 12.0 };
        let (run, lost, _) = simulate_in_detail(&scene, window, &tight()).expect("a run");
        let [before, after] = [system.start(), run.final_state].map(|y| system.total_energy(&y));
        // Observers see a collision without loss to ten digits, one with loss to all.
        let allowed = if numbers.lambda > 0.0 { 1e-13 } else { 1e-10 };
        let error = (lost.total() - (before - after)).abs() / before;
        assert!(error < allowed, "{error:e} of {numbers:?}");
        assert!(lost.structure > 0.0 && lost.damper > 0.0 && (lost.impacts > 0.0) == (numbers.lambda > 0.0));
        let parts =
            [Window { from: 0.0, to: 5.0 }, Window { from: 5.0, to: 12.0 }].map(|part| lost_in(&scene, part));
        for part in
            [|lost: &Losses| lost.structure, |lost: &Losses| lost.damper, |lost: &Losses| lost.impacts]
        {
            let sum: f64 = parts.iter().map(part).sum();
            assert!((sum - part(&lost)).abs() < 1e-11 * before, "{parts:?} {lost:?}");
        }
    }
}

/// The mean powers of a steady motion are `c1 ω² |X1 - Y|² / 2` and `c2 ω² |X2 - X1|² / 2`; on a moving base `Y` is its amplitude.
#[test]
fn exact_powers_of_a_steady_motion() {
    let period = TAU / TMD.omega;
    let window = Window { from: 300.0 * period, to: 310.0 * period };
    let base = Numbers { p: 0.01, ..TMD }.forced_by(Amplitude::Base);
    for (with, base) in [(TMD.scene(), 0.0), (base, 0.01)] {
        for scene in [with, Scene { damper: None, ..with }] {
            let steady = match &scene.damper {
                None => Bare::new(&scene.primary, &scene.forcing).steady(TMD.omega),
                Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).steady(TMD.omega),
            };
            let power = |damping: f64, amplitude: Complex<f64>| {
                0.5 * damping * (TMD.omega * amplitude).norm_sqr() * 10.0 * period
            };
            let lost = lost_in(&scene, window);
            let structure = power(TMD.c1, steady.x1 - base);
            assert!((lost.structure / structure - 1.0).abs() < 1e-10, "{lost:?} {structure}");
            let damper = power(TMD.c2, steady.x2 - steady.x1);
            assert!((lost.damper - damper).abs() < 1e-10 * structure, "{lost:?} {damper}");
            assert_eq!(lost.impacts, 0.0);
        }
    }
}

/// Impacts with rigid walls lose `μ w² (1 - e²) / 2` each; with e = 1 nothing.
#[test]
fn exact_impacts_with_rigid_walls_lose_what_is_missing() {
    let number = |value: f64| Finite::new(value).expect("a number");
    let start = Start { v1: number(1.0), x2: Some(number(0.05)), v2: number(-1.0), ..Start::default() };
    for e in [0.0, 0.3, 0.7, 1.0] {
        let scene = decay(Numbers { rigid: Some(e), ..TWO_SIDED }, start);
        let system = Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper"));
        let window = Window { from: 0.0, to: 8.0 };
        let (run, lost, _) = simulate_in_detail(&scene, window, &tight()).expect("a run");
        let [before, after] = [system.start(), run.final_state].map(|y| system.total_energy(&y));
        let error = (lost.total() - (before - after)).abs() / before;
        assert!(error < 1e-12 && (lost.impacts > 1e-9) == (e < 1.0), "{e}: {error:e} {lost:?}");
    }
}
