//! The largest displacement, velocity and acceleration of the structure and its largest force on the ground, against closed forms
//! without contacts, and with contacts against samples of the motions of two methods.

use crate::problems::linear::golden;
use rayon::prelude::*;
use retune_model::{Bare, Coupled, Scene};
use retune_solver::{Extreme, Method, Rows, Settings, StructureMaxima, Window, simulate, trajectory};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TMD, TWO_SIDED};
use std::f64::consts::TAU;

fn maxima(scene: &Scene, window: Window, settings: &Settings) -> StructureMaxima {
    simulate(scene, window, settings).expect("a run").structure
}

/// `x1, v1, a1, k1 x1 + c1 v1` of a state, from equation (1).
fn of_state(scene: &Scene, t: f64, y: &[f64; 4]) -> [f64; 4] {
    let a1 = match &scene.damper {
        None => {
            let bare = Bare::new(&scene.primary, &scene.forcing);
            bare.derivative(bare.excitation(t), &[y[0], y[1]])[1]
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            system.derivative(system.excitation(t), y)[1]
        }
    };
    let [k1, c1] = [scene.primary.stiffness.get(), scene.primary.damping.get()];
    [y[0], y[1], a1, k1 * y[0] + c1 * y[1]]
}

/// A damper that touches nothing moves like a sine once its transient has died out, and so does the bare structure.
#[test]
fn exact_steady_sinusoids_have_their_amplitudes() {
    for omega in [2.0, 5.5, SSVI.omega, 9.0] {
        let numbers = Numbers { omega, d: 50.0, c: 50.0, ..TMD };
        // Whole numbers of a period and odd ones are the same: the maximum is located, not sampled.
        let window = Window { from: 300.0, to: 300.0 + 1.37 * TAU / omega };
        let bare = (numbers.bare_scene(), numbers.bare().steady(omega).x1.norm());
        let tmd = (numbers.scene(), numbers.coupled().steady(omega).x1.norm());
        for (scene, amplitude) in [bare, tmd] {
            let expected =
                [1.0, omega, omega * omega, numbers.k1.hypot(omega * numbers.c1)].map(|by| by * amplitude);
            for (method, allowed) in [(Method::Hybrid, 1e-11), (Method::Dop853, 1e-7)] {
                let settings = Settings { method, ..Settings::default() };
                let found = maxima(&scene, window, &settings).all();
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!((found.value / expected - 1.0).abs() < allowed, "{omega} {found:?} {expected}");
                    assert!((window.from..=window.to).contains(&found.time), "{found:?}");
                }
            }
        }
    }
}

/// From rest `x1 = Re(X e^{iωt} + B e^{λt})` with `λ = -c1/2m1 + iν`: its derivatives are those of two exponentials.
#[test]
fn exact_bare_structure_with_its_transient() {
    for omega in [1.0, 5.5, SSVI.omega, 40.0] {
        let numbers = Numbers { omega, ..SSVI };
        let scene = numbers.bare_scene();
        let (steady, beta) = (numbers.bare().steady(omega).x1, numbers.c1 / (2.0 * numbers.m1));
        let nu = (numbers.k1 / numbers.m1 - beta * beta).sqrt();
        // x1(0) = v1(0) = 0.
        let (b_re, v0) = (-steady.re, omega * steady.im);
        let b_im = -(v0 + beta * b_re) / nu;
        let free = |t: f64| {
            let (sin, cos) = (nu * t).sin_cos();
            let decay = (-beta * t).exp();
            [decay * (b_re * cos - b_im * sin), decay * (b_re * sin + b_im * cos)]
        };
        let all = |t: f64| -> [f64; 4] {
            let (sin, cos) = (omega * t).sin_cos();
            let forced = [steady.re * cos - steady.im * sin, steady.re * sin + steady.im * cos];
            let free = free(t);
            let turned = |[re, im]: [f64; 2]| [-beta * re - nu * im, nu * re - beta * im];
            let (once, twice) = (turned(free), turned(turned(free)));
            let x = forced[0] + free[0];
            let v = -omega * forced[1] + once[0];
            [x, v, -omega * omega * forced[0] + twice[0], numbers.k1 * x + numbers.c1 * v]
        };
        for to in [0.3, 13.7] {
            let found = maxima(&scene, Window { from: 0.0, to }, &Settings::default()).all();
            let (count, size) = ((to / 0.001) as usize, found.map(|largest| largest.value));
            let h = to / count as f64;
            for (i, found) in found.into_iter().enumerate() {
                let one = |t: f64| all(t)[i].abs();
                let near = (0..=count).map(|k| k as f64 * h).filter(|&t| one(t) > 0.99 * found.value);
                let expected =
                    near.map(|t| golden([(t - h).max(0.0), (t + h).min(to)], one).1).fold(0.0, f64::max);
                assert!((found.value - expected).abs() < 1e-10 * size[i], "{omega} {to} {i} {found:?}");
                assert!((one(found.time) - expected).abs() < 1e-8 * size[i], "{omega} {to} {i} {found:?}");
            }
        }
    }
}

