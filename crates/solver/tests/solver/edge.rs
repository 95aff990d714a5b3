//! The corners of the hybrid propagator: grazes, resting damper, vanishing and huge parameters. Each is right by an independent
//! computation, or a typed error; never NaN, a panic or an endless loop.

use crate::problems::linear::{Joined, joined};
use crate::problems::{Watch, assert_close, assert_states};
use rayon::prelude::*;
use retune_model::{Coupled, Excitation, Side};
use retune_solver::observe::{DamperEnergy, Form, PrimaryEnergy, Quantity, RelativePosition, RunningMaximum};
use retune_solver::{
    Hybrid, Method, Motion, Phase, Response, Rows, SceneKind, Settings, SolverError, Window, e1_max,
    simulate, trajectory,
};
use retune_testkit::scenes::{Numbers, SSVI, TMD, TWO_SIDED};

const HYBRID: Settings = Settings {
    method: Method::Hybrid,
    contacts: retune_solver::Contacts::Located,
    rtol: 1e-11,
    atol: 1e-13,
    step: None,
    max_steps: 2_000_000,
};

const ODE45: Settings = Settings { method: Method::Ode45, ..HYBRID };

fn run(numbers: &Numbers, to: f64, settings: &Settings) -> Response {
    simulate(&numbers.scene(), Window { from: 0.0, to }, settings)
        .unwrap_or_else(|e| panic!("{e}: {numbers:?}"))
}

/// Both methods see the same.
#[track_caller]
fn assert_agrees(numbers: &Numbers, to: f64, tolerance: f64) -> Response {
    let (found, expected) = (run(numbers, to, &HYBRID), run(numbers, to, &ODE45));
    let what = format!("{numbers:?}");
    let e1 = expected.e1_max.value;
    assert_close(found.e1_max.value, e1, e1.max(1e-6), tolerance, &what);
    let e2 = expected.e2_max.value;
    assert_close(found.e2_max.value, e2, e2.max(1e-6), 10.0 * tolerance, &what);
    assert_close(
        found.relative_displacement_max,
        expected.relative_displacement_max,
        expected.relative_displacement_max.max(1e-6),
        tolerance,
        &what,
    );
    for side in [0, 1] {
        let force = expected.force_max[side];
        assert_close(found.force_max[side], force, force.max(1.0), 100.0 * tolerance, &what);
    }
    assert_eq!(found.impacts, expected.impacts, "{what}");
    found
}

/// The least `x2 - x1` of a run whose walls are out of reach, less `D`, and when.
fn farthest_inward(numbers: &Numbers, to: f64) -> (f64, f64) {
    let system = Numbers { d: 100.0, c: 100.0, ..*numbers }.coupled();
    let mut peak = RunningMaximum::new(RelativePosition::new(&system, -1.0), f64::INFINITY);
    let mut hybrid = Hybrid::new(&system, 1e-12, to, 1_000_000);
    let begin = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    hybrid.propagate(begin, to, &mut peak).expect("a run");
    (100.0 + peak.record().value, peak.record().time)
}

