//! Intervals of real numbers with outward rounding.
//!
//! IEEE 754 rounds each sum, product, quotient and square root to the nearest double, so the exact result lies between the neighbours of the
//! rounded one, `next_down` and `next_up`; in the subnormal range and at overflow too. A NaN result encloses nothing, and becomes the
//! whole line.

use serde::Serialize;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// All real numbers from `lo` to `hi`, both included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(into = "[f64; 2]")]
pub struct Interval {
    lo: f64,
    hi: f64,
}

/// A lower bound on the exact result that was rounded to `x`.
fn below(x: f64) -> f64 {
    if x.is_nan() { f64::NEG_INFINITY } else { x.next_down() }
}

/// An upper bound on the exact result.
fn above(x: f64) -> f64 {
    if x.is_nan() { f64::INFINITY } else { x.next_up() }
}

impl Interval {
    /// The number zero.
    pub const ZERO: Self = Self::point(0.0);
    /// The number one.
    pub const ONE: Self = Self::point(1.0);
    /// All real numbers, for instance after a division by zero.
    pub const ENTIRE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// One double, exactly.
    pub const fn point(x: f64) -> Self {
        Self { lo: x, hi: x }
    }

    /// The numbers between two doubles, in either order; the whole line if one is NaN.
    pub fn new(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() { Self::ENTIRE } else { Self { lo: a.min(b), hi: a.max(b) } }
    }

    /// `[-r, r]`.
    pub fn around_zero(r: f64) -> Self {
        Self::new(-r, r)
    }

    /// An enclosure of the decimal number that was read as `x`: between the neighbours of `x`, and `x` itself if it is whole.
    pub fn decimal(x: f64) -> Self {
        let whole = x.fract() == 0.0 && x.abs() < 9_007_199_254_740_992.0; // 2^53
        if whole { Self::point(x) } else { Self::new(x.next_down(), x.next_up()) }
    }

    /// The least number.
    pub const fn lo(self) -> f64 {
        self.lo
    }

    /// The greatest number.
    pub const fn hi(self) -> f64 {
        self.hi
    }

    /// A double near the middle.
    pub fn mid(self) -> f64 {
        0.5 * self.lo + 0.5 * self.hi
    }

    /// An upper bound on the width.
    pub fn width(self) -> f64 {
        above(self.hi - self.lo)
    }

    /// The largest absolute value.
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// Whether both bounds are finite.
    pub fn is_bounded(self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// Whether `x` is one of the numbers.
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Whether it is a subset of another interval.
    pub fn is_in(self, other: Self) -> bool {
        other.lo <= self.lo && self.hi <= other.hi
    }

    /// Whether it is in the interior of another interval.
    pub fn is_inside(self, other: Self) -> bool {
        other.lo < self.lo && self.hi < other.hi
    }

    /// Whether all numbers are above zero.
    pub fn is_positive(self) -> bool {
        self.lo > 0.0
    }

    /// Whether all numbers are below zero.
    pub fn is_negative(self) -> bool {
        self.hi < 0.0
    }

    /// The smallest interval with the numbers of both.
    pub fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// The intersection; none if it is empty.
    pub fn meet(self, other: Self) -> Option<Self> {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        (lo <= hi).then_some(Self { lo, hi })
    }

    /// Wider by `by` on both sides.
    pub fn wider(self, by: f64) -> Self {
        Self { lo: below(self.lo - by), hi: above(self.hi + by) }
    }

    /// The squares of the numbers.
    pub fn square(self) -> Self {
        let Self { lo, hi } = self.abs();
        Self { lo: below(lo * lo).max(0.0), hi: above(hi * hi) }
    }

    /// The square roots of the numbers; the whole line if some are negative.
    pub fn sqrt(self) -> Self {
        if self == Self::ZERO {
            self
        } else if self.lo >= 0.0 {
            Self { lo: below(self.lo.sqrt()).max(0.0), hi: above(self.hi.sqrt()) }
        } else {
            Self::ENTIRE
        }
    }

    /// The absolute values of the numbers.
    pub fn abs(self) -> Self {
        self.max(-self).max(Self::ZERO)
    }

    /// The maxima of a number of each.
    pub fn max(self, other: Self) -> Self {
        Self { lo: self.lo.max(other.lo), hi: self.hi.max(other.hi) }
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        // Adding zero is exact: sums begin with it.
        match (self, other) {
            (Self::ZERO, x) | (x, Self::ZERO) => x,
            _ => Self { lo: below(self.lo + other.lo), hi: above(self.hi + other.hi) },
        }
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        if self == Self::ZERO || other == Self::ZERO {
            return Self::ZERO;
        }
        if self == Self::ONE {
            return other;
        }
        if other == Self::ONE {
            return self;
        }
        hull_of([self.lo * other.lo, self.lo * other.hi], [self.hi * other.lo, self.hi * other.hi])
    }
}

impl Div for Interval {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if other.contains(0.0) {
            return Self::ENTIRE;
        }
        hull_of([self.lo / other.lo, self.lo / other.hi], [self.hi / other.lo, self.hi / other.hi])
    }
}

