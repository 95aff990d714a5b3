//! Functions of one parameter: polynomials with a remainder bound (Taylor models, K. Makino and M. Berz, Int. J. Pure Appl. Math. 6 (2003)
//! 239).
//!
//! Coefficients are doubles; their rounding errors go into the rest. A constant is a polynomial of one term, and costs no more than an
//! interval.

use crate::{Interval, cos_sin};
use std::array;
use std::ops::{Add, Mul, Neg, Sub};

/// Terms that are kept.
const TERMS: usize = 8;
/// A sum or product of doubles is off by at most this share of the rounded result (IEEE 754, to nearest).
const UNIT: f64 = 0.5 * f64::EPSILON;

/// All functions of `s` from -1 to 1 that are nowhere farther than `rest` from `Σ cₖ sᵏ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taylor {
    c: [f64; TERMS],
    /// The coefficients from here on are zero.
    used: usize,
    rest: f64,
}

/// A bound on a sum of fewer than 100 products of positive numbers that was computed as `x`; 2⁻¹⁰²² covers underflow.
fn bound(x: f64) -> f64 {
    x * (1.0 + 256.0 * f64::EPSILON) + f64::MIN_POSITIVE
}

impl Taylor {
    /// Zero.
    pub const ZERO: Self = Self { c: [0.0; TERMS], used: 0, rest: 0.0 };

    /// The polynomial `middle + slope s`.
    pub fn line(middle: f64, slope: f64) -> Self {
        let mut c = [0.0; TERMS];
        (c[0], c[1]) = (middle, slope);
        Self { c, used: if slope == 0.0 { 1 } else { 2 }, rest: 0.0 }
    }

    /// A constant, exactly.
    pub fn point(x: f64) -> Self {
        Self::line(x, 0.0)
    }

    /// The polynomial alone.
    pub fn polynomial(self) -> Self {
        Self { rest: 0.0, ..self }
    }

    /// The remainder: the difference of a function from the polynomial.
    pub fn rest(self) -> Interval {
        Interval::around_zero(self.rest)
    }

    /// Whether the polynomial is a constant.
    pub fn is_constant(self) -> bool {
        self.used <= 1
    }

    /// The polynomial at zero.
    pub fn mid(self) -> f64 {
        self.c[0]
    }

    /// The polynomial at `s`, also beyond 1, to rounding.
    pub fn near(self, s: f64) -> f64 {
        self.c.iter().rev().fold(0.0, |sum, c| sum * s + c)
    }

    /// All values of all the functions. An even power is between 0 and 1.
    pub fn hull(self) -> Interval {
        let other_end = |k: usize| if k.is_multiple_of(2) { 0.0 } else { -self.c[k] };
        let range = |k: usize| Interval::new(if k == 0 { self.c[0] } else { other_end(k) }, self.c[k]);
        let all = (0..self.used).rev().fold(self.rest(), |sum, k| sum + range(k));
        if all.is_bounded() { all } else { Interval::ENTIRE }
    }

    /// The functions on the part from `middle - half` to `middle + half`, as functions from -1 to 1.
    pub fn part(self, [middle, half]: [f64; 2]) -> Self {
        let s = Self::line(middle, half);
        let value = |sum: Self, k: usize| sum * s + Self::point(self.c[k]);
        let all = (0..self.used).rev().fold(Self::ZERO, value);
        Self { rest: bound(all.rest + self.rest), ..all }
    }

    /// The sum of the absolute values of the coefficients.
    fn size(self) -> f64 {
        self.c[..self.used].iter().map(|c| c.abs()).sum()
    }
}

/// A number type of the proofs, with sums, products and some functions.
pub trait Number: Copy + Add<Output = Self> + Neg<Output = Self> + Mul<Output = Self> {
    /// A constant.
    fn constant(value: Interval) -> Self;
    /// A function of the parameter.
    fn of(function: Taylor) -> Self;
    /// A multiple by a constant.
    fn times(self, factor: Interval) -> Self {
        self * Self::constant(factor)
    }
    /// `[cos x, sin x]`.
    fn cos_sin(self) -> [Self; 2];
    /// `1/x`.
    fn reciprocal(self) -> Self;
}

impl Number for Interval {
    fn constant(value: Interval) -> Self {
        value
    }

    fn of(function: Taylor) -> Self {
        function.hull()
    }

    fn cos_sin(self) -> [Self; 2] {
        cos_sin(self)
    }

