//! Bounds of quantities against polynomials multiplied out.

use super::*;
use retune_model::{Bare, Forcing, NonNegative, Positive, Primary};

const MASS: f64 = 3.0;
const STIFFNESS: f64 = 50.0;

fn structure() -> Bare {
    let positive = |value| Positive::new(value).expect("above zero");
    let not_negative = |value| NonNegative::new(value).expect("not below zero");
    let primary =
        Primary { mass: positive(MASS), damping: not_negative(0.7), stiffness: not_negative(STIFFNESS) };
    Bare::new(&primary, &Forcing::force(not_negative(8.0), not_negative(2.0)))
}

/// `C(j, 6)`.
fn choose_6(j: usize) -> f64 {
    (0..6).map(|i| (j as f64 - i as f64) / (i as f64 + 1.0)).product()
}

/// `Σ_{j >= 6} |q_j| hʲ C(j, 6) / 64` of the coefficients of a quantity in time.
fn expected(q: &[f64], h: f64) -> f64 {
    (6..q.len()).map(|j| q[j].abs() * h.powi(j as i32) * choose_6(j) / 64.0).sum()
}

#[test]
fn exact_error_of_a_quintic_is_that_of_the_product_of_the_motions() {
    let structure = structure();
    let coefficients = |seed: f64| -> Vec<f64> {
        (0..TERMS).map(|k| (seed + 1.7 * k as f64).sin() * 2.0_f64.powi(-(k as i32) / 2)).collect()
    };
    let (x, v) = (coefficients(0.4), coefficients(2.9));
    let motion = [Polynomial::<BLOCKS>::new(&x), Polynomial::new(&v)];
    let square = |row: &[f64]| -> Vec<f64> {
        let mut product = vec![0.0; 2 * row.len() - 1];
        for (i, a) in row.iter().enumerate() {
            row.iter().enumerate().for_each(|(k, b)| product[i + k] += a * b);
        }
        product
    };
    let energy = Form::energy(&structure, structure.primary_energy_weights(), [0, 1]);
    let q: Vec<f64> =
        square(&x).iter().zip(square(&v)).map(|(x, v)| 0.5 * (STIFFNESS * x + MASS * v)).collect();
    for h in [0.3, 1.0, 1.4] {
        let found = energy.quintic_error(&motion, h);
        assert!((found / expected(&q, h) - 1.0).abs() < 1e-12, "{h}: {found} {}", expected(&q, h));
        let linear = Form::linear(&structure, [2.0, -0.5]);
        let row: Vec<f64> = x.iter().zip(&v).map(|(x, v)| 2.0 * x - 0.5 * v).collect();
        let found = linear.quintic_error(&motion, h);
        assert!((found / expected(&row, h) - 1.0).abs() < 1e-12, "{h}: {found} {}", expected(&row, h));
        // 2 x - 0.5 v + 3 v': the derivative of a polynomial has one term less.
        let rated = Form::rated(&structure, [2.0, -0.5], [0.0, 3.0]);
        let slope = (0..TERMS).map(|k| v.get(k + 1).map_or(0.0, |next| 3.0 * (k + 1) as f64 * next));
        let with_rate: Vec<f64> = row.iter().zip(slope).map(|(a, b)| a + b).collect();
        let (found, expected) = (rated.quintic_error(&motion, h), expected(&with_rate, h));
        assert!((found / expected - 1.0).abs() < 1e-12, "{h}: {found} {expected}");
    }
}

#[test]
fn exact_size_is_the_quantity_with_every_term_by_its_size() {
    let structure = structure();
    let energy = Form::energy(&structure, structure.primary_energy_weights(), [0, 1]);
    let expected = 0.5 * (STIFFNESS * 0.04 + MASS * 0.09);
    assert!((energy.size(&[-0.2, 0.3]) / expected - 1.0).abs() < 1e-14);
    assert!((Form::linear(&structure, [2.0, -0.5]).size(&[-0.2, 0.3]) / 0.55 - 1.0).abs() < 1e-14);
    // v' = (8 cos 2t - 0.7 v - 50 x) / 3.
    let rated = Form::rated(&structure, [2.0, -0.5], [0.0, 3.0]).size(&[-0.2, 0.3]);
    assert!((rated / (0.55 + 8.0 + 0.21 + 10.0) - 1.0).abs() < 1e-14, "{rated}");
}

/// Free and undamped, `x = cos νt`: the sixth derivatives of row and energy are at most what the bounds say, and those of a free
/// motion are reached.
#[test]
fn exact_bounds_in_flight_of_a_free_oscillation() {
    let none = NonNegative::new(0.0).expect("zero");
    let (m, k) = (Positive::new(MASS).expect("a mass"), NonNegative::new(STIFFNESS).expect("a stiffness"));
    let free = Bare::new(&Primary { mass: m, damping: none, stiffness: k }, &Forcing::force(none, none));
    let natural = (STIFFNESS / MASS).sqrt();
    // √(2E) of an amplitude of 1.
    let energy = STIFFNESS.sqrt();
    let bounds: [[f64; 2]; 7] = derivative_bounds(&free, [1.0, 0.0]);
    for (order, [slope, offset]) in bounds.into_iter().enumerate() {
        assert!((slope * energy / natural.powi(order as i32) - 1.0).abs() < 1e-12, "{order}");
        assert_eq!(offset, 0.0);
    }
    let linear = Form::linear(&free, [1.0, 0.0]).sixth_in_flight(energy);
    assert!((linear / natural.powi(6) - 1.0).abs() < 1e-12, "{linear}");
    let rated = Form::rated(&free, [0.0, 0.0], [0.0, 1.0]).sixth_in_flight(energy);
    assert!((rated / natural.powi(8) - 1.0).abs() < 1e-12, "{rated}");
    // Of the energy, the part that no other force changes: v G with G = 0.
    let constant = Form::energy(&free, [MASS, STIFFNESS], [0, 1]).sixth_in_flight(energy);
    assert!(constant < 1e-9 * STIFFNESS * natural.powi(6), "{constant}");
}
