//! The derivatives of a run by its first state and by parameters.

use nalgebra::Matrix4;
use rayon::prelude::*;
use retune_model::{Amplitude, Coupled, Measure, Parameter};
use retune_solver::observe::Unobserved;
use retune_solver::{
    Also, Ask, Follower, Motion, Phase, Settings, Tangent, Transition, Window, extremes, extremes_by,
};
use retune_testkit::scenes::{DRIVEN, Numbers, SSVI, Spread, TMD, TWO_SIDED};
use std::f64::consts::TAU;

fn settings() -> Settings {
    Settings { rtol: 1e-13, ..Settings::default() }
}

fn motion(system: &Coupled, y: [f64; 4]) -> Motion {
    Motion { t: 0.0, y, phase: Phase::of(system, &y) }
}

/// The state after some time.
fn after(numbers: &Numbers, y: [f64; 4], seconds: f64) -> [f64; 4] {
    let system = numbers.coupled();
    let mut follower = Follower::new(&system, &settings(), seconds);
    follower.propagate(motion(&system, y), seconds, &mut Unobserved).expect("a run").y
}

/// The parameters of a scene under a force by which there are derivatives.
const BY: [Parameter; 11] = [
    Parameter::Omega,
    Parameter::P,
    Parameter::K1,
    Parameter::C1,
    Parameter::M2,
    Parameter::K2,
    Parameter::C2,
    Parameter::D,
    Parameter::C,
    Parameter::R,
    Parameter::Lambda,
];

fn tangent(numbers: &Numbers, y: [f64; 4], seconds: f64, by: &[Parameter]) -> Transition {
    let system = numbers.coupled();
    let mut tangent = Tangent::new(&system, &settings(), seconds, by);
    tangent.propagate(motion(&system, y), seconds, &mut Unobserved).expect("a run")
}

/// The numbers with one parameter changed by a share of it.
fn moved(numbers: &Numbers, parameter: Parameter, by: f64) -> Numbers {
    let mut moved = *numbers;
    let value = match parameter {
        Parameter::Omega => &mut moved.omega,
        Parameter::P => &mut moved.p,
        Parameter::K1 => &mut moved.k1,
        Parameter::C1 => &mut moved.c1,
        Parameter::M2 => &mut moved.m2,
        Parameter::K2 => &mut moved.k2,
        Parameter::C2 => &mut moved.c2,
        Parameter::D => &mut moved.d,
        Parameter::C => &mut moved.c,
        Parameter::R => &mut moved.r,
        Parameter::Lambda => &mut moved.lambda,
        Parameter::Restitution => &mut moved.e,
        other => panic!("no derivative by {other}"),
    };
    *value += by;
    moved
}

fn size(numbers: &Numbers, parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Omega => numbers.omega,
        Parameter::P => numbers.p,
        Parameter::K1 => numbers.k1,
        Parameter::C1 => numbers.c1,
        Parameter::M2 => numbers.m2,
        Parameter::K2 => numbers.k2,
        Parameter::C2 => numbers.c2,
        Parameter::D => numbers.d,
        Parameter::C => numbers.c,
        Parameter::R => numbers.r,
        Parameter::Lambda => 1.0,
        Parameter::Restitution => numbers.e,
        other => panic!("no derivative by {other}"),
    }
}

/// Richardson's extrapolation of central differences with steps `h`, `h/2`, `h/4`, `h/8`.
fn richardson(h: f64, at: impl Fn(f64) -> [f64; 4]) -> [f64; 4] {
    let difference = |h: f64| -> [f64; 4] {
        let (above, below) = (at(h), at(-h));
        std::array::from_fn(|i| (above[i] - below[i]) / (2.0 * h))
    };
    let mut table: Vec<[f64; 4]> = (0..4).map(|k| difference(h / f64::from(1 << k))).collect();
    for order in 1..4 {
        let factor = f64::from(1 << (2 * order));
        table = table
            .windows(2)
            .map(|pair| std::array::from_fn(|i| (factor * pair[1][i] - pair[0][i]) / (factor - 1.0)))
            .collect();
    }
    table[0]
}

/// The derivative at zero by values at 0 to `7 h`: that of the polynomial through them.
fn one_sided(h: f64, at: impl Fn(f64) -> [f64; 4]) -> [f64; 4] {
    let values: Vec<[f64; 4]> = (0..8).map(|k| at(f64::from(k) * h)).collect();
    std::array::from_fn(|i| {
        let (mut row, mut sum): (Vec<f64>, f64) = (values.iter().map(|value| value[i]).collect(), 0.0);
        for order in 1..8 {
            row = row.windows(2).map(|pair| pair[1] - pair[0]).collect();
            sum += row[0] * if order % 2 == 1 { 1.0 } else { -1.0 } / f64::from(order);
        }
        sum / h
    })
}

/// The largest error of derivatives beside differences, relative to the largest derivative of the column, over scales of the state.
fn error(found: &[f64; 4], expected: &[f64; 4]) -> f64 {
    let size = expected.iter().fold(0.0_f64, |size, v| size.max(v.abs()));
    found.iter().zip(expected).fold(0.0, |error, (a, b)| f64::max(error, (a - b).abs())) / size
}

