//! Runs against closed forms and against an independent matrix exponential; windows, samples and cutoffs against each other.

use crate::problems::linear::{golden, joined};
use crate::problems::{assert_close, assert_states};
use retune_model::{Coupled, Scene};
use retune_solver::{
    Method, Response, Rows, Sample, SceneKind, Settings, Window, e1_max, simulate, trajectory,
};
use retune_testkit::scenes::{Numbers, ROW3, SSVI, Spread, TMD, TWO_SIDED};
use std::f64::consts::TAU;

const INFINITY: f64 = f64::INFINITY;

fn run(scene: &Scene, from: f64, to: f64) -> Response {
    simulate(scene, Window { from, to }, &Settings::default()).expect("a run")
}

fn samples(scene: &Scene, from: f64, to: f64, interval: f64) -> Vec<Sample> {
    let mut all = Vec::new();
    trajectory(scene, Window { from, to }, &Settings::default(), Rows::every(interval), &mut |s| {
        all.push(*s)
    })
    .expect("a run");
    all
}

/// Nothing holds the structure, nothing holds the damper: `x1 = P (1 - cos ωt) / m1 ω²`, and the damper stays.
#[test]
fn exact_free_flight() {
    let numbers = Numbers { c1: 0.0, k1: 0.0, k2: 0.0, c2: 0.0, d: 0.5, c: 1.0, ..SSVI };
    for t in [0.01, 1.0, 7.3, 100.0] {
        let found = run(&numbers.scene(), 0.0, t);
        let (sin, cos) = (numbers.omega * t).sin_cos();
        let (x, v) = (numbers.p / numbers.m1 / numbers.omega.powi(2), numbers.p / numbers.m1 / numbers.omega);
        let expected = [x * (1.0 - cos), v * sin, numbers.d, 0.0];
        assert_states(found.final_state, expected, [x, v], 1e-12, &format!("t = {t}"));
        assert_eq!(found.scene, SceneKind::Linear);
    }
}

/// `x = X cos(ωt - φ) + e^{-βt} (A cos νt + B sin νt)` and its velocity.
fn bare_closed_form(n: &Numbers, t: f64) -> [f64; 2] {
    let (re, im) = (n.k1 - n.m1 * n.omega * n.omega, n.omega * n.c1);
    let (amplitude, phase) = (n.p / re.hypot(im), im.atan2(re));
    let beta = n.c1 / (2.0 * n.m1);
    let nu = (n.k1 / n.m1 - beta * beta).sqrt();
    let a = -amplitude * phase.cos();
    let b = (beta * a - amplitude * n.omega * phase.sin()) / nu;
    let ((sin, cos), decay) = ((nu * t).sin_cos(), (-beta * t).exp());
    let (sin_w, cos_w) = (n.omega * t - phase).sin_cos();
    [
        amplitude * cos_w + decay * (a * cos + b * sin),
        -amplitude * n.omega * sin_w + decay * ((b * nu - beta * a) * cos - (a * nu + beta * b) * sin),
    ]
}

#[test]
fn exact_bare_structure_with_its_transient() {
    for omega in [1.0, 5.5, SSVI.omega, 6.6, 40.0] {
        let numbers = Numbers { omega, ..SSVI };
        let energy = |t: f64| {
            let [x, v] = bare_closed_form(&numbers, t);
            0.5 * (numbers.m1 * v * v + numbers.k1 * x * x)
        };
        for to in [0.3, 13.7, 100.0] {
            let found = run(&numbers.bare_scene(), 0.0, to);
            let [x, v] = bare_closed_form(&numbers, to);
            let size = (2.0 * found.e1_max.value / numbers.k1).sqrt();
            let expected = [x, v, 0.0, 0.0];
            assert_states(
                found.final_state,
                expected,
                [size, SSVI.omega * size],
                1e-11,
                &format!("ω = {omega}"),
            );
            assert_eq!(found.scene, SceneKind::Bare);
            // The largest of the closed form: sampled, and refined about the best samples.
            let n = (to / 0.005) as usize;
            let h = to / n as f64;
            let expected = (0..=n)
                .map(|k| k as f64 * h)
                .filter(|&t| energy(t) > 0.99 * found.e1_max.value)
                .map(|t| golden([(t - h).max(0.0), (t + h).min(to)], energy).1)
                .fold(0.0, f64::max);
            assert_close(
                found.e1_max.value,
                expected,
                expected,
                1e-11,
                &format!("E1max, ω = {omega}, T = {to}"),
            );
            assert_close(energy(found.e1_max.time), expected, expected, 1e-11, "at its time");
        }
    }
}

