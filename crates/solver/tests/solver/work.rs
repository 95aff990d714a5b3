//! How much work a run is. A mistake that only makes runs slow is seen here, on a busy machine as on a quiet one; times and
//! instructions are measured by `just lab bench-instructions`.

use retune_model::{Finite, Form, Of, Scene};
use retune_solver::methods::{Ode23s, Ode45, OneStep, Tolerance};
use retune_solver::{Contacts, Method, Settings, System, Window, Work, least_steps, simulate};
use retune_testkit::histories::made;
use retune_testkit::scenes::{SSVI, TMD};

/// The first step from a state: MATLAB's `ode45` and `ode23s`, formula by formula, of numbers that are easily followed by hand.
#[test]
fn exact_first_steps_are_matlabs() {
    struct Given;
    impl System<2> for Given {
        fn derivative(&self, _t: f64, _y: &[f64; 2]) -> [f64; 2] {
            [6.0, -8.0]
        }
        fn jacobian(&self, _t: f64, _y: &[f64; 2]) -> nalgebra::SMatrix<f64, 2, 2> {
            nalgebra::SMatrix::<f64, 2, 2>::from_row_slice(&[0.0, 2.0, -9.0, 1.0])
        }
        fn time_derivative(&self, _t: f64, _y: &[f64; 2]) -> [f64; 2] {
            [0.0, 12.0]
        }
    }
    let (y, f) = ([3.0, 0.1], [6.0, -8.0]);
    let tolerance = Tolerance { rtol: 1e-5, threshold: 0.5 };
    // max |f / max(|y|, threshold)| = 16, and 10 = rtol^(-1/5): rh = 16 / (0.8 · 0.1) = 200.
    let first = |longest| Ode45::first_step(&Given, 0.0, &y, &f, tolerance, longest);
    assert!((first(1.0) * 200.0 - 1.0).abs() < 1e-14, "{}", first(1.0));
    assert_eq!(first(0.004), 0.004, "no longer than allowed");
    // y'' = J f + ∂f/∂t = [-16, -62 + 12] = [-16, -50]: rh = 1.25 √(0.5 · 100 / rtol).
    let first = |longest| Ode23s::first_step(&Given, 0.0, &y, &f, tolerance, longest);
    let expected = 1.0 / (1.25 * f64::sqrt(0.5 * 100.0 / 1e-5));
    assert!((first(1.0) / expected - 1.0).abs() < 1e-14, "{}", first(1.0));
    assert_eq!(first(1e-4), 1e-4, "no longer than allowed");
}

/// Steps, rejected steps and evaluations of every method. A change for a reason changes the numbers here; more of them need one.
#[test]
fn regress_work_of_every_method() {
    let window = Window { from: 2.0, to: 12.0 };
    for (method, rtol, contacts, expected) in [
        (Method::Ode45, 1e-6, Contacts::Located, [[434, 18, 2713], [448, 2, 2701], [837, 108, 6037]]),
        (Method::Ode45, 1e-6, Contacts::Stepped, [[434, 18, 2713], [448, 2, 2701], [837, 100, 5623]]),
        (Method::Ode23s, 1e-4, Contacts::Located, [[1014, 39, 3160], [1117, 61, 3535], [1763, 133, 5896]]),
        (Method::Ode23, 1e-4, Contacts::Located, [[819, 45, 2593], [893, 68, 2884], [1391, 163, 4828]]),
        (Method::Dop853, 1e-8, Contacts::Located, [[170, 6, 2641], [177, 6, 2746], [616, 199, 13006]]),
        (Method::Hybrid, 1e-6, Contacts::Located, [[65, 0, 0], [118, 0, 0], [127, 0, 224]]),
        (Method::Hybrid, 1e-10, Contacts::Located, [[65, 0, 0], [118, 0, 0], [127, 0, 736]]),
    ] {
        let settings = Settings { method, rtol, atol: 1e-2 * rtol, contacts, ..Settings::default() };
        let found = [SSVI.bare_scene(), TMD.scene(), SSVI.scene()].map(|scene| {
            let Work { steps, rejected, evaluations } =
                simulate(&scene, window, &settings).expect("a run").work;
            [steps, rejected, evaluations]
        });
        assert_eq!(found, expected, "{method:?} at {rtol:e}, {contacts:?}");
    }
}

/// A run without contacts takes just those, one with contacts more.
#[test]
fn exact_the_least_steps_of_a_run_are_those_of_its_flight() {
    let steps = |scene| {
        let window = Window { from: 0.0, to: 20.0 };
        simulate(&scene, window, &Settings::default()).expect("a run").work.steps as f64
    };
    let least = |scene| least_steps(&scene, 20.0).ceil();
    assert_eq!(steps(TMD.scene()), least(TMD.scene()));
    assert!(steps(SSVI.scene()) > least(SSVI.scene()));
}

/// The samples of a formula set the steps of a flight while it lasts, and not those of the motion after it, from whenever on that is observed.
#[test]
fn exact_a_formula_sets_no_steps_once_it_is_over() {
    let form = Form::VersedSine(Finite::new(90.0).expect("finite"));
    let damped = TMD.under(made(Of::Force, form, 0.1, 1.0));
    for scene in [damped, Scene { damper: None, ..damped }] {
        let run =
            |from: f64| simulate(&scene, Window { from, to: 20.0 }, &Settings::default()).expect("a run");
        let least = least_steps(&scene, 20.0);
        let whole = run(0.0);
        for from in [0.0, 0.05, 0.1, 7.0] {
            let found = run(from);
            // A step is cut short where the window begins, and where the formula and the run end.
            let more = found.work.steps as f64 - least;
            assert!((0.0..4.0).contains(&more) && least < 3000.0, "{from}: {more} {least}");
            for (found, whole) in found.final_state.into_iter().zip(whole.final_state) {
                assert!((found - whole).abs() < 1e-15, "{from}: {found} {whole}");
            }
        }
    }
}