/// That of the derivatives by the first state.
fn error_by_state(found: &Transition, numbers: &Numbers, y: [f64; 4], seconds: f64) -> f64 {
    let of = |j: usize| {
        let expected = richardson(2e-5, |h| {
            let mut y = y;
            y[j] += h;
            after(numbers, y, seconds)
        });
        error(&found.by_state[j], &expected)
    };
    (0..4).map(of).fold(0.0, f64::max)
}

fn random(spread: &mut Spread, two_walls: bool) -> (Numbers, [f64; 4]) {
    let base = if two_walls { TWO_SIDED } else { SSVI };
    let mut near = |value: f64| value * (1.0 + 0.2 * spread.signed());
    let numbers = Numbers {
        k1: near(base.k1),
        c1: near(base.c1),
        k2: near(base.k2),
        c2: near(base.c2),
        m2: near(base.m2),
        d: near(base.d),
        c: near(base.c),
        r: near(base.r),
        p: near(base.p),
        omega: near(base.omega),
        ..base
    };
    let r = 0.5 * numbers.d;
    (numbers, spread.state(r))
}

#[test]
fn reference_derivatives_agree_with_differences() {
    let mut spread = Spread::new(5);
    let (mut worsts, mut worst_at_zero) = ([0.0_f64; 2], 0.0_f64);
    for scene in 0..240 {
        let (mut numbers, y) = random(&mut spread, scene % 2 == 1);
        // Half of them lose energy in contacts, some so much that their force ends before they do.
        let lossy = scene >= 120;
        if lossy {
            numbers.lambda = spread.logarithmic(0.01, 30.0);
        }
        let worst = &mut worsts[usize::from(lossy)];
        let seconds = 1.5;
        let found = tangent(&numbers, y, seconds, &BY);
        *worst = worst.max(error_by_state(&found, &numbers, y, seconds));
        for (column, &parameter) in found.by.iter().zip(&BY) {
            let share = if parameter == Parameter::R { 1e-2 } else { 2e-4 };
            let size = size(&numbers, parameter);
            // No loss is negative: by the smallest ones there are differences to one side.
            let step =
                if parameter == Parameter::Lambda { 1e-3 * numbers.lambda.min(0.5) } else { share * size };
            if step == 0.0 {
                // Also at (almost) zero contacts are followed step by step, as those with loss.
                let at = |h: f64| after(&moved(&numbers, parameter, h + f64::MIN_POSITIVE), y, seconds);
                worst_at_zero = worst_at_zero.max(error(column, &one_sided(3e-5, at)));
                continue;
            }
            let expected = richardson(step, |h| after(&moved(&numbers, parameter, h), y, seconds));
            let error = error(column, &expected);
            *worst = worst.max(error);
        }
    }
    // The differences of contacts that are followed step by step have fewer digits.
    assert!(worsts[0] < 1e-8 && worsts[1] < 1e-6 && worst_at_zero < 1e-6, "{worsts:?} {worst_at_zero:e}");
}

/// The same with one restitution at every speed, whose law depends on the masses, too.
#[test]
fn reference_derivatives_with_a_restitution_agree_with_differences() {
    let mut spread = Spread::new(9);
    let with_restitution = BY.map(|by| if by == Parameter::Lambda { Parameter::Restitution } else { by });
    let scenes: Vec<(Numbers, [f64; 4])> = (0..60)
        .map(|scene| {
            let (numbers, y) = random(&mut spread, scene % 2 == 1);
            (Numbers { e: 0.1 + 0.85 * spread.unit(), ..numbers }, y)
        })
        .step_by(3)
        .collect();
    let worst = |(numbers, y): &(Numbers, [f64; 4])| {
        let (seconds, mut worst) = (1.5, 0.0_f64);
        let found = tangent(numbers, *y, seconds, &with_restitution);
        for (column, &parameter) in found.by.iter().zip(&with_restitution) {
            let share = if parameter == Parameter::R { 1e-2 } else { 2e-4 };
            let step = share * size(numbers, parameter);
            let expected = richardson(step, |h| after(&moved(numbers, parameter, h), *y, seconds));
            worst = worst.max(error(column, &expected));
        }
        worst.max(error_by_state(&found, numbers, *y, seconds))
    };
    let worst: Vec<f64> = scenes.par_iter().map(worst).collect();
    let most = worst.iter().copied().fold(0.0, f64::max);
    assert!(most < 1e-6, "{most:e} {worst:?}");
}

/// Liouville: the volume shrinks at the rate of the trace, contact or not.
#[test]
fn exact_the_determinant_over_a_period() {
    let mut spread = Spread::new(6);
    for scene in 0..200 {
        let (numbers, y) =
            if scene == 0 { (TMD, [0.0, 0.0, 2.08, 0.0]) } else { random(&mut spread, scene % 2 == 1) };
        let period = TAU / numbers.omega;
        let by_state = tangent(&numbers, y, period, &BY).by_state;
        let found = Matrix4::from_fn(|i, j| by_state[j][i]).determinant();
        let Numbers { m1, c1, m2, c2, .. } = numbers;
        let expected = (-period * (c1 / m1 + c2 / m1 + c2 / m2)).exp();
        assert!((found / expected - 1.0).abs() < 1e-9, "{scene}: {found} {expected}");
    }
}