/// The damper's deepest swing reaches the wall with less and less speed, down to none: the contact is a double crossing well
/// inside a flight step. (A distance resolves speeds down to about 1e-7 m/s.)
#[test]
fn exact_grazes_by_shooting_on_the_distance() {
    let numbers = Numbers { k2: 215.0, c2: 100.0, c: 50.0, ..SSVI };
    let (reach, at) = farthest_inward(&numbers, 2.0);
    let to = at + 0.2;
    let linear = joined(&numbers);
    let system = Numbers { d: reach, ..numbers }.coupled();
    let state = linear.after(0.0, [0.0, 0.0, numbers.d, 0.0], at);
    let turn = {
        let shifted = [state[0], state[1], state[2] - numbers.d + reach, state[3]];
        system.relative_position_rates(system.excitation(at), &shifted)[2]
    };
    assert!(turn > 1.0, "{turn}");
    for speed in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let d = reach - 0.5 * speed * speed / turn;
        let near = Numbers { d, ..numbers };
        let found = run(&near, to, &HYBRID);
        assert_eq!(found.impacts, [1, 0], "speed {speed:e}");
        assert!(
            found.force_max[0] > 0.0 && found.force_max[0] < 1.6e5 * speed.powf(1.2),
            "{:?}",
            found.force_max
        );
        if speed > 3e-4 {
            assert_agrees(&near, to, 1e-9);
        }
        // No contact can do more than turn the damper around.
        let free = linear.after(0.0, [0.0, 0.0, numbers.d, 0.0], to);
        let free = [free[0], free[1], free[2] - numbers.d + d, free[3]];
        let change = (0..4).map(|i| (found.final_state[i] - free[i]).abs()).fold(0.0, f64::max);
        assert!(change < 3.0 * speed + 1e-13, "{speed:e}: {change:e}");
    }
    for outside in [1e-15, 1e-12, 1e-6] {
        let clear = run(&Numbers { d: reach + outside, ..numbers }, to, &HYBRID);
        assert_eq!((clear.scene, clear.impacts), (SceneKind::Linear, [0, 0]), "{outside:e}");
    }
}

/// Grazes that no distance resolves: the motion starts at the wall with the given speed, and is turned by its spring.
#[test]
fn exact_grazes_down_to_rounding() {
    // The wall, the spring at rest 0.06 m away from it pulling off, everything else still.
    let numbers = Numbers { p: 0.0, c: 50.0, ..SSVI };
    let system = numbers.coupled();
    for speed in [1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 0.0] {
        for touching in [Phase::Flight, Phase::Leaving(Side::Primary)] {
            let begin = Motion { t: 0.0, y: [0.0, 0.0, 0.0, -speed], phase: touching };
            let mut hybrid = Hybrid::new(&system, 1e-11, 1.0, 100_000);
            let mut peak: f64 = 0.0;
            let mut watch = Watch::new(|knot: &retune_solver::observe::Knot<4>| {
                peak = peak.max(system.contact_forces(&knot.y)[0]);
            });
            let end = hybrid.propagate(begin, 0.05, &mut watch).unwrap_or_else(|e| panic!("{speed:e}: {e}"));
            let touches = watch.touches;
            assert_eq!(touches, [u64::from(speed > 0.0), 0], "{speed:e} {touching:?}");
            // Without contact the damper is thrown off by its spring; a contact reverses its speed at most.
            let free = joined(&Numbers { p: 0.0, ..numbers }).after(0.0, [0.0; 4], 0.05);
            let change = (0..4).map(|i| (end.y[i] - free[i]).abs()).fold(0.0, f64::max);
            assert!(change < 2.0 * speed + 1e-15, "{speed:e}: {change:e}");
            assert!(peak <= 1.6e5 * speed.powf(1.2), "{speed:e}: {peak:e}");
        }
    }
}

/// A damper laid against a wall by its spring, with and without room: it bounces, sticks and slides off, as ode45 sees it.
#[test]
fn reference_resting_on_a_wall() {
    let soft = Numbers { k2: 600.0, c2: 200.0, ..SSVI };
    for numbers in [
        Numbers { d: 0.0, c: 5.0, ..soft },
        Numbers { d: 0.0, c: 0.05, ..soft },
        Numbers { d: 0.0, c: 0.0, ..soft },
        Numbers { d: 0.1, c: 0.0, ..soft },
        Numbers { d: 0.0, c: 1e-9, ..soft },
        // A sustained contact: a soft wall and a strong push.
        Numbers { d: 0.0, c: 5.0, r: 1e-10, ..soft },
        Numbers { d: 0.0, c: 5.0, k2: 6000.0, c2: 2000.0, ..soft },
    ] {
        assert_agrees(&numbers, 3.0, 1e-7);
    }
}

