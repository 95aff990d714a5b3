//! What moves the structure beside a force: a rotating imbalance, a moving base, a start away from rest. Closed forms without contacts,
//! other methods and samples with them.

use retune_model::{Amplitude, Bare, Coupled, Finite, Forcing, Measure, NonNegative, Scene, Source, Start};
use retune_solver::{
    Also, Ask, Extremes, Method, Rows, Settings, Window, e1_max, extremes, simulate, trajectory,
};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TMD};
use std::f64::consts::PI;

fn asked(scene: &Scene, window: Window, measure: Measure, method: Method, phase: f64) -> Extremes {
    let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
    extremes(scene, window, &settings, Ask { measure, phase, ..Ask::default() }).expect("a run")
}

/// `m1 a1 + c1 (v1 - dy/dt) + k1 (x1 - y) = 0` with `y = Y cos(ωt + φ)`, at any moment.
#[test]
fn exact_a_moving_base_pulls_by_spring_and_dashpot() {
    let numbers = Numbers { p: 0.02, ..SSVI };
    let Scene { primary, forcing, .. } = numbers.forced_by(Amplitude::Base);
    let mut spread = Spread::new(7);
    for _ in 0..100 {
        let (t, phase) = (10.0 * spread.unit(), 2.0 * PI * spread.unit());
        let [x1, v1] = [spread.signed(), spread.signed()];
        let bare = Bare::new(&primary, &forcing).with_phase(phase);
        let [_, a1] = bare.derivative(bare.excitation(t), &[x1, v1]);
        let (sin, cos) = (numbers.omega * t + phase).sin_cos();
        let (y, rate) = (numbers.p * cos, -numbers.p * numbers.omega * sin);
        let rest = numbers.m1 * a1 + numbers.c1 * (v1 - rate) + numbers.k1 * (x1 - y);
        assert!(rest.abs() < 1e-10 * numbers.k1, "{rest}");
    }
}

/// A rotating imbalance is a force of m e ω².
#[test]
fn exact_an_imbalance_is_a_force() {
    let numbers = Numbers { p: 20.0, ..SSVI };
    let force = Numbers { p: 20.0 * SSVI.omega * SSVI.omega, ..SSVI }.scene();
    let window = Window { from: 5.0, to: 30.0 };
    let [turned, forced] = [numbers.forced_by(Amplitude::Imbalance), force]
        .map(|scene| simulate(&scene, window, &Settings::default()).expect("a run"));
    assert_eq!(turned, forced);
}

/// A base of constant acceleration moves by a / ω².
#[test]
fn exact_an_accelerated_base_is_a_moving_base() {
    let accelerated =
        Numbers { p: 0.02 * SSVI.omega * SSVI.omega, ..SSVI }.forced_by(Amplitude::BaseAcceleration);
    let moving = Numbers { p: 0.02, ..SSVI }.forced_by(Amplitude::Base);
    let window = Window { from: 5.0, to: 30.0 };
    let [a, b] =
        [accelerated, moving].map(|scene| simulate(&scene, window, &Settings::default()).expect("a run"));
    let [a, b] = [a, b].map(|run| run.e1_max.value);
    assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    let mut still = accelerated;
    still.forcing.frequency = NonNegative::default();
    assert!(simulate(&still, window, &Settings::default()).is_err(), "it moves without a bound at ω = 0");
}

/// Late in a run without contacts every quantity is that of the closed form, with a damper and without.
#[test]
fn exact_late_motions_are_steady() {
    let late = Window { from: 900.0, to: 1000.0 };
    for (amplitude, p) in
        [(Amplitude::Imbalance, 5.0), (Amplitude::Base, 0.01), (Amplitude::BaseAcceleration, 0.4)]
    {
        let numbers = Numbers { p, ..TMD };
        let with = numbers.forced_by(amplitude);
        for scene in [with, Scene { damper: None, ..with }] {
            let bare = Bare::new(&scene.primary, &scene.forcing);
            let steady = match &scene.damper {
                None => bare.steady(TMD.omega),
                Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).steady(TMD.omega),
            };
            for measure in Measure::ALL {
                let expected = steady.largest(&bare, TMD.omega, measure);
                for (method, phase) in [(Method::Hybrid, 0.0), (Method::Hybrid, 1.0), (Method::Dop853, 0.3)] {
                    let found = asked(&scene, late, measure, method, phase).largest.value;
                    let most = if method == Method::Hybrid { 1e-9 } else { 1e-6 };
                    assert!((found - expected).abs() <= most * expected, "{measure:?} {found} {expected}");
                }
            }
        }
    }
}