/// Numbers with what moves the structure.
type Driven = (Numbers, Amplitude);

/// Largest values over a window of a few periods, from rest. A scene is left out where the largest value is reached at another maximum for
/// a step to either side: there it has no derivative.
#[test]
fn reference_gradients_of_largest_values_agree_with_differences() {
    let mut spread = Spread::new(8);
    let window = Window { from: 1.0, to: 5.0 };
    let mut scenes: Vec<Driven> =
        (0..60).map(|scene| (random(&mut spread, scene % 2 == 1).0, Amplitude::Force)).collect();
    for scene in 0..30 {
        let lambda = spread.logarithmic(0.02, 10.0);
        scenes.push((Numbers { lambda, ..random(&mut spread, scene % 2 == 1).0 }, Amplitude::Force));
    }
    for scene in 0..12 {
        let e = 0.1 + 0.85 * spread.unit();
        scenes.push((Numbers { e, ..random(&mut spread, scene % 2 == 1).0 }, Amplitude::Force));
    }
    // Forces of an imbalance and of a base, below and above the resonance of the structure.
    for scene in 0..24 {
        let (amplitude, p) = DRIVEN[1 + scene % 3];
        let numbers = random(&mut spread, scene % 2 == 1).0;
        scenes.push((Numbers { p, omega: spread.logarithmic(3.0, 15.0), ..numbers }, amplitude));
    }
    // A ninth, of all kinds alike.
    let scenes: Vec<Driven> = scenes.into_iter().step_by(9).collect();
    let largest = |(numbers, amplitude): &Driven, measure: Measure| {
        let ask = Ask { measure, also: Some(Also::walls(5.0)), ..Ask::default() };
        extremes(&numbers.forced_by(*amplitude), window, &settings(), ask).expect("a run").largest
    };
    // How many derivatives are compared, and the largest error of them.
    let compare = |driven: &Driven, measure: Measure| -> (usize, f64) {
        let ((numbers, amplitude), mut compared, mut worst) = (driven, 0, 0.0_f64);
        let first = largest(driven, measure);
        if first.value == 0.0 {
            return (0, 0.0);
        }
        let ask = Ask { measure, ..Ask::default() };
        let parameters = BY.map(|parameter| match parameter {
            Parameter::Lambda if numbers.e < 1.0 => Parameter::Restitution,
            _ => parameter,
        });
        let asked = parameters.map(|one| if one == Parameter::P { amplitude.parameter() } else { one });
        let scene = numbers.forced_by(*amplitude);
        let found = extremes_by(&scene, window, &settings(), ask, &asked).expect("a run");
        for (by, parameter) in found.iter().zip(parameters) {
            let share = if parameter == Parameter::R { 1e-2 } else { 2e-4 };
            let step = if parameter == Parameter::Lambda {
                1e-3 * numbers.lambda.min(0.5)
            } else {
                share * size(numbers, parameter)
            };
            if step == 0.0 {
                continue;
            }
            let at = |h: f64| largest(&(moved(numbers, parameter, h), *amplitude), measure);
            if [-step, step].iter().any(|&h| (at(h).time - first.time).abs() > 0.02) {
                continue;
            }
            let expected = richardson(step, |h| [at(h).value, 0.0, 0.0, 0.0])[0];
            // Beside the change of the value by a change of the parameter as large as itself.
            let scale = expected.abs().max(1e-3 * first.value / size(numbers, parameter));
            worst = worst.max((by - expected).abs() / scale);
            compared += 1;
        }
        (compared, worst)
    };
    let all = scenes.par_iter().flat_map_iter(|driven| Measure::ALL.map(|measure| compare(driven, measure)));
    let (compared, worst) = all.reduce(|| (0, 0.0), |a, b| (a.0 + b.0, a.1.max(b.1)));
    assert!(compared > 500 && worst < 1e-6, "{compared} {worst:e}");
}

/// A settled motion reaches its largest value in every period: the derivative at any of them is that of the steady response.
#[test]
fn exact_the_derivative_of_a_settled_motion_is_that_of_the_steady_one() {
    let window = Window { from: 200.0, to: 210.0 };
    let by = [Parameter::K2, Parameter::C2];
    for measure in [Measure::Energy, Measure::Displacement, Measure::Acceleration, Measure::Stroke] {
        let ask = Ask { measure, ..Ask::default() };
        let found = extremes_by(&TMD.scene(), window, &settings(), ask, &by).expect("a run");
        for (found, by) in found.into_iter().zip(by) {
            let steady = TMD.coupled().steady_by(measure, by, TMD.omega);
            assert!((found / steady - 1.0).abs() < 1e-9, "{measure:?} {by:?}: {found} {steady}");
        }
    }
}
