//! Orders of ode23, DOP853, RK4 and semi-implicit Euler and of their dense outputs, and the motions they make with contacts.

use nalgebra::SMatrix;
use retune_solver::methods::{Attempt, Dop853, Euler, Ode23, OneStep, Rk4, ode23};
use retune_solver::{Contacts, Method, Response, Settings, SolverError, System, Window, simulate};
use retune_testkit::scenes::{Numbers, SSVI};

/// `x'' = -x (x² + v²) + sin 3t (x - cos t)`, solved by `x = cos t`: not linear, not autonomous.
struct Circle;

impl System<2> for Circle {
    fn derivative(&self, t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        [v, -x * (x * x + v * v) + (3.0 * t).sin() * (x - t.cos())]
    }
    fn jacobian(&self, _t: f64, _y: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        SMatrix::zeros() // explicit methods do not ask
    }
    fn time_derivative(&self, _t: f64, _y: &[f64; 2]) -> [f64; 2] {
        [0.0; 2]
    }
}

fn exact(t: f64) -> [f64; 2] {
    [t.cos(), -t.sin()]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn attempt<M: OneStep<2>>(t: f64, y: &[f64; 2], h: f64) -> Attempt<2> {
    M::attempt(&Circle, t, y, &Circle.derivative(t, y), h).expect("explicit")
}

/// Error at t = 2 after `n` equal steps from t = 0.
fn global_error<M: OneStep<2>>(n: u32) -> f64 {
    let h = 2.0 / f64::from(n);
    let end = (0..n).fold(exact(0.0), |y, k| attempt::<M>(f64::from(k) * h, &y, h).y);
    distance(end, exact(2.0))
}

/// Largest error of the dense output inside one step of length `h` from an exact value.
fn dense_error<M: OneStep<2>>(h: f64) -> f64 {
    let (t, y) = (0.3, exact(0.3));
    let dense = attempt::<M>(t, &y, h).dense;
    let at = |s: f64| -> [f64; 2] {
        std::array::from_fn(|i| y[i] + h * s * dense.iter().rev().fold(0.0, |sum, p| sum * s + p[i]))
    };
    (1..10).map(|k| f64::from(k) / 10.0).map(|s| distance(at(s), exact(t + s * h))).fold(0.0, f64::max)
}

/// The exponent of an error that falls as `h^p`, from two lengths a factor of two apart.
fn exponent(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

#[track_caller]
fn check<M: OneStep<2>>(n: u32, order: f64, longest: f64, dense_order: f64, band: f64) {
    let found = exponent(global_error::<M>(n), global_error::<M>(2 * n));
    assert!((found - order).abs() < band, "order {found}, not {order}");
    let found = exponent(dense_error::<M>(longest), dense_error::<M>(0.5 * longest)) - 1.0;
    assert!((found - dense_order).abs() < 3.0 * band, "dense output of order {found}, not {dense_order}");
}

#[test]
fn order_of_ode23_is_3_and_of_its_dense_output_3() {
    check::<Ode23>(200, 3.0, 0.02, 3.0, 0.05);
}

#[test]
fn order_of_rk4_is_4_and_of_its_dense_output_3() {
    check::<Rk4>(200, 4.0, 0.02, 3.0, 0.05);
}

#[test]
fn order_of_dop853_is_8_and_of_its_dense_output_7() {
    check::<Dop853>(10, 8.0, 0.4, 7.0, 0.3);
}

#[test]
fn order_of_semi_implicit_euler_is_1_and_of_its_chord_1() {
    check::<Euler>(1000, 1.0, 0.001, 1.0, 0.05);
}

#[test]
fn order_of_the_error_estimate_of_ode23() {
    let estimate = |h: f64| attempt::<Ode23>(0.3, &exact(0.3), h).error.map(f64::abs);
    let found = exponent(estimate(0.02)[1], estimate(0.01)[1]);
    assert!((found - 3.0).abs() < 0.1, "{found}");
}

#[test]
fn exact_coefficients_of_ode23_agree_with_one_another() {
    for (row, c) in ode23::A.iter().zip(ode23::C) {
        assert!((row.iter().sum::<f64>() - c).abs() < 1e-15);
    }
    assert!(ode23::E.iter().sum::<f64>().abs() < 1e-16);
}

/// Semi-implicit Euler is a symplectic map: its step has determinant one on an undamped oscillator.
struct Oscillator;

impl System<2> for Oscillator {
    fn derivative(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        [v, -x]
    }
    fn jacobian(&self, _t: f64, _y: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        SMatrix::<f64, 2, 2>::from_row_slice(&[0.0, 1.0, -1.0, 0.0])
    }
    fn time_derivative(&self, _t: f64, _y: &[f64; 2]) -> [f64; 2] {
        [0.0; 2]
    }
}

#[test]
fn exact_semi_implicit_euler_keeps_the_area_of_phase_space() {
    let h = 0.7;
    let image = |y: [f64; 2]| Euler::attempt(&Oscillator, 0.0, &y, &[y[1], -y[0]], h).expect("explicit").y;
    let (a, b) = (image([1.0, 0.0]), image([0.0, 1.0]));
    assert!((a[0] * b[1] - a[1] * b[0] - 1.0).abs() < 1e-15);
    assert_eq!(a, [1.0 - h * h, -h]);
}

fn run(method: Method, contacts: Contacts, rtol: f64, step: Option<f64>) -> Result<Response, SolverError> {
    let settings = Settings { method, contacts, rtol, atol: rtol * 1e-3, step, ..Settings::default() };
    simulate(&SSVI.scene(), Window { from: 0.0, to: 10.0 }, &settings)
}

/// Every method comes to the hybrid's motion, to what its order and step allow.
#[test]
fn reference_all_methods_agree_through_impacts() {
    let reference = run(Method::Hybrid, Contacts::Located, 1e-12, None).expect("runs");
    assert!(reference.impacts[0] > 5);
    for (method, contacts, rtol, step, allowed) in [
        (Method::Dop853, Contacts::Located, 1e-12, None, 1e-12),
        (Method::Dop853, Contacts::Stepped, 1e-12, None, 1e-10),
        (Method::Ode23, Contacts::Located, 1e-8, None, 1e-6),
        (Method::Ode23, Contacts::Stepped, 1e-8, None, 1e-6),
        (Method::Rk4, Contacts::Located, 1e-8, Some(1e-4), 3e-8),
        (Method::Rk4, Contacts::Stepped, 1e-8, Some(1e-4), 1e-7),
        (Method::Euler, Contacts::Located, 1e-8, Some(1e-5), 3e-5),
        (Method::Euler, Contacts::Stepped, 1e-8, Some(1e-5), 3e-5),
    ] {
        let found = run(method, contacts, rtol, step).expect("runs");
        let error = (found.e1_max.value / reference.e1_max.value - 1.0).abs();
        assert!(error < allowed, "{method:?} {contacts:?}: {error:e}");
        assert_eq!(found.impacts, reference.impacts, "{method:?} {contacts:?}");
    }
}

#[test]
fn contract_a_fixed_step_is_kept() {
    for method in [Method::Rk4, Method::Euler] {
        let work = run(method, Contacts::Stepped, 1e-6, Some(1e-3)).expect("runs").work;
        assert!((10_000..=10_001).contains(&work.steps), "{method:?}: {} steps", work.steps);
        assert_eq!(work.rejected, 0);
        let default = run(method, Contacts::Stepped, 1e-6, None).expect("runs").work;
        assert_eq!(default.steps, work.steps, "1 ms unless told");
    }
}

#[test]
fn contract_no_step_is_longer_than_allowed() {
    for method in [Method::Ode23, Method::Ode45, Method::Ode23s, Method::Dop853] {
        let work = run(method, Contacts::Stepped, 1e-2, Some(1e-3)).expect("runs").work;
        assert!(work.steps >= 9_090, "{method:?}: {} steps", work.steps); // the last of a run may be 10 % longer
    }
}

/// Beyond the limit of stability a method of fixed step has no error estimate to warn it, but infinity is noticed.
#[test]
fn contract_a_motion_that_blows_up_is_reported() {
    for method in [Method::Rk4, Method::Euler] {
        let scene = Numbers { k1: 1e9, ..SSVI }.scene();
        let settings = Settings { method, step: Some(0.1), ..Settings::default() };
        let end = simulate(&scene, Window { from: 0.0, to: 1000.0 }, &settings);
        assert!(
            matches!(end, Err(SolverError::Unstable { t }) if t > 0.0 && t < 1000.0),
            "{method:?}: {end:?}"
        );
    }
}

/// A method has one name, in studies as in tables, and no two have the same.
#[test]
fn contract_methods_are_called_what_studies_call_them() {
    for method in Method::ALL {
        let written = serde_json::to_string(&method).expect("a name");
        assert_eq!(written, format!("\"{}\"", method.name()));
        assert_eq!(serde_json::from_str::<Method>(&written).expect("the same"), method);
        assert_eq!(Method::ALL.iter().filter(|other| other.name() == method.name()).count(), 1);
    }
}