/// The force on a moving ground is `k1 (x1 - y) + c1 (v1 - dy/dt)`: its maximum is that of samples, and never less.
#[test]
fn invariant_no_sample_of_the_force_on_a_moving_ground_is_above_its_maximum() {
    let mut spread = Spread::new(3);
    let (window, mut touched) = (Window { from: 1.0, to: 12.0 }, 0);
    for _ in 0..60 {
        let numbers = Numbers {
            p: spread.logarithmic(0.002, 0.1),
            omega: spread.logarithmic(3.0, 12.0),
            k2: spread.logarithmic(50.0, 3000.0),
            d: 0.2 * spread.unit(),
            c: 0.3 * spread.unit(),
            ..SSVI
        };
        let scene = numbers.forced_by(Amplitude::Base);
        let found = asked(&scene, window, Measure::GroundForce, Method::Hybrid, 0.0).largest.value;
        let mut largest = 0.0_f64;
        let settings = Settings { rtol: 1e-9, ..Settings::default() };
        trajectory(&scene, window, &settings, Rows::every(1e-4), &mut |row| {
            let (sin, cos) = (numbers.omega * row.t).sin_cos();
            let (y, rate) = (numbers.p * cos, -numbers.p * numbers.omega * sin);
            let force = numbers.k1 * (row.state[0] - y) + numbers.c1 * (row.state[1] - rate);
            largest = largest.max(force.abs());
        })
        .expect("a run");
        assert!(largest <= found * (1.0 + 1e-9) && largest > found * (1.0 - 1e-4), "{largest} {found}");
        let run = simulate(&scene, window, &settings).expect("a run");
        assert_eq!(run.structure.ground_force.value, found);
        touched += usize::from(run.impacts != [0; 2]);
    }
    assert!(touched > 20, "{touched}");
}

pub(crate) fn decay(numbers: Numbers, start: Start) -> Scene {
    let forcing = Forcing { source: Source::Decay(start), frequency: NonNegative::default(), start: None };
    Scene { forcing, ..numbers.scene() }
}

fn number(value: f64) -> Finite {
    Finite::new(value).expect("a number")
}

/// Without a damper `x1 = e^(-δt) (x cos βt + (v + δx)/β sin βt)`.
#[test]
fn exact_a_free_decay_without_a_damper() {
    let start = Start { x1: number(0.3), v1: number(-0.4), ..Start::default() };
    let scene = Scene { damper: None, ..decay(SSVI, start) };
    let delta = 0.5 * SSVI.c1 / SSVI.m1;
    let beta = (SSVI.k1 / SSVI.m1 - delta * delta).sqrt();
    let end = 7.0;
    let run = simulate(&scene, Window { from: 2.0, to: end }, &Settings::default()).expect("a run");
    let (sin, cos) = (beta * end).sin_cos();
    let weight = (-0.4 + delta * 0.3) / beta;
    let x1 = (-delta * end).exp() * (0.3 * cos + weight * sin);
    assert!((run.final_state[0] - x1).abs() < 1e-14, "{} {x1}", run.final_state[0]);
    let mut largest = 0.0_f64;
    for i in 0..=500_000 {
        let t = 2.0 + 1e-5 * f64::from(i);
        let (sin, cos) = (beta * t).sin_cos();
        largest = largest.max((-delta * t).exp() * (0.3 * cos + weight * sin).abs());
    }
    let found = run.structure.displacement.value;
    assert!(largest <= found * (1.0 + 1e-14) && largest > found * (1.0 - 1e-8), "{largest} {found}");
}

/// A run that begins where another one is after some periods of the force goes on as that one does, with walls and without.
#[test]
fn exact_a_run_from_a_state_of_another_goes_on_as_that_one() {
    let period = std::f64::consts::TAU / SSVI.omega;
    for damper in [true, false] {
        let mut scene = SSVI.scene();
        scene.damper = scene.damper.filter(|_| damper);
        let run = |scene: &Scene, [from, to]: [f64; 2]| {
            simulate(scene, Window { from: from * period, to: to * period }, &Settings::default())
                .expect("a run")
        };
        let before = run(&scene, [0.0, 3.0]);
        let whole = run(&scene, [4.0, 6.0]);
        let [x1, v1, x2, v2] = before.final_state.map(number);
        scene.forcing.start = Some(Start { x1, v1, x2: Some(x2), v2 });
        let later = run(&scene, [1.0, 3.0]);
        assert_eq!(whole.impacts, later.impacts);
        for (a, b) in [
            (whole.e1_max.value, later.e1_max.value),
            (whole.relative_displacement_max, later.relative_displacement_max),
            (whole.structure.acceleration.value, later.structure.acceleration.value),
        ] {
            assert!((a / b - 1.0).abs() < 1e-9 || a == b, "{a} {b}");
        }
        let asked =
            extremes(&scene, Window { from: period, to: 3.0 * period }, &Settings::default(), Ask::default());
        assert!((asked.expect("a run").largest.value / later.e1_max.value - 1.0).abs() < 1e-12);
    }
}