#[test]
fn reference_bare_structure_by_the_other_methods() {
    let expected = run(&SSVI.bare_scene(), 0.0, 20.0);
    for (method, rtol, allowed) in [(Method::Ode45, 1e-11, 1e-8), (Method::Ode23s, 1e-7, 1e-4)] {
        let settings = Settings { method, rtol, atol: 1e-2 * rtol, ..Settings::default() };
        let found = simulate(&SSVI.bare_scene(), Window { from: 0.0, to: 20.0 }, &settings).expect("a run");
        assert_states(found.final_state, expected.final_state, [0.2, 1.2], allowed, &format!("{method:?}"));
        assert_close(found.e1_max.value, expected.e1_max.value, 1500.0, allowed, &format!("{method:?}"));
    }
}

/// An undamped structure driven at its own frequency: `x = P t sin(ωt) / (2 m1 ω)`, for ever.
#[test]
fn exact_undamped_resonance() {
    let omega = SSVI.omega;
    let k1 = SSVI.m1 * omega * omega;
    let numbers = Numbers { c1: 0.0, k1, ..SSVI };
    let slope = numbers.p / (2.0 * numbers.m1 * omega);
    for t in [1.0, 33.3, 100.0, 1000.0] {
        let found = run(&numbers.bare_scene(), 0.0, t);
        let (sin, cos) = (omega * t).sin_cos();
        let expected = [slope * t * sin, slope * (sin + omega * t * cos), 0.0, 0.0];
        assert_states(
            found.final_state,
            expected,
            [slope * t, slope * omega * t],
            1e-11,
            &format!("t = {t}"),
        );
    }
}

#[test]
fn exact_linear_damper_against_the_matrix_exponential() {
    let fast = Numbers { k2: 6e4, c2: 2e3, d: 20.0, c: 20.0, ..TMD };
    // Near critical damping, where eigenvectors are nearly parallel, and at it.
    let near = Numbers { c2: 2.0 * (600.0_f64 * 60.0).sqrt() * (1.0 + 1e-9), ..TMD };
    let critical = Numbers { c1: 0.0, k1: 0.0, c2: 240.0, k2: 240.0, omega: 3.0, d: 9.0, c: 9.0, ..TMD };
    for numbers in [TMD, fast, near, critical, Numbers { omega: 5.5, k2: 2083.2, c2: 111.76, ..TMD }] {
        let exact = joined(&numbers);
        let rest = numbers.coupled().rest();
        for [from, to] in [[0.0, 3.3], [0.0, 60.0], [20.0, 60.0]] {
            let found = run(&numbers.scene(), from, to);
            assert_eq!(found.scene, SceneKind::Linear, "{numbers:?}");
            let energy = |y: &[f64; 4]| 0.5 * (numbers.m1 * y[1] * y[1] + numbers.k1 * y[0] * y[0]);
            let (expected, _) = exact.largest(rest, [from, to], energy);
            assert_close(found.e1_max.value, expected, expected, 1e-10, &format!("E1max {numbers:?}"));
            let (expected, _) = exact.largest(rest, [from, to], |y| {
                0.5 * (numbers.m2 * y[3] * y[3] + numbers.k2 * (y[2] - numbers.d).powi(2))
            });
            assert_close(found.e2_max.value, expected, expected, 1e-10, &format!("E2max {numbers:?}"));
            let (expected, _) = exact.largest(rest, [from, to], |y| (y[2] - y[0]).abs());
            assert_close(
                found.relative_displacement_max,
                expected,
                expected,
                1e-10,
                &format!("displacement {numbers:?}"),
            );
            let n = (to / 0.1).round() as usize;
            let expected = exact.grid(0.0, rest, to / n as f64, n)[n];
            assert_states(found.final_state, expected, [0.2, 1.0], 1e-11, &format!("{numbers:?}"));
            assert_eq!((found.impacts, found.force_max), ([0, 0], [0.0, 0.0]));
        }
    }
}

#[test]
fn exact_late_windows_are_the_steady_response() {
    let found = run(&TMD.scene(), 90.0, 110.0);
    let steady = TMD.coupled().steady(TMD.omega);
    assert_close(found.e1_max.value, steady.e1_max, steady.e1_max, 1e-11, "E1max of the TMD");
    assert_close(found.e2_max.value, steady.e2_max, steady.e2_max, 1e-11, "E2max of the TMD");
    let found = run(&SSVI.bare_scene(), 150.0, 160.0);
    let steady = SSVI.bare().steady(SSVI.omega);
    assert_close(found.e1_max.value, steady.e1_max, steady.e1_max, 1e-11, "E1max of the bare structure");
}