    fn reciprocal(self) -> Self {
        Self::ONE / self
    }
}

impl Number for Taylor {
    fn constant(value: Interval) -> Self {
        Self::from(value)
    }

    fn of(function: Taylor) -> Self {
        function
    }

    fn times(self, factor: Interval) -> Self {
        if factor == Interval::ONE { self } else { self * Self::from(factor) }
    }

    /// The remainder is infinite where a function may be zero. With any polynomial `p` and `e = 1 - f p` the reciprocal is `p/(1 - e)`,
    /// which differs from `p` by at most `|p| |e| / (1 - |e|)`.
    fn reciprocal(self) -> Self {
        let mut c = [0.0; TERMS];
        let used = if self.used > 1 { TERMS } else { 1 };
        c[0] = 1.0 / self.c[0];
        for k in 1..used {
            c[k] = -c[0] * (1..=k).map(|j| self.c[j] * c[k - j]).sum::<f64>();
        }
        let p = Self { c, used, rest: 0.0 };
        let off = (Self::point(1.0) - self * p).hull().magnitude();
        let rest = if off < 0.5 { bound(p.size() * (off / (1.0 - off))) } else { f64::INFINITY };
        Self { rest, ..p }
    }

    /// By the addition theorems for the value at zero and the difference from it.
    fn cos_sin(self) -> [Self; 2] {
        let [c, s] = cos_sin(Interval::point(self.c[0])).map(Self::from);
        let [cos, sin] = near_zero(self - Self::point(self.c[0]), CIRCLE);
        [c * cos - s * sin, s * cos + c * sin]
    }
}

/// Terms of the series of sine and cosine.
const CIRCLE: u32 = 12;

/// `[cos f, sin f]` by Taylor's series; for `|f| < 1` its terms alternate and decrease, so the truncation error is at most the first
/// omitted term.
fn near_zero(f: Taylor, terms: u32) -> [Taylor; 2] {
    let minus_square = -(f * f);
    let series = |first: Taylor, offset: u32| {
        let (mut term, mut sum) = (first, first);
        for k in 0..terms {
            let n = f64::from(2 * k + offset);
            let share = Interval::ONE / Interval::point((n + 1.0) * (n + 2.0));
            term = term * minus_square * Taylor::from(share);
            sum = sum + term;
        }
        // The last term is counted in the rest, too, as a bound on the truncation error.
        Taylor { rest: bound(sum.rest + term.hull().magnitude()), ..sum }
    };
    if f.hull().magnitude() < 1.0 {
        [series(Taylor::point(1.0), 0), series(f, 1)]
    } else {
        [Taylor::from(Interval::new(-1.0, 1.0)); 2]
    }
}

impl From<Interval> for Taylor {
    fn from(x: Interval) -> Self {
        if x == Interval::ZERO {
            return Self::ZERO;
        }
        let middle = if x.is_bounded() { x.mid() } else { 0.0 };
        Self { rest: (x - Interval::point(middle)).magnitude(), ..Self::point(middle) }
    }
}

impl Add for Taylor {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if self == Self::ZERO {
            return other;
        }
        if other == Self::ZERO {
            return self;
        }
        let c = array::from_fn(|k| self.c[k] + other.c[k]);
        let sum = Self { c, used: self.used.max(other.used), rest: self.rest + other.rest };
        Self { rest: bound(sum.rest + UNIT * sum.size()), ..sum }
    }
}

impl Neg for Taylor {
    type Output = Self;

    fn neg(self) -> Self {
        Self { c: self.c.map(|c| -c), ..self }
    }
}

impl Sub for Taylor {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Taylor {
    type Output = Self;