/// With a constant force everything comes to rest; a damper whose spring is at rest on the wall comes to rest on the wall.
#[test]
fn exact_coming_to_rest_on_a_wall() {
    for (d, c) in [(0.0, 5.0), (0.0, 0.0), (0.2, 0.0), (0.06, 0.36), (0.0, 1e-3)] {
        for c2 in [20.0, 232.0, 1500.0] {
            let numbers = Numbers { omega: 0.0, c1: 4000.0, k2: 600.0, c2, d, c, ..SSVI };
            let found = run(&numbers, 100.0, &Settings { max_steps: 200_000, ..HYBRID });
            let x = numbers.p / numbers.k1;
            assert_states(found.final_state, [x, 0.0, x + d, 0.0], [x, x], 1e-6, &format!("{numbers:?}"));
        }
    }
}

/// Windows and runs that begin and end inside contacts.
#[test]
fn reference_windows_that_cut_contacts() {
    let numbers = Numbers { r: 1e-4, ..TWO_SIDED };
    let whole = run(&numbers, 6.0, &HYBRID);
    let mut pressed = Vec::new();
    trajectory(&numbers.scene(), Window { from: 2.0, to: 6.0 }, &HYBRID, Rows::every(1e-3), &mut |s| {
        if s.forces != [0.0; 2] {
            pressed.push(*s);
        }
    })
    .expect("a run");
    assert!(pressed.len() > 100, "{}", pressed.len());
    for sample in pressed.iter().step_by(23) {
        let before = run(&numbers, sample.t, &HYBRID);
        assert_states(before.final_state, sample.state, [0.1, 1.0], 1e-9, "a run that ends in a contact");
        let window = Window { from: sample.t, to: 6.0 };
        let after = simulate(&numbers.scene(), window, &HYBRID).expect("a run");
        assert_states(after.final_state, whole.final_state, [0.1, 1.0], 1e-8, "a window that begins in one");
        (0..2).for_each(|side| assert_eq!(before.impacts[side] + after.impacts[side], whole.impacts[side]));
        assert_close(before.e1_max.value.max(after.e1_max.value), whole.e1_max.value, 1e3, 1e-10, "E1max");
        let there = sample.forces[0].max(sample.forces[1]);
        let seen = if sample.forces[0] > 0.0 { after.force_max[0] } else { after.force_max[1] };
        assert!(seen >= there * (1.0 - 1e-9), "the force at the start of the window counts: {seen} {there}");
        let expected = simulate(&numbers.scene(), window, &ODE45).expect("a run");
        assert_close(after.e1_max.value, expected.e1_max.value, expected.e1_max.value, 1e-7, "E1max, ode45");
    }
}

/// Elastic impacts of rigid bodies: the matrix exponential between them, speeds exchanged at once.
fn rigid(numbers: &Numbers, to: f64) -> ([f64; 4], u32) {
    let linear: Joined<4> = joined(numbers);
    let system: Coupled = numbers.coupled();
    let gap = |y: &[f64; 4]| {
        let r = y[2] - y[0];
        r.min(system.wall(Side::Obstacle) - r)
    };
    let (mut t, mut y, mut impacts) = (0.0, system.rest(), 0);
    let mut step: f64 = 1e-3;
    while t < to {
        let h = step.min(to - t);
        let next = linear.after(t, y, h);
        if gap(&next) >= 0.0 {
            (t, y, step) = (t + h, next, 1e-3);
            continue;
        }
        let (mut open, mut closed) = (0.0, h);
        for _ in 0..60 {
            let middle = 0.5 * (open + closed);
            if gap(&linear.after(t, y, middle)) >= 0.0 { open = middle } else { closed = middle }
        }
        let [x1, v1, x2, v2] = linear.after(t, y, open);
        let mean = (numbers.m1 * v1 + numbers.m2 * v2) / (numbers.m1 + numbers.m2);
        (t, y, impacts) = (t + open, [x1, 2.0 * mean - v1, x2, 2.0 * mean - v2], impacts + 1);
    }
    (y, impacts)
}

