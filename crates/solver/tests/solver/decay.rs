//! When a motion has decayed.

use crate::forcings::decay;
use retune_model::{Finite, Measure, Of, PerMeasure, Scene, Shape, Start};
use retune_solver::{
    Also, Ask, LEFT, Method, Moment, Rows, Settings, Window, decay_time, e1_max, extremes, last_above,
    trajectory,
};
use retune_testkit::histories::{noise, pulse};
use retune_testkit::scenes::{LOSSY, Numbers, RESTORING, SSVI, Spread, TMD, TWO_SIDED};

fn time(scene: &Scene, to: f64) -> Option<f64> {
    decay_time(scene, to, &Settings::default()).expect("a run")
}

/// Maxima of E1 in a window, each with its time.
fn maxima(scene: &Scene, window: Window) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    let rows = Rows { interval: 1.0, events: true };
    trajectory(scene, window, &Settings::default(), rows, &mut |sample| {
        if sample.moment == Moment::EnergyMax {
            found.push((sample.t, sample.e1));
        }
    })
    .expect("a run");
    found
}

/// A structure that is let go: `E1 = E0 e^(-2δt) (1 + (δ/β) sin 2βt + 2 (δ/β)² sin² βt)`, after a displacement.
#[test]
fn exact_a_structure_that_is_let_go() {
    let start = Start { x1: Finite::new(0.1).expect("a number"), ..Start::default() };
    for c1 in [300.0, 3000.0] {
        let numbers = Numbers { c1, ..SSVI };
        let scene = Scene { damper: None, ..decay(numbers, start) };
        let delta = 0.5 * c1 / numbers.m1;
        let beta = (numbers.k1 / numbers.m1 - delta * delta).sqrt();
        let share = |t: f64| {
            let (ratio, sin) = (delta / beta, (beta * t).sin());
            (-2.0 * delta * t).exp() * (1.0 + ratio * (2.0 * beta * t).sin() + 2.0 * (ratio * sin).powi(2))
        };
        let found = time(&scene, 40.0).expect("a time");
        assert!((share(found) / LEFT - 1.0).abs() < 1e-12, "{found} {}", share(found));
        for i in 1..20_000 {
            let later = found + 1e-3 * f64::from(i);
            assert!(share(later) < LEFT, "{later}");
        }
    }
}

/// Among largest values the decay time is that of the whole run, whatever the window, and changes none of them.
#[test]
fn exact_a_decay_time_beside_largest_values() {
    let settings = Settings::default();
    let (early, late) = (Window { from: 0.0, to: 3.0 }, Window { from: 9.0, to: 15.0 });
    let damped = SSVI.under(pulse(Of::Force, Shape::HalfSine, 9000.0, 0.4));
    for scene in [damped, Scene { damper: None, ..damped }] {
        let own = time(&scene, late.to).expect("a time");
        assert!(own > early.to && own < late.to, "{own}");
        let ask = |window, measure, also: &[Measure]| {
            let measures: PerMeasure<bool> = also.iter().copied().collect();
            let also = (!also.is_empty()).then_some(Also { measures, from: 1.0 });
            extremes(&scene, window, &settings, Ask { measure, also, ..Ask::default() }).expect("a run")
        };
        let (decay, stroke) = (Measure::DecayTime, Measure::Stroke);
        let plain = ask(late, Measure::Displacement, &[stroke]);
        let beside = ask(late, Measure::Displacement, &[stroke, decay]);
        assert_eq!((beside.largest, beside.reached.get(stroke)), (plain.largest, plain.reached.get(stroke)));
        assert_eq!([beside.reached.get(decay), ask(late, decay, &[]).largest.value], [own; 2]);
        let first = ask(late, decay, &[stroke]);
        assert_eq!([first.largest.value, first.reached.get(stroke)], [own, plain.reached.get(stroke)]);
        assert_eq!((first.reached.get(decay), plain.reached.get(decay)), (0.0, 0.0));
        let never = ask(early, decay, &[decay]);
        assert_eq!([never.largest.value, never.reached.get(decay)], [f64::INFINITY; 2]);
    }
}

