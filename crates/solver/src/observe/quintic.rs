//! A quantity between two places where its value, slope and curvature are known, and a bound `M` on its sixth derivative.
//!
//! The quintic that meets the six numbers deviates from the quantity by at most `R = M h⁶ / 46080`, its slope by at most `√5/30000 M h⁵`,
//! and its curvature by at most `M h⁴ / 1920` (G. Birkhoff & A. Priver, J. Math. and Phys. 46, 1967). It and its derivatives stay between
//! the least and the largest of their Bernstein coefficients.

use wide::f64x4;

/// Bernstein coefficients of the quintic that meets value, slope and curvature at both ends of a stretch of length `h`.
#[inline(always)]
pub fn quintic(h: f64x4, a: [f64x4; 3], b: [f64x4; 3]) -> [f64x4; 6] {
    let (fifth, twentieth) = (h / 5.0, h * h / 20.0);
    let (inner_a, inner_b) = (a[0] + a[1] * fifth, b[0] - b[1] * fifth);
    let deep_a = inner_a + a[1] * fifth + a[2] * twentieth;
    let deep_b = inner_b - b[1] * fifth + b[2] * twentieth;
    [a[0], inner_a, deep_a, deep_b, inner_b, b[0]]
}

/// An upper bound of a quantity that deviates from its quintic by at most `remainder`: the error has three zeros at each end, so it is at
/// most `64 remainder τ³ (1 - τ)³`, and `τ³ (1 - τ)³` is a twentieth of the middle Bernstein polynomial of degree six. The other
/// coefficients of that degree are means of these six.
#[inline(always)]
pub fn highest(c: [f64x4; 6], remainder: f64x4) -> f64x4 {
    let middle = (c[2] + c[3]) * 0.5 + remainder * (64.0 / 20.0);
    c.into_iter().fold(middle, f64x4::fast_max)
}

/// The shape of a quantity on a stretch.
pub enum Shape {
    /// Its largest value is at an end.
    EndsAreLargest,
    /// It is concave, and largest inside.
    OneMaximum,
    /// The bounds do not decide.
    Unknown,
}

/// The shape of a quantity that deviates from the quintic with these coefficients by at most `remainder`: its slope deviates by at most
/// `46080 √5/30000 remainder / h`, its curvature by at most `24 remainder / h²`; the coefficients of slope and curvature are 5 and 20 times
/// the first and second differences of these.
pub fn shape(c: [f64; 6], remainder: f64) -> Shape {
    let rises: [f64; 5] = std::array::from_fn(|i| c[i + 1] - c[i]);
    let bends: [f64; 4] = std::array::from_fn(|i| rises[i + 1] - rises[i]);
    let (rise, bend) = (0.687 * remainder, 1.2 * remainder);
    let monotone = rises.iter().all(|r| *r >= rise) || rises.iter().all(|r| *r <= -rise);
    if monotone || bends.iter().all(|b| *b >= bend) {
        return Shape::EndsAreLargest;
    }
    if bends.iter().all(|b| *b < -bend) {
        // The end slopes are exact.
        return if rises[0] > 0.0 && rises[4] < 0.0 { Shape::OneMaximum } else { Shape::EndsAreLargest };
    }
    Shape::Unknown
}