/// A run and the same run looked at in two windows see the same things.
#[test]
fn invariant_windows_join() {
    for numbers in [TMD, ROW3, SSVI, TWO_SIDED] {
        let whole = run(&numbers.scene(), 0.0, 20.0);
        for cut in [TAU / numbers.omega, 7.77, 19.99] {
            let (before, after) = (run(&numbers.scene(), 0.0, cut), run(&numbers.scene(), cut, 20.0));
            let larger = |f: &dyn Fn(&Response) -> f64| f(&before).max(f(&after));
            let what = format!("{cut} {numbers:?}");
            assert_close(larger(&|r| r.e1_max.value), whole.e1_max.value, whole.e1_max.value, 1e-8, &what);
            assert_close(larger(&|r| r.e2_max.value), whole.e2_max.value, whole.e2_max.value, 1e-8, &what);
            assert_close(
                larger(&|r| r.relative_displacement_max),
                whole.relative_displacement_max,
                whole.relative_displacement_max,
                1e-8,
                &what,
            );
            for side in [0, 1] {
                let force = larger(&|r| r.force_max[side]);
                assert_close(force, whole.force_max[side], whole.force_max[side] + 1.0, 1e-7, &what);
                assert_eq!(before.impacts[side] + after.impacts[side], whole.impacts[side], "{what}");
            }
            assert_states(after.final_state, whole.final_state, [0.1, 1.0], 1e-7, &what);
            assert_eq!(after.scene, whole.scene, "{what}");
        }
    }
}

#[test]
fn contract_empty_window() {
    for scene in [SSVI.scene(), TMD.scene(), SSVI.bare_scene()] {
        let found = run(&scene, 0.0, 0.0);
        assert_eq!((found.impacts, found.final_state[..2].to_vec()), ([0, 0], vec![0.0, 0.0]));
        let start = run(&scene, 5.0, 5.0);
        let end = run(&scene, 0.0, 5.0);
        assert_states(start.final_state, end.final_state, [0.1, 1.0], 1e-9, "the state at 5 s");
    }
}

/// Samples are the motion: each is where a run that ends there ends, in flight and in contact.
#[test]
fn invariant_samples_are_the_motion() {
    for numbers in [TMD, ROW3, TWO_SIDED] {
        let system: Coupled = numbers.coupled();
        let all = samples(&numbers.scene(), 0.0, 12.0, 0.01);
        assert_eq!(all.len(), 1201);
        let pressed: Vec<&Sample> = all.iter().filter(|s| s.forces != [0.0; 2]).collect();
        assert_eq!(pressed.is_empty(), numbers.d == TMD.d);
        for sample in all.iter().step_by(100).chain(pressed.iter().step_by(7).copied()) {
            let end = run(&numbers.scene(), 0.0, sample.t);
            assert_states(sample.state, end.final_state, [0.1, 1.0], 1e-8, &format!("t = {}", sample.t));
            assert_eq!(sample.e1, system.bare().primary_energy(sample.state[0], sample.state[1]));
            assert_eq!(sample.forces, system.contact_forces(&sample.state));
        }
        for (k, sample) in all.iter().enumerate() {
            assert_eq!(sample.t, k as f64 * 0.01, "the times are counted, not accumulated");
        }
        let late = samples(&numbers.scene(), 6.0, 12.0, 0.01);
        assert_eq!(late.len(), 601);
        for (a, b) in late.iter().zip(&all[600..]) {
            assert_states(a.state, b.state, [0.1, 1.0], 1e-8, &format!("t = {}", a.t));
        }
    }
    let bare = samples(&SSVI.bare_scene(), 0.0, 12.0, 0.01);
    for s in &bare {
        let [x, v] = bare_closed_form(&SSVI, s.t);
        assert_states(s.state, [x, v, 0.0, 0.0], [0.2, 1.2], 1e-12, "bare");
    }
}