/// The stiffer the contact, the nearer to rigid impacts: the difference is the time spent in contact, `K^(-2/5)`.
#[test]
fn order_of_convergence_to_rigid_impacts() {
    let mut errors = Vec::new();
    for factor in [1e4, 1e6, 1e8, 1e12] {
        let young = SSVI.young.map(|e| e * factor);
        let numbers = Numbers { young, c: 0.2, ..SSVI };
        let (expected, impacts) = rigid(&numbers, 4.0);
        let found = run(&numbers, 4.0, &HYBRID);
        assert_eq!(found.impacts.iter().sum::<u64>(), u64::from(impacts));
        assert!(impacts >= 3, "{impacts}");
        let error = (0..4).map(|i| (found.final_state[i] - expected[i]).abs()).fold(0.0, f64::max);
        errors.push((factor, error));
    }
    for pair in errors.windows(2) {
        let order = (pair[0].1 / pair[1].1).ln() / (pair[1].0 / pair[0].0).ln();
        assert!((order - 0.4).abs() < 0.1, "{errors:?}");
    }
    assert!(errors[2].1 < 1e-3, "{errors:?}");
}

/// Parameters that vanish or are very large, each against ode45.
#[test]
fn reference_corners_of_the_parameters() {
    let critical = 2.0 * (SSVI.k2 * SSVI.m2).sqrt();
    for (numbers, to) in [
        (Numbers { c2: critical, ..SSVI }, 6.0),
        (Numbers { c2: critical * (1.0 + 1e-12), ..SSVI }, 6.0),
        (Numbers { c2: critical * (1.0 - 1e-7), ..SSVI }, 6.0),
        (Numbers { k2: 0.0, ..SSVI }, 6.0),
        (Numbers { c2: 0.0, k2: 400.0, ..SSVI }, 4.0),
        (Numbers { k2: 0.0, c2: 0.0, ..SSVI }, 3.0),
        (Numbers { c1: 0.0, ..SSVI }, 6.0),
        (Numbers { k1: 0.0, ..SSVI }, 6.0),
        (Numbers { k1: 0.0, c1: 0.0, ..SSVI }, 6.0),
        (Numbers { omega: 0.0, p: 8000.0, ..SSVI }, 4.0),
        (Numbers { omega: 1e3, p: 1e6, ..SSVI }, 1.0),
        (Numbers { omega: 1e4, d: 0.0, p: 1e7, ..SSVI }, 0.1),
        (Numbers { m2: 1e-3, c2: 0.02, k2: 0.005, d: 0.02, ..SSVI }, 3.0),
        (Numbers { m2: 1000.0, k2: 3000.0, ..SSVI }, 6.0),
        (Numbers { m2: 1e5, k2: 3e5, c2: 1e3, d: 0.01, ..SSVI }, 3.0),
        (Numbers { c2: 1e6, d: 1e-5, c: 1e-5, ..SSVI }, 0.5),
        (Numbers { r: 1e-10, d: 0.02, ..SSVI }, 4.0),
        (Numbers { r: 1e-16, d: 0.0, ..SSVI }, 2.0),
        (Numbers { d: 1e-6, c: 1e-6, ..SSVI }, 0.5),
    ] {
        let found = assert_agrees(&numbers, to, 1e-7);
        let value =
            e1_max(&numbers.scene(), Window { from: 0.0, to }, &HYBRID, f64::INFINITY).expect("a run");
        assert_close(value.value, found.e1_max.value, value.value, 1e-12, &format!("e1_max {numbers:?}"));
    }
}