/// Levels next below and above each maximum of the energy: only the first of both is exceeded there. Of every kind of segment and pulse.
#[test]
fn exact_a_maximum_that_just_exceeds_a_level_is_found() {
    let mut spread = Spread::new(5);
    let (mut count, window) = (0, Window { from: 0.5, to: 8.0 });
    for numbers in [SSVI, TMD, TWO_SIDED, LOSSY, RESTORING, Numbers { rigid: Some(0.6), ..TWO_SIDED }] {
        for history in [
            pulse(Of::Force, Shape::HalfSine, 9000.0, 0.4),
            pulse(Of::BaseAcceleration, Shape::Rectangle, 8.0, 0.5),
            noise(Of::Force, 5000.0, (0.05, 10, true), &mut spread),
        ] {
            let damped = numbers.under(history);
            for scene in [damped, Scene { damper: None, ..damped }] {
                let all = maxima(&scene, window);
                for (i, &(at, most)) in all.iter().enumerate() {
                    // Others that are as high come later.
                    if all[i + 1..].iter().any(|(_, other)| *other > most * (1.0 - 1e-6)) {
                        continue;
                    }
                    let last = |share: f64| {
                        last_above(&scene, most * share, window, &Settings::default()).expect("a run")
                    };
                    let [under, over] = [1.0 - 1e-10, 1.0 + 1e-10].map(last);
                    // Impacts between rigid walls raise the energy at once.
                    let near = (under - at).abs() < 1e-3;
                    assert!(near && over < at, "{at}: {under} {over} {history:?} {numbers:?}");
                    count += 1;
                }
            }
        }
    }
    assert!(count > 100, "{count}");
}

/// Rows of the motion on both sides of the time, and another method.
#[test]
fn reference_the_decay_time_is_that_of_rows_and_of_dop853() {
    let exact = Settings { method: Method::Dop853, rtol: 1e-12, atol: 1e-14, ..Settings::default() };
    for numbers in [SSVI, TMD, TWO_SIDED, LOSSY] {
        for (of, size) in [(Of::Force, 4000.0), (Of::BaseAcceleration, 4.0)] {
            let scene = numbers.under(pulse(of, Shape::HalfSine, size, 0.3));
            let window = Window { from: 0.0, to: 30.0 };
            let found = time(&scene, window.to).expect("a time");
            let level =
                LEFT * e1_max(&scene, window, &Settings::default(), f64::INFINITY).expect("a run").value;
            let mut last = 0.0;
            trajectory(&scene, window, &Settings::default(), Rows::every(1e-4), &mut |sample| {
                if sample.e1 > level {
                    last = sample.t;
                }
            })
            .expect("a run");
            assert!((0.0..=1.01e-4).contains(&(found + 0.3 - last)), "{found} {last} {numbers:?}");
            let other = decay_time(&scene, window.to, &exact).expect("a run").expect("a time");
            assert!((found - other).abs() < 1e-6, "{found} {other} {numbers:?}");
        }
    }
}

#[test]
fn contract_a_motion_without_an_end_of_its_forcing_has_no_decay_time() {
    let pushed = SSVI.under(pulse(Of::Force, Shape::HalfSine, 900.0, 0.3));
    assert_eq!(time(&SSVI.scene(), 20.0), None);
    assert_eq!(time(&pushed, 0.3), None);
    assert_eq!(time(&pushed, 0.31), Some(f64::INFINITY));
    let undamped = Scene {
        damper: None,
        ..Numbers { c1: 0.0, ..SSVI }.under(*pushed.forcing.history().expect("a pulse"))
    };
    assert_eq!(time(&undamped, 20.0), Some(f64::INFINITY));
    let nothing = SSVI.under(pulse(Of::Force, Shape::HalfSine, 0.0, 0.3));
    assert_eq!(time(&nothing, 20.0), Some(0.0));
}
