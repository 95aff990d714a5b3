//! Derivatives through rigid walls.

use super::rigid::run;
use nalgebra::Matrix4;
use retune_model::{Coupled, Measure, Parameter};
use retune_solver::observe::Unobserved;
use retune_solver::{
    Ask, Hybrid, Motion, Phase, Settings, SolverError, Tangent, Window, extremes, extremes_by,
};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TWO_SIDED};

/// Those by which everything that is computed here has derivatives.
const ALL: [Parameter; 10] = [
    Parameter::K2,
    Parameter::C2,
    Parameter::D,
    Parameter::C,
    Parameter::M2,
    Parameter::C1,
    Parameter::K1,
    Parameter::P,
    Parameter::Omega,
    Parameter::Restitution,
];

fn propagated(system: &Coupled, y: [f64; 4], to: f64) -> [f64; 4] {
    let mut hybrid = Hybrid::new(system, 1e-10, to, 20_000_000);
    hybrid.propagate(Motion { t: 0.0, y, phase: Phase::Flight }, to, &mut Unobserved).expect("a run").y
}

fn at(numbers: &Numbers, parameter: Parameter, value: f64) -> Coupled {
    let scene = parameter.at(numbers.scene(), value).expect("in range");
    Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper"))
}

fn draw(spread: &mut Spread) -> Numbers {
    let e = 0.2 + 0.75 * spread.unit();
    Numbers { omega: 5.0 + 3.0 * spread.unit(), d: 0.03 + 0.05 * spread.unit(), rigid: Some(e), ..TWO_SIDED }
}

/// Liouville, and `e²` for each impact: the saltation matrix has the determinant `(-e)²`, whatever the masses and the force.
#[test]
fn exact_the_determinant_is_that_of_dashpots_and_impacts() {
    let (mut spread, mut struck) = (Spread::new(21), 0);
    for _ in 0..60 {
        let numbers = draw(&mut spread);
        let system = numbers.coupled();
        let y = [0.02 * spread.signed(), 0.3 * spread.signed(), numbers.d, spread.signed()];
        let begin = Motion { t: 0.0, y, phase: Phase::Flight };
        let mut seen = super::rigid::Impacts::default();
        let mut tangent = Tangent::new(&system, &Settings::default(), 1.0, &[]);
        let by_state = tangent.propagate(begin, 1.0, &mut seen).expect("a run").by_state;
        let found = Matrix4::from_fn(|i, j| by_state[j][i]).determinant().ln();
        let Numbers { m1, c1, m2, c2, rigid: Some(e), .. } = numbers else { continue };
        let expected = -(c1 / m1 + c2 / m1 + c2 / m2) + 2.0 * seen.0.len() as f64 * e.ln();
        assert!((found - expected).abs() < 1e-9, "{numbers:?}: {found} {expected}");
        struck += seen.0.len();
    }
    assert!(struck > 50, "{struck}");
}

/// Central differences of the state after a second.
fn by_differences(f: impl Fn(f64) -> [f64; 4], step: f64) -> [f64; 4] {
    let (up, down) = (f(step), f(-step));
    std::array::from_fn(|i| (up[i] - down[i]) / (2.0 * step))
}

fn assert_near(found: [f64; 4], expected: [f64; 4], allowed: f64, what: &str) {
    let size = expected.iter().fold(1e-3_f64, |most, v| most.max(v.abs()));
    for i in 0..4 {
        assert!((found[i] - expected[i]).abs() <= allowed * size, "{what}: {found:?} {expected:?}");
    }
}

#[test]
fn reference_derivatives_are_the_limits_of_differences() {
    let mut spread = Spread::new(22);
    let mut struck = 0;
    for _ in 0..12 {
        let numbers = draw(&mut spread);
        let system = numbers.coupled();
        let y = [0.02 * spread.signed(), 0.3 * spread.signed(), numbers.d, spread.signed()];
        let mut tangent = Tangent::new(&system, &Settings::default(), 1.0, &ALL);
        let mut seen = super::rigid::Impacts::default();
        let begin = Motion { t: 0.0, y, phase: Phase::Flight };
        let found = tangent.propagate(begin, 1.0, &mut seen).expect("a run");
        // A slow impact is near a grazing, where differences are of another motion.
        let slowest = seen.0.iter().map(|i| (i.before.y[3] - i.before.y[1]).abs()).fold(9.0, f64::min);
        if slowest < 0.05 {
            continue;
        }
        struck += seen.0.len();
        for j in 0..4 {
            let moved = |by: f64| {
                let mut y = y;
                y[j] += by;
                propagated(&system, y, 1.0)
            };
            assert_near(found.by_state[j], by_differences(moved, 1e-7), 1e-5, &format!("{j} {numbers:?}"));
        }
        for (number, parameter) in ALL.into_iter().enumerate() {
            let value = parameter.of(&numbers.scene()).expect("it has it");
            let moved = |by: f64| propagated(&at(&numbers, parameter, value * (1.0 + by)), y, 1.0);
            let by = found.by[number].map(|v| v * value);
            assert_near(by, by_differences(moved, 1e-7), 1e-5, &format!("{parameter} {numbers:?}"));
        }
    }
    assert!(struck > 12, "{struck}");
}