/// The lighter the damper, the less the structure feels it.
#[test]
fn exact_a_vanishing_damper_leaves_the_bare_structure() {
    let bare =
        simulate(&SSVI.bare_scene(), Window { from: 0.0, to: 10.0 }, &HYBRID).expect("a run").e1_max.value;
    for m2 in [1e-3, 1e-6, 1e-9] {
        let scale = m2 / SSVI.m2;
        let dust = Numbers { m2, k2: scale * SSVI.k2, c2: scale * SSVI.c2, ..SSVI };
        let found = run(&dust, 10.0, &HYBRID);
        assert!(found.impacts[0] > 3, "{:?}", found.impacts);
        assert_close(found.e1_max.value, bare, bare, 20.0 * m2 / SSVI.m1, &format!("m2 = {m2:e}"));
    }
}

/// A run of many million evaluations took a minute where nobody had asked for one: steps alone are no measure of work.
#[test]
fn regress_no_run_works_for_minutes_unasked() {
    let window = Window { from: 50.0, to: 100.0 };
    let (light, stiff) = (Numbers { m1: 0.00024, ..SSVI }, Numbers { k1: 5e16, ..SSVI });
    for (numbers, method) in [(light, Method::Dop853), (stiff, Method::Dop853), (stiff, Method::Ode45)] {
        let settings = Settings { method, ..Settings::default() };
        let found = simulate(&numbers.scene(), window, &settings).map(|found| found.work);
        let ended = match found {
            Err(SolverError::TooSlow { steps, .. }) => steps < 100_000, // of seven evaluations and more
            Err(SolverError::TooManySteps { evaluations, .. }) => evaluations == Some(5_000_000),
            _ => false,
        };
        assert!(ended, "{method:?}: {found:?}");
    }
}

/// Bad corners give a typed error, and give it soon.
#[test]
fn contract_errors_are_typed() {
    let steps = Settings { max_steps: 1000, ..HYBRID };
    for settings in
        [steps, Settings { method: Method::Ode45, ..steps }, Settings { method: Method::Ode23s, ..steps }]
    {
        for scene in [SSVI.scene(), TMD.scene(), Numbers { omega: 1e4, ..SSVI }.bare_scene()] {
            let error = simulate(&scene, Window { from: 0.0, to: 1e6 }, &settings);
            let Err(
                SolverError::TooManySteps { t, limit: 1000, .. }
                | SolverError::TooSlow { t, limit: 1000, .. },
            ) = error
            else {
                panic!("{error:?}")
            };
            assert!(t > 0.0 && t < 1e6, "{t}");
        }
    }
    // Overflow.
    let huge = Numbers { p: 1e308, m1: 1e-300, ..SSVI };
    for method in [Method::Hybrid, Method::Ode45, Method::Ode23s] {
        let settings = Settings { method, max_steps: 100_000, ..HYBRID };
        for scene in [huge.scene(), huge.bare_scene(), Numbers { d: 0.0, ..huge }.scene()] {
            let found = simulate(&scene, Window { from: 0.0, to: 1.0 }, &settings);
            assert!(found.is_err(), "{method:?} {found:?}");
        }
    }
}

/// Wild parameters, drawn over many decades: finite numbers or a typed error, in bounded time.
/// Steps that know no walls may look into one between their ends: the force is that of the interpolant, and no touch-down is counted.
/// Only of the hybrid, which locates every contact, is that an error.
#[test]
fn contract_a_wall_that_steps_do_not_see_is_no_error() {
    let stepped = Settings {
        method: Method::Rk4,
        contacts: retune_solver::Contacts::Stepped,
        step: Some(1e-3),
        ..HYBRID
    };
    let far = Numbers { d: 2.0, c: 2.0, ..SSVI };
    let reach = run(&far, 10.0, &stepped).relative_displacement_max - far.d;
    let near = Numbers { c: reach - 1e-8, ..far };
    let seen = run(&near, 10.0, &stepped);
    assert_eq!(seen.impacts, [0, 0], "{seen:?}");
    assert!(seen.force_max[1] > 0.0, "{seen:?}");
}

