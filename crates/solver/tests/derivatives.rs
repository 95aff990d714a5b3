//! The derivatives of a run by its first state and by parameters.

mod anything;

use anything::scenes::{Numbers, SSVI, Spread, TMD, TWO_SIDED};
use nalgebra::Matrix4;
use retune_model::{Coupled, Parameter};
use retune_solver::observe::Unobserved;
use retune_solver::{Follower, Motion, Phase, Settings, Tangent, Transition};
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

fn tangent(numbers: &Numbers, y: [f64; 4], seconds: f64) -> Transition {
    let system = numbers.coupled();
    let mut tangent = Tangent::new(&system, &settings(), seconds, &Parameter::ALL);
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

/// The largest error of derivatives beside differences, relative to the largest derivative of the column, over scales of the state.
fn error(found: &[f64; 4], expected: &[f64; 4]) -> f64 {
    let size = expected.iter().fold(0.0_f64, |size, v| size.max(v.abs()));
    found.iter().zip(expected).fold(0.0, |error, (a, b)| f64::max(error, (a - b).abs())) / size
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
    let mut worst: f64 = 0.0;
    for scene in 0..120 {
        let (numbers, y) = random(&mut spread, scene % 2 == 1);
        let seconds = 1.5;
        let found = tangent(&numbers, y, seconds);
        for j in 0..4 {
            let expected = richardson(2e-5, |h| {
                let mut y = y;
                y[j] += h;
                after(&numbers, y, seconds)
            });
            let error = error(&found.by_state[j], &expected);
            if error > 1e-8 {
                println!("{scene}: state {j} {error:e}");
            }
            worst = worst.max(error);
        }
        for (column, &parameter) in found.by.iter().zip(&Parameter::ALL) {
            let share = if parameter == Parameter::R { 1e-2 } else { 2e-4 };
            let step = share * size(&numbers, parameter);
            let expected = richardson(step, |h| after(&moved(&numbers, parameter, h), y, seconds));
            let error = error(column, &expected);
            if error > 1e-8 {
                println!("{scene}: {parameter:?} {error:e} {column:?} {expected:?}");
            }
            worst = worst.max(error);
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-8, "{worst:e}");
}

/// Liouville: the volume shrinks at the rate of the trace, contact or not.
#[test]
fn exact_the_determinant_over_a_period() {
    let mut spread = Spread::new(6);
    for scene in 0..200 {
        let (numbers, y) =
            if scene == 0 { (TMD, [0.0, 0.0, 2.08, 0.0]) } else { random(&mut spread, scene % 2 == 1) };
        let period = TAU / numbers.omega;
        let by_state = tangent(&numbers, y, period).by_state;
        let found = Matrix4::from_fn(|i, j| by_state[j][i]).determinant();
        let Numbers { m1, c1, m2, c2, .. } = numbers;
        let expected = (-period * (c1 / m1 + c2 / m1 + c2 / m2)).exp();
        assert!((found / expected - 1.0).abs() < 1e-9, "{scene}: {found} {expected}");
    }
}