/// Hit by a force that does not turn, an undamped structure swings about `P/k1`: `a1` is largest at t = 0, an end of the window.
#[test]
fn exact_a_largest_value_at_the_start_of_a_run() {
    let numbers = Numbers { omega: 0.0, c1: 0.0, ..SSVI };
    let found = maxima(&numbers.bare_scene(), Window { from: 0.0, to: 3.0 }, &Settings::default());
    let (still, natural) = (numbers.p / numbers.k1, (numbers.k1 / numbers.m1).sqrt());
    let expected = [2.0 * still, natural * still, numbers.p / numbers.m1, 2.0 * numbers.p];
    for (found, expected) in found.all().into_iter().zip(expected) {
        assert!((found.value / expected - 1.0).abs() < 1e-13, "{found:?} {expected}");
    }
    // The same height is reached again after every half swing.
    let swings = found.acceleration.time * natural / (0.5 * TAU);
    assert!((swings - swings.round()).abs() < 1e-6, "{swings}");
}

/// Scenes whose dampers strike one wall, or both, hard and often.
fn contact_scene(draw: &mut Spread) -> Numbers {
    let about = if draw.unit() < 0.5 { SSVI } else { TWO_SIDED };
    let mut near = |value: f64| value * (1.0 + 0.3 * draw.signed());
    Numbers {
        k1: near(about.k1),
        c1: near(about.c1),
        omega: near(about.omega),
        m2: near(2.0 * about.m2),
        k2: near(about.k2),
        c2: near(0.5 * about.c2),
        d: near(about.d),
        c: near(0.2),
        r: near(about.r),
        ..about
    }
}

/// What the samples of a motion say of the largest values: no largest value may be below a sample, nor so far above the largest one
/// that a parabola of twice the largest second difference does not reach it.
fn check_samples(scene: &Scene, window: Window, settings: &Settings, found: &StructureMaxima, what: &str) {
    let mut rows: Vec<[f64; 4]> = Vec::new();
    trajectory(scene, window, settings, Rows::every(2e-4), &mut |sample| {
        rows.push(of_state(scene, sample.t, &sample.state));
    })
    .expect("a run");
    for (i, Extreme { value, .. }) in found.all().into_iter().enumerate() {
        let largest = rows.iter().fold(0.0_f64, |largest, row| largest.max(row[i].abs()));
        let bends = rows.windows(3).map(|three| (three[0][i] - 2.0 * three[1][i] + three[2][i]).abs());
        let bend = bends.fold(0.0, f64::max);
        assert!(largest <= value * (1.0 + 1e-9), "{what} {i}: {value} below a sample {largest}");
        assert!(value <= largest + 0.25 * bend, "{what} {i}: {value} above {largest} by more than {bend}");
    }
}

#[test]
fn reference_no_largest_value_with_contacts_is_below_a_sample_or_far_above_all() {
    let window = Window { from: 0.0, to: 4.0 };
    let hits: Vec<u64> = (0..100_u64)
        .into_par_iter()
        .map(|number| {
            let numbers = contact_scene(&mut Spread::new(number + 77));
            let scene = numbers.scene();
            let of = |method, rtol| {
                let settings = Settings { method, rtol, atol: 1e-2 * rtol, ..Settings::default() };
                let run = simulate(&scene, window, &settings).expect("a run");
                check_samples(
                    &scene,
                    window,
                    &settings,
                    &run.structure,
                    &format!("{number} {method:?} {numbers:?}"),
                );
                run
            };
            let (hybrid, other) = (of(Method::Hybrid, 1e-12), of(Method::Dop853, 1e-12));
            of(Method::Hybrid, 1e-6);
            for (a, b) in hybrid.structure.all().into_iter().zip(other.structure.all()) {
                assert!((a.value / b.value - 1.0).abs() < 1e-7, "{number} {a:?} {b:?} {numbers:?}");
            }
            hybrid.impacts[0] + hybrid.impacts[1]
        })
        .collect();
    let striking = hits.iter().filter(|hits| **hits > 0).count();
    assert!(striking > 80 && hits.iter().sum::<u64>() > 300, "{striking}");
}

/// `E1 = (m1 v1² + k1 x1²)/2` bounds both speed and displacement, each is reached where the other energy is small, and a force on the
/// ground has at least the spring's.
#[test]
fn invariant_the_largest_motions_are_within_the_largest_energy() {
    for number in 0..60 {
        let numbers = contact_scene(&mut Spread::new(number + 7));
        let found =
            simulate(&numbers.scene(), Window { from: 2.0, to: 9.0 }, &Settings::default()).expect("a run");
        let StructureMaxima { displacement, velocity, ground_force, .. } = found.structure;
        let energy = found.e1_max.value * (1.0 + 1e-12);
        let spring = 0.5 * numbers.k1 * displacement.value.powi(2);
        let mass = 0.5 * numbers.m1 * velocity.value.powi(2);
        assert!(
            spring <= energy && mass <= energy && spring + mass >= found.e1_max.value,
            "{number} {found:?}"
        );
        // Where x1 is largest it is at rest, unless that is at an end of the window.
        if displacement.time > 2.0 && displacement.time < 9.0 {
            let least = numbers.k1 * displacement.value * (1.0 - 1e-9);
            assert!(ground_force.value >= least, "{number} {found:?}");
        }
    }
}

#[test]
fn contract_nothing_that_moves_has_largest_values_of_zero() {
    let still = Numbers { p: 0.0, ..SSVI };
    for scene in [still.scene(), still.bare_scene()] {
        let found = maxima(&scene, Window { from: 0.0, to: 5.0 }, &Settings::default());
        assert_eq!(found.all().map(|largest| largest.value), [0.0; 4]);
    }
}