#[test]
fn invariant_extreme_parameters_give_finite_values_or_errors() {
    let mut spread = retune_testkit::scenes::Spread::new(10);
    let mut drawn = || {
        let mut or_zero = |low: f64, high: f64| {
            let value = spread.logarithmic(low, high);
            if spread.unit() < 0.15 { 0.0 } else { value }
        };
        Numbers {
            c1: or_zero(1e-3, 1e6),
            k1: or_zero(1e-3, 1e8),
            p: or_zero(1e-6, 1e9),
            omega: or_zero(1e-3, 1e4),
            k2: or_zero(1e-6, 1e8),
            c2: or_zero(1e-6, 1e7),
            d: or_zero(1e-12, 1e3),
            c: or_zero(1e-12, 1e3),
            m1: spread.logarithmic(1e-3, 1e6),
            m2: spread.logarithmic(1e-6, 1e6),
            r: spread.logarithmic(1e-12, 1e12),
            ..SSVI
        }
    };
    let scenes: Vec<Numbers> = (0..60).map(|_| drawn()).collect();
    let settings = Settings { max_steps: 5_000, rtol: 1e-8, ..HYBRID };
    let finishes =
        |numbers: &&Numbers| match simulate(&numbers.scene(), Window { from: 0.0, to: 2.0 }, &settings) {
            Ok(found) => {
                let values = [found.e1_max.value, found.e2_max.value, found.relative_displacement_max];
                let mut all = values.iter().chain(&found.force_max).chain(&found.final_state);
                assert!(all.all(|v| v.is_finite()), "{found:?} {numbers:?}");
                assert!(found.e1_max.value >= 0.0 && found.e2_max.value >= 0.0);
                true
            }
            Err(SolverError::TooManySteps { t, .. } | SolverError::TooSlow { t, .. }) => {
                assert!((0.0..2.0).contains(&t), "{t}");
                false
            }
            Err(error) => panic!("{error} {numbers:?}"),
        };
    let finished = scenes.par_iter().filter(finishes).count();
    assert!(finished > 20, "{finished}");
}

/// Counts how often a quantity is looked at.
struct Counted<'a, Q>(Q, &'a std::cell::Cell<u64>);

impl<Q: Quantity<4>> Quantity<4> for Counted<'_, Q> {
    fn rates(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 3] {
        self.1.set(self.1.get() + 1);
        self.0.rates(excitation, y)
    }
    fn form(&self) -> &Form<4> {
        self.0.form()
    }
}

fn assert_few_looks(system: &Coupled, quantity: impl Quantity<4>) {
    let looks = std::cell::Cell::new(0_u64);
    let mut peak = RunningMaximum::new(Counted(quantity, &looks), f64::INFINITY);
    let mut hybrid = Hybrid::new(system, 1e-10, 3.0, 100_000);
    let begin = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    hybrid.propagate(begin, 3.0, &mut peak).expect("a run");
    let allowed = 30 * (hybrid.work.steps + 10);
    assert!(looks.get() <= allowed, "{} looks in {} steps", looks.get(), hybrid.work.steps);
}

/// A quantity that is level to rounding over a whole segment is not searched without end.
#[test]
fn contract_a_search_takes_a_bounded_number_of_evaluations() {
    let resting = Numbers { k2: 600.0, c2: 200.0, d: 0.0, ..SSVI };
    // A speck between two walls 5 nm apart, thrown about by next to nothing.
    let rattling = Numbers { p: 1.7e-4, m2: 0.04, k2: 0.0, c2: 0.0, d: 0.0, c: 4.6e-9, omega: 2.0, ..SSVI };
    for numbers in [resting, Numbers { c: 0.0, ..resting }, rattling] {
        let system = numbers.coupled();
        assert_few_looks(&system, PrimaryEnergy::new(&system));
        assert_few_looks(&system, DamperEnergy::new(&system));
        assert_few_looks(&system, RelativePosition::new(&system, 1.0));
        assert_few_looks(&system, RelativePosition::new(&system, -1.0));
    }
}