/// A damper that starts on the wall, is let go, comes back, chatters and is held again: only the common motion is left of a change, and
/// its derivative is the limit of differences.
#[test]
fn reference_derivatives_through_a_chatter_and_a_hold() {
    for (e, omega, to) in
        [(0.1, 9.0, 2.82), (0.1, 9.0, 3.6), (0.0, 9.0, 2.0), (0.1, 4.0, 0.2), (0.0, 4.0, 1.2)]
    {
        let numbers = Numbers { k2: 200.0, c2: 40.0, d: 0.005, c: 9.0, omega, rigid: Some(e), ..SSVI };
        let system = numbers.coupled();
        let (impacts, end) = run(&system, to);
        assert!(impacts.iter().any(|impact| impact.caught), "{e} {omega}");
        let start = Motion::start(&system);
        let mut tangent = Tangent::new(&system, &Settings::default(), to, &ALL);
        let found = tangent.propagate(start, to, &mut Unobserved).expect("a run");
        if matches!(end.phase, Phase::InContact(_)) {
            for column in found.by_state {
                assert!(column[1] == column[3] && (column[0] - column[2]).abs() < 1e-15, "{column:?}");
            }
        }
        for j in 0..4 {
            let moved = |by: f64| {
                let mut y = start.y;
                y[j] += by;
                propagated(&system, y, to)
            };
            assert_near(found.by_state[j], by_differences(moved, 1e-6), 1e-5, &format!("{j} {e} {to}"));
        }
        for (number, parameter) in ALL.into_iter().enumerate() {
            if e == 0.0 && parameter == Parameter::Restitution {
                continue; // no smaller one
            }
            let value = parameter.of(&numbers.scene()).expect("it has it");
            let moved = |by: f64| propagated(&at(&numbers, parameter, value * (1.0 + by)), start.y, to);
            let by = found.by[number].map(|v| v * value);
            assert_near(by, by_differences(moved, 1e-6), 1e-5, &format!("{parameter} {e} {to}"));
        }
    }
}

/// Largest values, wherever they are reached: many just before or just after an impact.
#[test]
fn reference_derivatives_of_largest_values() {
    let (mut spread, window, mut at_impact) = (Spread::new(23), Window { from: 0.0, to: 3.0 }, 0);
    for _ in 0..8 {
        let numbers = draw(&mut spread);
        let (impacts, _) = run(&numbers.coupled(), 3.0);
        for measure in Measure::ALL.into_iter().filter(|measure| !measure.is_of_walls()) {
            let ask = Ask { measure, ..Ask::default() };
            let of = |scene| extremes(&scene, window, &Settings::default(), ask).expect("a run").largest;
            let by =
                extremes_by(&numbers.scene(), window, &Settings::default(), ask, &ALL).expect("derivatives");
            let largest = of(numbers.scene());
            at_impact +=
                usize::from(impacts.iter().any(|impact| (impact.after.t - largest.time).abs() < 1e-12));
            for (parameter, by) in ALL.into_iter().zip(by) {
                let value = parameter.of(&numbers.scene()).expect("it has it");
                let moved = |share: f64| {
                    of(parameter.at(numbers.scene(), value * (1.0 + share)).expect("in range")).value
                };
                let expected = (moved(1e-7) - moved(-1e-7)) / 2e-7;
                let close = (by * value - expected).abs() <= 1e-4 * (largest.value + expected.abs());
                assert!(
                    close,
                    "{measure:?} by {parameter}: {} {expected} of {largest:?}; {numbers:?}",
                    by * value
                );
            }
        }
    }
    assert!(at_impact > 4, "{at_impact}");
}

/// The damper comes to the wall with no speed: with a little less motion it does not strike.
#[test]
fn contract_a_grazing_motion_has_no_derivative() {
    // A spring of the frequency √2 about D = 1 above a wall at rest: an amplitude of 1 touches it.
    let numbers = Numbers {
        p: 0.0,
        k1: 0.0,
        c1: 0.0,
        k2: 2.0 * SSVI.m2,
        c2: 0.0,
        d: 1.0,
        c: 9.0,
        m1: 1e15,
        rigid: Some(0.5),
        ..SSVI
    };
    let system = numbers.coupled();
    let mut tangent = Tangent::new(&system, &Settings::default(), 9.0, &[]);
    let from = |amplitude: f64| Motion { t: 0.0, y: [0.0, 0.0, 1.0 + amplitude, 0.0], phase: Phase::Flight };
    assert!(tangent.propagate(from(1.1), 4.0, &mut Unobserved).is_ok());
    assert!(tangent.propagate(from(0.9), 4.0, &mut Unobserved).is_ok());
    let grazing = tangent.propagate(from(1.0 + 4e-15), 4.0, &mut Unobserved);
    let t = std::f64::consts::PI / 2.0_f64.sqrt();
    assert!(matches!(grazing, Err(SolverError::Grazing { t: at }) if (at - t).abs() < 1e-7), "{grazing:?}");
}
