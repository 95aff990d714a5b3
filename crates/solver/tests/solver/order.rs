//! Orders of the methods: slopes on smooth problems with known solutions, and the order conditions of their coefficients.

use crate::problems::smooth::{Decaying, Problem, Scalar, Turning, WrongJacobian};
use crate::problems::trees;
use retune_solver::System;
use retune_solver::methods::{Attempt, Ode23s, Ode45, OneStep, dop853, ode45};
use std::cell::{Cell, RefCell};

type Complex = nalgebra::Complex<f64>;

/// Least-squares slope of `ln error` over `ln h`.
fn observed_order(points: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let logs: Vec<(f64, f64)> = points.into_iter().map(|(h, error)| (h.ln(), error.ln())).collect();
    let n = logs.len() as f64;
    let mean = logs.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
    let (mut up, mut across) = (0.0, 0.0);
    for (x, y) in logs {
        up += (x - mean.0) * (y - mean.1);
        across += (x - mean.0).powi(2);
    }
    up / across
}

fn distance<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    (0..N).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

fn attempt<M: OneStep<2>>(problem: &impl System<2>, t: f64, y: &[f64; 2], h: f64) -> Attempt<2> {
    M::attempt(problem, t, y, &problem.derivative(t, y), h).expect("solvable")
}

/// Error at the end of `span` in `n` equal steps.
fn global_error<M: OneStep<2>>(problem: &impl Problem, [from, to]: [f64; 2], n: u32) -> f64 {
    let h = (to - from) / f64::from(n);
    let end =
        (0..n).fold(problem.exact(from), |y, k| attempt::<M>(problem, from + f64::from(k) * h, &y, h).y);
    distance(end, problem.exact(to))
}

/// Asserts that the error falls as `h^p`.
#[track_caller]
fn check_order<M: OneStep<2>>(problem: &impl Problem, span: [f64; 2], steps: [u32; 4], p: f64, band: f64) {
    let errors = steps.map(|n| (1.0 / f64::from(n), global_error::<M>(problem, span, n)));
    let found = observed_order(errors);
    assert!((found - p).abs() <= band, "order {found}, not {p}: {errors:?}");
}

#[test]
fn order_of_ode45_is_5() {
    check_order::<Ode45>(&Turning, [0.0, 2.0], [60, 90, 130, 200], 5.0, 0.1);
    check_order::<Ode45>(&Decaying, [-1.0, 1.0], [40, 57, 80, 113], 5.0, 0.1);
}

#[test]
fn order_of_ode23s_is_2() {
    check_order::<Ode23s>(&Turning, [0.0, 2.0], [1000, 1500, 2200, 3300], 2.0, 0.05);
    check_order::<Ode23s>(&Decaying, [0.2, 2.0], [100, 150, 220, 330], 2.0, 0.05);
}

/// A W-method: a wrong Jacobian keeps the order, so no order test can vouch for a Jacobian (the model's is checked
/// against finite differences).
#[test]
fn order_of_ode23s_survives_a_wrong_jacobian() {
    check_order::<Ode23s>(&WrongJacobian(Turning), [0.0, 2.0], [1000, 1500, 2200, 3300], 2.0, 0.05);
    check_order::<Ode23s>(&WrongJacobian(Decaying), [0.2, 2.0], [100, 150, 220, 330], 2.0, 0.05);
    let [right, wrong] = [
        attempt::<Ode23s>(&Turning, 0.3, &[1.0, 0.2], 0.01),
        attempt::<Ode23s>(&WrongJacobian(Turning), 0.3, &[1.0, 0.2], 0.01),
    ];
    assert!(distance(right.y, wrong.y) > 1e-9, "the Jacobian is used");
}

/// The local error of a quantity of one step from an exact value, over several step lengths.
fn local_order(p: f64, band: f64, lengths: [f64; 4], error: impl Fn(f64) -> f64) {
    let found = observed_order(lengths.map(|h| (h, error(h))));
    assert!((found - p).abs() <= band, "local order {found}, not {p}");
}

#[test]
fn order_of_the_dense_outputs() {
    let (t, s) = (0.4, 0.37);
    let between = |a: &Attempt<2>, y: [f64; 2], h: f64| -> [f64; 2] {
        std::array::from_fn(|i| {
            y[i] + h * (0..4).map(|j| a.dense[j][i] * f64::powi(s, j as i32 + 1)).sum::<f64>()
        })
    };
    fn check<M: OneStep<2>>(
        p: f64,
        lengths: [f64; 4],
        between: impl Fn(&Attempt<2>, [f64; 2], f64) -> [f64; 2],
        (t, s): (f64, f64),
    ) {
        let y = Turning.exact(t);
        local_order(p + 1.0, 0.1, lengths, |h| {
            distance(between(&attempt::<M>(&Turning, t, &y, h), y, h), Turning.exact(t + s * h))
        });
        let y = Decaying.exact(t);
        local_order(p + 1.0, 0.1, lengths, |h| {
            distance(between(&attempt::<M>(&Decaying, t, &y, h), y, h), Decaying.exact(t + s * h))
        });
    }
    check::<Ode45>(4.0, [0.02, 0.014, 0.01, 0.007], between, (t, s));
    check::<Ode23s>(2.0, [0.004, 0.0028, 0.002, 0.0014], between, (t, s));
}