/// The interval between the extremes of four rounded results.
fn hull_of([a, b]: [f64; 2], [c, d]: [f64; 2]) -> Interval {
    // `min` and `max` ignore NaN.
    if (a + b + c + d).is_nan() {
        return Interval::ENTIRE;
    }
    Interval { lo: below(a.min(b).min(c.min(d))), hi: above(a.max(b).max(c.max(d))) }
}

impl From<Interval> for [f64; 2] {
    fn from(Interval { lo, hi }: Interval) -> Self {
        [lo, hi]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt;

    /// Only tests format intervals.
    impl fmt::Display for Interval {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "[{}, {}]", self.lo, self.hi)
        }
    }

    /// A small generator (Steele, Lea and Flood's SplitMix64).
    pub struct Draws(u64);

    impl Draws {
        fn bits(&mut self) -> u64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        }

        /// A double of either sign, from 2^-40 to 2^40.
        fn number(&mut self) -> f64 {
            let exponent = 1023 - 40 + self.bits() % 80;
            f64::from_bits((self.bits() & 0x800f_ffff_ffff_ffff) | exponent << 52)
        }

        /// An interval of any width and a number in it.
        fn interval(&mut self) -> (Interval, f64) {
            let (a, b) = (self.number(), self.number());
            let interval = if self.bits() & 1 == 0 { Interval::new(a, b) } else { Interval::point(a) };
            let share = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
            (interval, (interval.lo + share * (interval.hi - interval.lo)).clamp(interval.lo, interval.hi))
        }
    }

    /// The signs of the exact differences of product, quotient and root from the bounds are those of one fused multiply-add, which rounds
    /// once; that of the sum follows from its rounding error (T. J. Dekker and D. E. Knuth).
    #[test]
    fn exact_results_are_in_the_intervals_of_a_million_draws() {
        let mut draws = Draws(41);
        for _ in 0..1_000_000 {
            let ((a, x), (b, y)) = (draws.interval(), draws.interval());
            let sum = a + b;
            let s = x + y;
            let rest = s - x;
            let error = (x - (s - rest)) + (y - rest);
            assert!(sum.lo - s <= error && error <= sum.hi - s, "{x:e} + {y:e} is not in {sum}");
            let product = a * b;
            assert!(x.mul_add(y, -product.lo) >= 0.0, "{x:e} * {y:e} is below {product}");
            assert!(x.mul_add(y, -product.hi) <= 0.0, "{x:e} * {y:e} is above {product}");
            let quotient = a / b;
            let sign = y.signum();
            assert!(sign * quotient.lo.mul_add(y, -x) <= 0.0, "{x:e} / {y:e} is below {quotient}");
            assert!(sign * quotient.hi.mul_add(y, -x) >= 0.0, "{x:e} / {y:e} is above {quotient}");
            let square = a.square();
            assert!(x.mul_add(x, -square.lo) >= 0.0 && x.mul_add(x, -square.hi) <= 0.0, "{x:e}²: {square}");
            let (root, x) = (a.abs().sqrt(), x.abs());
            assert!(root.lo.mul_add(root.lo, -x) <= 0.0, "√{x:e} is below {root}");
            assert!(root.hi.mul_add(root.hi, -x) >= 0.0, "√{x:e} is above {root}");
        }
    }

    /// 0.001 to 0.999 and more, most of them not doubles: a fused multiply-add decides on which side of `n/1000` a bound is.
    #[test]
    fn exact_a_decimal_is_in_the_interval_of_the_double_that_is_read() {
        for n in 1..10_000 {
            let n = f64::from(n);
            let x = Interval::decimal(n / 1000.0);
            assert!(x.lo.mul_add(1000.0, -n) <= 0.0 && x.hi.mul_add(1000.0, -n) >= 0.0, "{n}/1000: {x}");
            assert!(
                x.width() <= 1e-15 * x.hi && (n % 1000.0 != 0.0 || x == Interval::point(n / 1000.0)),
                "{x}"
            );
        }
    }

    #[test]
    fn contract_what_is_not_known_is_the_whole_line() {
        let [zero, all] = [Interval::new(-1.0, 1.0), Interval::ENTIRE];
        assert_eq!(Interval::ONE / zero, all);
        assert_eq!(Interval::new(-1.0, 2.0).sqrt(), all);
        assert_eq!(Interval::new(f64::NAN, 0.0), all);
        assert_eq!(all - all, all);
        assert_eq!(all * Interval::new(0.0, 1.0), all);
        assert!((Interval::point(f64::MAX) * Interval::point(2.0)).contains(f64::MAX));
        assert!(!all.is_bounded() && all.is_in(all) && !all.is_inside(Interval::ONE));
    }
}