/// No maximum is missed: none of many samples exceeds it, and the largest of them comes close.
#[test]
fn invariant_maxima_are_maxima_of_the_motion() {
    let mut spread = Spread::new(8);
    let mut in_contact = 0;
    for case in 0..24 {
        let numbers = Numbers {
            k1: spread.logarithmic(2e4, 6e4),
            omega: spread.logarithmic(4.0, 9.0),
            m2: spread.logarithmic(10.0, 300.0),
            k2: spread.logarithmic(50.0, 3000.0),
            c2: spread.logarithmic(20.0, 600.0),
            d: if case % 8 == 0 { 0.0 } else { 0.15 * spread.unit() },
            c: 0.3 * spread.unit(),
            r: spread.logarithmic(1e-6, 10.0),
            ..SSVI
        };
        let (from, to) = (4.0 * f64::from(case % 2), 8.0);
        let found = run(&numbers.scene(), from, to);
        let all = samples(&numbers.scene(), from, to, 1e-4);
        let largest = |f: &dyn Fn(&Sample) -> f64| all.iter().map(f).fold(-INFINITY, f64::max);
        for (what, found, sampled, slack) in [
            ("E1", found.e1_max.value, largest(&|s| s.e1), 2e-6),
            ("E2", found.e2_max.value, largest(&|s| s.e2), 2e-4),
            (
                "relative displacement",
                found.relative_displacement_max,
                largest(&|s| (s.state[2] - s.state[0]).abs()),
                1e-5,
            ),
            ("force on the structure", found.force_max[0], largest(&|s| s.forces[0]), 1e-2),
            ("force on the obstacle", found.force_max[1], largest(&|s| s.forces[1]), 1e-2),
        ] {
            assert!(sampled <= found * (1.0 + 1e-11) + 1e-12, "{what} missed: {found} {sampled} {numbers:?}");
            assert!(
                sampled >= found * (1.0 - slack) - 1e-3,
                "{what} not reached: {found} {sampled} {numbers:?}"
            );
        }
        let at =
            e1_max(&numbers.scene(), Window { from, to }, &Settings::default(), INFINITY).expect("a run");
        assert_close(at.value, found.e1_max.value, at.value, 1e-12, "both ways of asking");
        let state = run(&numbers.scene(), 0.0, at.time).final_state;
        let there = numbers.bare().primary_energy(state[0], state[1]);
        assert_close(there, at.value, at.value, 1e-8, &format!("E1 at its time {} {numbers:?}", at.time));
        in_contact += u32::from(numbers.coupled().contact_forces(&state) != [0.0; 2]);
    }
    assert!(in_contact >= 3, "some maxima lie inside contacts: {in_contact}");
}

/// With a cutoff the answer is the exact maximum, or a value above the cutoff.
#[test]
fn contract_a_cutoff_gives_the_maximum_or_a_value_above_it() {
    for (scene, method) in [
        (SSVI.scene(), Method::Hybrid),
        (TMD.scene(), Method::Hybrid),
        (SSVI.bare_scene(), Method::Hybrid),
        (TWO_SIDED.scene(), Method::Hybrid),
        (SSVI.scene(), Method::Ode45),
        (TMD.scene(), Method::Ode23s),
    ] {
        let settings = Settings { method, rtol: 1e-8, atol: 1e-10, ..Settings::default() };
        for from in [0.0, 6.0] {
            let window = Window { from, to: 12.0 };
            let exact = e1_max(&scene, window, &settings, INFINITY).expect("a run").value;
            for factor in [0.0, 0.1, 0.5, 0.9, 0.999_999, 1.0, 1.000_001, 2.0] {
                let cutoff = factor * exact;
                let found = e1_max(&scene, window, &settings, cutoff).expect("a run");
                assert!(found.value <= exact && found.time >= from && found.time <= 12.0);
                if factor < 1.0 {
                    assert!(found.value > cutoff, "{method:?} {factor}: {found:?} {exact}");
                } else {
                    assert_eq!(found.value, exact, "{method:?} {factor}");
                }
            }
        }
    }
}

/// Nothing moves without a force, whatever rests on what.
#[test]
fn exact_nothing_moves_without_force() {
    for numbers in [
        Numbers { p: 0.0, ..SSVI },
        Numbers { p: 0.0, d: 0.0, ..SSVI },
        Numbers { p: 0.0, c: 0.0, ..SSVI },
        Numbers { p: 0.0, d: 0.0, c: 0.0, ..SSVI },
    ] {
        let found = run(&numbers.scene(), 0.0, 10.0);
        assert_eq!(found.e1_max.value, 0.0);
        assert_eq!((found.impacts, found.final_state), ([0, 0], [0.0, 0.0, numbers.d, 0.0]), "{numbers:?}");
    }
}