#[test]
fn exact_dense_outputs_meet_the_step_at_both_ends() {
    let (t, h, y) = (0.4, 0.1, Turning.exact(0.4));
    for (name, a) in
        [("ode45", attempt::<Ode45>(&Turning, t, &y, h)), ("ode23s", attempt::<Ode23s>(&Turning, t, &y, h))]
    {
        let end = std::array::from_fn(|i| y[i] + h * a.dense.iter().map(|p| p[i]).sum::<f64>());
        assert!(distance(end, a.y) < 1e-14, "{name}");
        assert!(distance(a.slope, Turning.derivative(t + h, &a.y)) < 1e-14, "{name}: first same as last");
    }
    // ode45's also meets both slopes.
    let a = attempt::<Ode45>(&Turning, t, &y, h);
    assert!(distance(a.dense[0], Turning.derivative(t, &y)) < 1e-14);
    let end: [f64; 2] = std::array::from_fn(|i| (0..4).map(|j| (j + 1) as f64 * a.dense[j][i]).sum());
    assert!(distance(end, a.slope) < 1e-12);
}

#[test]
fn order_of_the_error_estimates() {
    let (t, y) = (0.4, Turning.exact(0.4));
    let size = |a: Attempt<2>| distance(a.error, [0.0; 2]);
    local_order(5.0, 0.1, [0.02, 0.014, 0.01, 0.007], |h| size(attempt::<Ode45>(&Turning, t, &y, h)));
    local_order(3.0, 0.1, [0.004, 0.0028, 0.002, 0.0014], |h| size(attempt::<Ode23s>(&Turning, t, &y, h)));
}

fn ode45_tableau() -> Vec<Vec<f64>> {
    ode45::A.iter().map(|row| row.to_vec()).collect()
}

#[test]
fn exact_conditions_of_ode45() {
    assert_eq!([4, 5, 8].map(trees::count), [8, 17, 200]);
    let a = ode45_tableau();
    for (row, c) in a.iter().zip(ode45::C) {
        assert!((row.iter().sum::<f64>() - c).abs() < 1e-15);
    }
    let b: Vec<f64> = ode45::A[6].iter().copied().chain([0.0]).collect();
    let lower: Vec<f64> = b.iter().zip(ode45::E).map(|(b, e)| b - e).collect();
    assert!(ode45::E.iter().sum::<f64>().abs() < 1e-16);
    assert!(trees::worst_violation(&a, 5, &b, 1.0) < 1e-14);
    assert!(trees::worst_violation(&a, 6, &b, 1.0) > 1e-5, "no more than order 5");
    assert!(trees::worst_violation(&a, 4, &lower, 1.0) < 1e-14);
    assert!(trees::worst_violation(&a, 5, &lower, 1.0) > 1e-5, "no more than order 4");
    for s in [0.1_f64, 0.37, 0.5, 0.83, 1.0] {
        let dense: Vec<f64> =
            ode45::DENSE.iter().map(|row| (0..4).map(|j| row[j] * s.powi(j as i32 + 1)).sum()).collect();
        assert!(trees::worst_violation(&a, 4, &dense, s) < 1e-14, "dense output at {s}");
    }
}

/// Reads DOP853's coefficients off a step in which stage `i` has the `i`-th unit vector as its slope.
fn dop853_tableau() -> (Vec<Vec<f64>>, dop853::Step<12>) {
    let unit = |k: usize| -> [f64; 12] { std::array::from_fn(|i| f64::from(i == k)) };
    let (calls, rows) = (Cell::new(0), RefCell::new(vec![vec![0.0; 12]]));
    let f = |y: &[f64; 12]| {
        rows.borrow_mut().push(y.to_vec());
        calls.set(calls.get() + 1);
        unit(calls.get())
    };
    let step = dop853::step(f, &[0.0; 12], &unit(0), 1.0);
    assert_eq!(calls.get() as u64, dop853::EVALUATIONS);
    (rows.into_inner(), step)
}