/// The start of a free decay is all its energy; with contacts and with a start inside a wall, by two methods.
#[test]
fn reference_a_free_decay_with_contacts_is_the_same_by_another_method() {
    for start in [
        Start { x1: number(0.3), ..Start::default() },
        Start { v1: number(2.0), ..Start::default() },
        Start { v1: number(1.0), x2: Some(number(0.5)), v2: number(-1.0), ..Start::default() },
        // At the structure, and moving into it.
        Start { x2: Some(number(0.0)), v2: number(-1.0), ..Start::default() },
        // Half a millimetre inside the structure.
        Start { x2: Some(number(-5e-4)), ..Start::default() },
    ] {
        let scene = decay(SSVI, start);
        let all = Window { from: 0.0, to: 8.0 };
        let run = simulate(&scene, all, &Settings::default()).expect("a run");
        assert!(run.force_max[0] > 0.0, "{run:?}");
        let damper = scene.damper.expect("a damper");
        let system = Coupled::new(&scene.primary, &scene.forcing, &damper);
        assert!(run.e1_max.value <= system.most_energy(8.0) * (1.0 + 1e-12));
        let late = Window { from: 1.0, to: 8.0 };
        let settings = |method| Settings { method, rtol: 1e-12, atol: 1e-14, ..Settings::default() };
        let [one, other] = [Method::Hybrid, Method::Dop853]
            .map(|method| e1_max(&scene, late, &settings(method), f64::INFINITY).expect("a run").value);
        assert!((one / other - 1.0).abs() < 1e-8, "{start:?} {one} {other}");
    }
}

/// A damper without walls is one whose walls are out of reach, whatever is measured and by whatever method.
#[test]
fn exact_a_damper_without_walls_is_one_that_never_touches() {
    let far = Numbers { d: 64.0, c: 64.0, ..TMD };
    let window = Window { from: 3.0, to: 40.0 };
    for omega in [2.0, TMD.omega, 9.0] {
        let [open, walled] = [Numbers { omega, ..far }.open_scene(), Numbers { omega, ..far }.scene()];
        for method in [Method::Hybrid, Method::Ode45] {
            let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
            let [a, b] = [open, walled].map(|scene| simulate(&scene, window, &settings).expect("a run"));
            let most = if method == Method::Hybrid { 1e-12 } else { 1e-6 };
            for (a, b) in [
                (a.e1_max.value, b.e1_max.value),
                (a.spring_deflection_max, b.spring_deflection_max),
                (a.structure.ground_force.value, b.structure.ground_force.value),
            ] {
                assert!((a / b - 1.0).abs() < most, "{omega} {method:?} {a} {b}");
            }
            assert_eq!((a.force_max, a.impacts, a.scene), (b.force_max, b.impacts, b.scene));
        }
        let ask = Ask { also: Some(Also::walls(0.0)), measure: Measure::ContactForce, ..Ask::default() };
        let found = extremes(&open, window, &Settings::default(), ask).expect("a run");
        assert_eq!((found.largest.value, found.force()), (0.0, 0.0));
    }
}

/// An undamped structure at its resonance has no steady motion, and a damper without walls still moves.
#[test]
fn exact_no_walls_and_no_damping_at_a_resonance() {
    let numbers = Numbers { c1: 0.0, c2: 0.0, k2: 60.0, m2: 60.0, omega: 1.0, ..TMD };
    let scene = numbers.open_scene();
    let window = Window { from: 0.0, to: 50.0 };
    let run = simulate(&scene, window, &Settings::default()).expect("a run");
    let settings = Settings { method: Method::Dop853, rtol: 1e-12, ..Settings::default() };
    let other = simulate(&scene, window, &settings).expect("a run");
    assert!((run.e1_max.value / other.e1_max.value - 1.0).abs() < 1e-8, "{run:?} {other:?}");
}