/// Where the slope is zero on a stretch of length `h`, at whose start it is positive and at whose end negative: a root of the cubic that
/// meets slope and curvature at both ends.
pub fn slope_root(h: f64, a: [f64; 3], b: [f64; 3]) -> f64 {
    let (c0, c1) = (a[1], h * a[2]);
    let (c2, c3) = (3.0 * (b[1] - a[1]) - h * (2.0 * a[2] + b[2]), 2.0 * (a[1] - b[1]) + h * (a[2] + b[2]));
    let mut s = a[1] / (a[1] - b[1]);
    for _ in 0..3 {
        let (value, slope) = (c0 + s * (c1 + s * (c2 + s * c3)), c1 + s * (2.0 * c2 + s * 3.0 * c3));
        s = (s - value / slope).clamp(0.0, 1.0);
    }
    if s.is_nan() { 0.5 * h } else { s * h }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::form::QUINTIC;

    /// Value, slope and curvature at `t` of the quintic with these Bernstein coefficients on `[0, 1]`.
    fn at(coefficients: [f64; 6], t: f64) -> [f64; 3] {
        let casteljau = |mut c: Vec<f64>| {
            while c.len() > 1 {
                c = c.windows(2).map(|pair| pair[0] + t * (pair[1] - pair[0])).collect();
            }
            c[0]
        };
        let differences = |c: &[f64]| c.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
        let (rises, value) = (differences(&coefficients), casteljau(coefficients.to_vec()));
        let bends = differences(&rises);
        [value, 5.0 * casteljau(rises), 20.0 * casteljau(bends)]
    }

    fn through(h: f64, a: [f64; 3], b: [f64; 3]) -> [f64; 6] {
        quintic(h.into(), a.map(f64x4::splat), b.map(f64x4::splat)).map(|lanes| lanes.to_array()[0])
    }

    #[test]
    fn exact_the_quintic_of_a_polynomial_of_degree_five_is_that_polynomial() {
        let p = |t: f64| {
            let value = 1.0 - 2.0 * t + 3.0 * t.powi(2) - 4.0 * t.powi(3) + 5.0 * t.powi(4) - 6.0 * t.powi(5);
            let slope = -2.0 + 6.0 * t - 12.0 * t.powi(2) + 20.0 * t.powi(3) - 30.0 * t.powi(4);
            [value, slope, 6.0 - 24.0 * t + 60.0 * t.powi(2) - 120.0 * t.powi(3)]
        };
        let found = through(0.7, p(0.0), p(0.7));
        for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let ([value, slope, curvature], expected) = (at(found, t), p(0.7 * t));
            assert!((value - expected[0]).abs() < 1e-13, "{t}");
            assert!((slope / 0.7 - expected[1]).abs() < 1e-12, "{t}");
            assert!((curvature / 0.49 - expected[2]).abs() < 1e-11, "{t}");
        }
    }

    /// The error at `t` is `∫ K(t, s) f⁽⁶⁾(s) ds` with Peano's kernel, the error of the quintic of `(t - s)₊⁵ / 5!`; so the largest of
    /// `∫ |K|` is the constant, and likewise for slope and curvature.
    #[test]
    fn exact_constants_of_the_quintic_are_those_of_its_peano_kernels() {
        const POINTS: usize = 1000;
        let mut largest = [0.0_f64; 3];
        for step in 1..80 {
            let t = f64::from(step) / 80.0;
            let mut integrals = [0.0; 3];
            for point in 0..POINTS {
                let s = (point as f64 + 0.5) / POINTS as f64;
                let power = |t: f64| {
                    let x = (t - s).max(0.0);
                    [x.powi(5) / 120.0, x.powi(4) / 24.0, x.powi(3) / 6.0]
                };
                let found = at(through(1.0, power(0.0), power(1.0)), t);
                for order in 0..3 {
                    integrals[order] += (power(t)[order] - found[order]).abs() / POINTS as f64;
                }
            }
            for order in 0..3 {
                largest[order] = largest[order].max(integrals[order]);
            }
        }
        let known = [QUINTIC, 5.0_f64.sqrt() / 30000.0, 1.0 / 1920.0];
        for (found, known) in largest.into_iter().zip(known) {
            assert!((found / known - 1.0).abs() < 2e-3, "{found:e} {known:e}");
        }
        // The constants of `shape`, relative to the first and second differences of the coefficients.
        assert!(0.687 * QUINTIC >= known[1] / 5.0 && 0.687 * QUINTIC < 1.001 * known[1] / 5.0);
        assert!((1.2 * QUINTIC / (known[2] / 20.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn contract_two_maxima_are_not_taken_for_one() {
        // 1 - (4 t (1 - t) - 0.6)²: concave at both ends, a dip in the middle.
        let (a, b) = ([0.64, 4.8, -41.6], [0.64, -4.8, -41.6]);
        assert!(matches!(shape(through(1.0, a, b), 0.0), Shape::Unknown));
        let hill = ([0.0, 4.0, -8.0], [0.0, -4.0, -8.0]);
        assert!(matches!(shape(through(1.0, hill.0, hill.1), 0.33), Shape::OneMaximum));
        assert!(matches!(shape(through(1.0, hill.0, hill.1), 0.34), Shape::Unknown));
        let rise = ([0.0, 1.0, 0.0], [1.0, 1.0, 0.0]);
        assert!(matches!(shape(through(1.0, rise.0, rise.1), 0.28), Shape::EndsAreLargest));
        assert!(matches!(shape(through(1.0, rise.0, rise.1), 0.31), Shape::Unknown));
    }

    #[test]
    fn exact_the_bound_holds_what_the_remainder_allows() {
        // t³ (1 - t)³ leaves its quintic, 0, by 1/64 in the middle.
        let bound = highest([f64x4::ZERO; 6], f64x4::splat(1.0 / 64.0)).to_array()[0];
        assert!((bound - 0.05).abs() < 1e-15, "{bound}");
    }
}
