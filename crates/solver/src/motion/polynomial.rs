//! Polynomials with four coefficients side by side.

use wide::f64x4;

/// Blocks of four terms of a Taylor series over one flight step.
pub const BLOCKS: usize = 5;

/// `Σ c_k s^k` with `4 B` terms: block `b` has the coefficients of `s^(4b)` to `s^(4b + 3)`.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial<const B: usize>(pub [f64x4; B]);

impl<const B: usize> Polynomial<B> {
    /// The polynomial with these coefficients, lowest order first; at most `4 B` of them.
    pub fn new(coefficients: &[f64]) -> Self {
        debug_assert!(coefficients.len() <= 4 * B, "a coefficient would be lost");
        let coefficient = |k: usize| coefficients.get(k).copied().unwrap_or(0.0);
        Self(std::array::from_fn(|b| f64x4::new(std::array::from_fn(|lane| coefficient(4 * b + lane)))))
    }

    /// The coefficient of `s^k`.
    #[inline(always)]
    pub fn coefficient(&self, k: usize) -> f64 {
        self.0[k / 4].to_array()[k % 4]
    }

    /// The polynomial with another constant term.
    #[inline(always)]
    pub fn with_constant(mut self, constant: f64) -> Self {
        self.0[0].as_mut_array()[0] = constant;
        self
    }

    /// The value at `s`: four sums in powers of `s⁴`.
    #[inline(always)]
    pub fn at(&self, s: f64) -> f64 {
        let square = s * s;
        let fourth = square * square;
        let lanes = self.0.iter().rev().fold(f64x4::ZERO, |sum, block| sum * fourth + *block);
        let [first, second, third, last] = lanes.to_array();
        (first + s * second) + square * (third + s * last)
    }

    /// The derivative.
    #[inline(always)]
    pub fn derivative(&self) -> Self {
        self.shifted(|b| {
            let k = 4.0 * b as f64;
            f64x4::new([k + 1.0, k + 2.0, k + 3.0, k + 4.0])
        })
    }

    /// The polynomial without its constant term, over `s`.
    pub fn over_s(&self) -> Self {
        self.shifted(|_| f64x4::ONE)
    }

    /// Shifts every coefficient down by one order and multiplies it by the factor of its new place.
    #[inline(always)]
    fn shifted(&self, factors: impl Fn(usize) -> f64x4) -> Self {
        Self(std::array::from_fn(|b| {
            let [_, first, second, third] = self.0[b].to_array();
            let last = self.0.get(b + 1).map_or(0.0, |next| next.to_array()[0]);
            f64x4::new([first, second, third, last]) * factors(b)
        }))
    }

    /// A bound on the fourth derivative over `[0, to]`, from the sizes of the coefficients alone.
    #[inline(always)]
    pub fn fourth_derivative_bound(&self, to: f64) -> f64 {
        let sizes = std::array::from_fn(|b| {
            let factor = |lane: usize| {
                let k = (4 * b + lane) as f64;
                (k + 1.0) * (k + 2.0) * (k + 3.0) * (k + 4.0)
            };
            let next = self.0.get(b + 1).map_or(f64x4::ZERO, |next| next.abs());
            next * f64x4::new(std::array::from_fn(factor))
        });
        Self(sizes).at(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_values_and_derivatives() {
        let p = Polynomial::<2>::new(&[3.0, -1.0, 4.0, -1.0, 5.0, -9.0]);
        assert_eq!(p.at(0.0), 3.0);
        assert_eq!(p.at(2.0), 3.0 - 2.0 + 16.0 - 8.0 + 80.0 - 288.0);
        assert_eq!(p.derivative().at(2.0), -1.0 + 16.0 - 12.0 + 160.0 - 720.0);
        assert_eq!(p.over_s().at(2.0), -1.0 + 8.0 - 4.0 + 40.0 - 144.0);
        assert_eq!(p.fourth_derivative_bound(2.0), 24.0 * 5.0 + 120.0 * 9.0 * 2.0);
        // x^k has the fourth derivative k! / (k - 4)! x^(k-4), whatever the signs.
        for k in 0..12 {
            let mut c = [0.0; 12];
            c[k] = -3.0;
            let falling = (0..4).map(|i| k as f64 - f64::from(i)).product::<f64>();
            let expected = 3.0 * falling * 2.0_f64.powi(k as i32 - 4);
            assert_eq!(Polynomial::<3>::new(&c).fourth_derivative_bound(2.0), expected, "{k}");
        }
        assert_eq!((p.coefficient(4), p.with_constant(7.0).at(0.0)), (5.0, 7.0));
    }
}