#[test]
fn exact_conditions_of_dop853() {
    let (a, step) = dop853_tableau();
    // The nodes that are rational (Hairer, Nørsett & Wanner, table II.5.4 and the code).
    let c = [1.0 / 3.0, 0.25, 4.0 / 13.0, 127.0 / 195.0, 0.6, 6.0 / 7.0, 1.0];
    for (row, c) in a[5..].iter().zip(c) {
        assert!((row.iter().sum::<f64>() - c).abs() < 1e-14, "{} {c}", row.iter().sum::<f64>());
    }
    assert!(trees::worst_violation(&a, dop853::ORDER as usize, &step.y, 1.0) < 1e-14);
    assert!(trees::worst_violation(&a, 9, &step.y, 1.0) > 1e-8, "no more than order 8");
    // Differences of the solution and embedded ones of orders 5 and 3.
    assert!(trees::worst_violation(&a, 5, &step.error5, 0.0) < 1e-14);
    assert!(trees::worst_violation(&a, 6, &step.error5, 0.0) > 1e-6);
    assert!(trees::worst_violation(&a, 3, &step.error3, 0.0) < 1e-14);
    assert!(trees::worst_violation(&a, 4, &step.error3, 0.0) > 1e-6);
}

#[test]
fn order_of_dop853_is_8() {
    fn error(problem: &impl Problem, [from, to]: [f64; 2], n: u32) -> f64 {
        // Time is a component: the step is for autonomous systems.
        let f = |&[a, b, t]: &[f64; 3]| {
            let [da, db] = problem.derivative(t, &[a, b]);
            [da, db, 1.0]
        };
        let h = (to - from) / f64::from(n);
        let [a, b] = problem.exact(from);
        let y = (0..n).fold([a, b, from], |y, _| dop853::step(f, &y, &f(&y), h).y);
        distance([y[0], y[1]], problem.exact(to))
    }
    for (name, steps, error) in [
        ("turning", [32, 40, 50, 64], &(|n| error(&Turning, [0.0, 3.0], n)) as &dyn Fn(u32) -> f64),
        ("decaying", [9, 12, 15, 20], &|n| error(&Decaying, [-1.0, 1.0], n)),
    ] {
        let errors = steps.map(|n| (1.0 / f64::from(n), error(n)));
        let found = observed_order(errors);
        // Not narrower: the slope still bends where rounding sets in. The conditions above are exact.
        assert!((found - 8.0).abs() < 0.3, "{name}: order {found}: {errors:?}");
    }
}

/// `R(z) = (1 + (1 - 2d) z) / (1 - d z)²`.
#[test]
fn exact_stability_function_of_ode23s() {
    let d = 1.0 / (2.0 + 2.0_f64.sqrt());
    for (a, b) in [(-0.5, 0.0), (-3.0, 0.0), (0.2, 1.5), (-1.0, 2.0), (-40.0, 300.0), (0.0, 5.0)] {
        let z = Complex::new(a, b);
        let expected = (z * (1.0 - 2.0 * d) + 1.0) / (Complex::from(1.0) - z * d).powi(2);
        let [re, im] = attempt::<Ode23s>(&Scalar { a, b }, 0.0, &[1.0, 0.0], 1.0).y;
        assert!((Complex::new(re, im) - expected).norm() < 1e-14 * (1.0 + expected.norm()), "{z}");
    }
}

/// The error estimate on `y' = λ y`, from the three stages of the paper in complex numbers.
#[test]
fn exact_error_estimate_of_ode23s() {
    let (d, e32, one) = (1.0 / (2.0 + 2.0_f64.sqrt()), 6.0 + 2.0_f64.sqrt(), Complex::from(1.0));
    for (a, b) in [(-0.5, 0.0), (-3.0, 1.0), (0.2, 1.5), (-40.0, 300.0)] {
        let z = Complex::new(a, b);
        let w = one - z * d;
        let k1 = z / w;
        let f1 = z * (one + k1 * 0.5);
        let k2 = (f1 - k1) / w + k1;
        let f2 = z * (one + k2);
        let k3 = (f2 - (k2 - f1) * e32 - (k1 - z) * 2.0) / w;
        let expected = (k1 - k2 * 2.0 + k3) / 6.0;
        let [re, im] = attempt::<Ode23s>(&Scalar { a, b }, 0.0, &[1.0, 0.0], 1.0).error;
        assert!((Complex::new(re, im) - expected).norm() < 1e-13 * (1.0 + expected.norm()), "{z}");
    }
}

#[test]
fn exact_ode23s_is_l_stable() {
    for z in [-1e3, -1e6, -1e9] {
        let [re, im] = attempt::<Ode23s>(&Scalar { a: z, b: 0.0 }, 0.0, &[1.0, 0.0], 1.0).y;
        assert!(re.abs() < 5.0 / -z && im == 0.0, "{z}: {re}");
    }
    // Stable on the imaginary axis, and damping at its far end.
    for b in [0.1, 1.0, 10.0, 1e3, 1e6] {
        let y = attempt::<Ode23s>(&Scalar { a: 0.0, b }, 0.0, &[1.0, 0.0], 1.0).y;
        assert!(distance(y, [0.0; 2]) <= 1.0 + 1e-15, "{b}: {y:?}");
    }
}