    /// Each coefficient is a sum of at most `n` products, with an error of `n` roundings of the sum of their absolute values; omitted terms
    /// are at most their coefficients.
    fn mul(self, other: Self) -> Self {
        if self == Self::ZERO || other == Self::ZERO {
            return Self::ZERO;
        }
        let (mut c, mut beyond) = ([0.0; TERMS], 0.0);
        for (i, a) in self.c[..self.used].iter().enumerate() {
            let kept = other.used.min(TERMS - i);
            for (c, b) in c[i..].iter_mut().zip(&other.c[..kept]) {
                *c += a * b;
            }
            beyond += other.c[kept..other.used].iter().map(|b| b.abs()).sum::<f64>() * a.abs();
        }
        let (a, b) = (self.size(), other.size());
        let rounded = UNIT * self.used.min(other.used) as f64 * (a * b);
        let rest = beyond + rounded + a * other.rest + b * self.rest + self.rest * other.rest;
        let used = if self.used * other.used == 0 { 0 } else { (self.used + other.used - 1).min(TERMS) };
        Self { c, used, rest: bound(rest) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small generator of numbers from -1 to 1 (D. H. Lehmer).
    fn draw(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A polynomial of small whole numbers over a power of two, whose values at `-1`, `-1/2`, `1/2` and `1` are exact in doubles.
    fn whole(seed: &mut u64, terms: usize) -> Taylor {
        let mut c = [0.0; TERMS];
        c[..terms].iter_mut().for_each(|c| *c = (draw(seed) * 1000.0).round() / 64.0);
        Taylor { c, used: terms, rest: 0.0 }
    }

    const PLACES: [f64; 4] = [-1.0, -0.5, 0.5, 1.0];

    /// Values of a polynomial and its bounds there.
    fn at(f: Taylor, s: f64) -> Interval {
        f.part([s, 0.0]).hull()
    }

    #[test]
    fn exact_sums_and_products_are_enclosed_with_what_is_cut_off() {
        let mut seed = 41;
        for n in 0..2000 {
            let (f, g) = (whole(&mut seed, 1 + n % TERMS), whole(&mut seed, 1 + n / TERMS % TERMS));
            for s in PLACES {
                let (a, b) = (f.near(s), g.near(s));
                assert!(at(f + g, s).contains(a + b) && at(f - g, s).contains(a - b), "{f:?} {g:?}");
                assert!(at(f * g, s).contains(a * b) && (f * g).hull().contains(a * b), "{f:?} {g:?} {s}");
                assert!(f.hull().contains(a) && f.part([0.5 * s, 0.5]).hull().contains(a), "{f:?} {s}");
            }
        }
    }

    /// The rest contains the rounding error of a sum and of a product of two numbers; a fused multiply-add gives its sign.
    #[test]
    fn exact_roundings_are_in_the_rest() {
        let mut seed = 7;
        for _ in 0..100_000 {
            let (x, y) = (draw(&mut seed), 1e3 * draw(&mut seed));
            let product = Taylor::point(x) * Taylor::point(y);
            assert!(x.mul_add(y, -product.c[0]).abs() <= product.rest, "{x} {y}");
            let (sum, s) = (Taylor::point(x) + Taylor::point(y), x + y);
            let rest = s - x;
            let error = (x - (s - rest)) + (y - rest);
            assert!(sum.c[0] == s && error.abs() <= sum.rest && sum.rest < 1e-12, "{x} {y}");
        }
    }

    #[test]
    fn exact_a_number_times_its_reciprocal_is_one() {
        let mut seed = 3;
        for n in 0..500 {
            let f = Taylor::point(100.0) + whole(&mut seed, 1 + n % 4);
            for s in PLACES {
                let one = at(f, s) * at(f.reciprocal(), s);
                assert!(one.contains(1.0) && one.width() < 0.1, "{f:?} {one}");
            }
        }
        assert_eq!(Taylor::line(0.5, 0.6).reciprocal().hull(), Interval::ENTIRE);
    }

    #[test]
    fn exact_cosine_and_sine_are_those_of_intervals() {
        for (middle, slope) in [(0.3, 0.1), (7.0, -0.4), (-2.0, 0.9)] {
            let [cos, sin] = Taylor::line(middle, slope).cos_sin();
            for s in PLACES {
                let [c, d] = cos_sin(Interval::point(middle) + Interval::point(slope) * Interval::point(s));
                assert!(c.is_in(at(cos, s)) && d.is_in(at(sin, s)), "{middle} {slope} {s}");
                assert!(at(cos, s).width() < 1e-3, "{} {c}", at(cos, s));
            }
        }
    }

    /// With few terms, so that the truncation error is far above rounding.
    #[test]
    fn exact_short_series_of_cosine_and_sine_hold_those_of_intervals() {
        for terms in 1..CIRCLE {
            let [cos, sin] = near_zero(Taylor::line(0.0, 0.9), terms);
            for s in PLACES {
                let [c, d] = cos_sin(Interval::point(0.9) * Interval::point(s));
                assert!(c.is_in(at(cos, s)) && d.is_in(at(sin, s)), "{terms} {s}: {c} {d}");
            }
        }
    }
}
