//! Strong dashpots: the fast part of the motion is left out once it has decayed.

use retune_solver::{Settings, Window, least_steps, leaves_out_a_fast_part, simulate};
use retune_testkit::scenes::{Numbers, SSVI};

/// E1max by the eigenvectors of the linear system in 40 digits: `tests/reference/dashpots.py`.
const EXACT: [(f64, f64); 3] =
    [(1e4, 911.441_197_593_448_2), (1e5, 941.939_579_210_149_1), (1e7, 945.466_948_218_196_2)];

#[test]
fn exact_a_strong_dashpot_in_long_steps() {
    for (c2, exact) in EXACT {
        let scene = Numbers { c2, ..SSVI }.scene();
        let run = simulate(&scene, Window { from: 50.0, to: 100.0 }, &Settings::default()).expect("a run");
        let error = (run.e1_max.value / exact - 1.0).abs();
        assert!(error < 1e-11, "c2 {c2}: {} is off by {error:e}", run.e1_max.value);
        assert!(run.work.steps < 2000, "c2 {c2}: {} steps", run.work.steps);
        assert!(leaves_out_a_fast_part(&scene, 100.0), "c2 {c2}");
        assert!(least_steps(&scene, 100.0) > 2000.0, "c2 {c2}: those of the whole flow");
    }
    assert!(!leaves_out_a_fast_part(&SSVI.scene(), 100.0), "no strong dashpot");
    assert!(!leaves_out_a_fast_part(&SSVI.bare_scene(), 100.0), "no damper");
}

#[test]
fn invariant_long_steps_see_what_short_steps_see() {
    retune_testkit::hunt::dashpots::dashpots(30).passes();
}

/// D, E1max and the largest force of the wall in 6 s with c2 = 1e7, by SciPy's Radau at 3e-13: `tests/reference/held_dashpots.py`. The damper swings 7e-6
/// m to either side of D: a wall holds it half of the time, for shorter contacts, and for two brief ones.
const HELD: [(f64, f64, f64); 3] = [
    (0.0, 750.641_454_293_552, 0.870_315_359_244_513_1),
    (5e-6, 750.641_460_320_591, 0.121_434_962_479_043_06),
    (6.5e-6, 750.641_460_972_729, 0.008_929_234_207_572_084),
];

#[test]
fn reference_contacts_with_a_strong_dashpot_in_long_steps() {
    for (d, e1, force) in HELD {
        let scene = Numbers { c2: 1e7, d, ..SSVI }.scene();
        let run = simulate(&scene, Window { from: 0.0, to: 6.0 }, &Settings::default()).expect("a run");
        let errors = [run.e1_max.value / e1 - 1.0, run.force_max[0] / force - 1.0];
        assert!(errors[0].abs() < 1e-11 && errors[1].abs() < 1e-8, "D {d}: {errors:?} {run:?}");
        assert!(run.work.steps < 2000, "D {d}: {} steps", run.work.steps);
    }
}
