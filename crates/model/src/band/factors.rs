//! The factors of the steady response, expressed by the distances of a frequency from their zeros.
//!
//! In `u = ω²` over a unit: `|X1|² = (P/m1)² N / M` and `|X2 - X1|² = (P/m1)² u² / M` with
//! `N = (u - u_d)² + u (c2/m2)²` and `M = (u - u_1)² (u - u_2)² + u ℓ² (u - u_z)²`. `u_1 <= u_2` are the natural frequencies (of the real
//! part of the determinant), `u_d = k2/m2` that of the damper alone and `u_p = k1/m1` that of the structure; `u_z` is where the
//! imaginary part is zero, and `ℓ = c1/m1 + c2/m2 + c2/m1`. `u_d`, `u_p` and `u_z` lie between `u_1` and `u_2`. Without a damper
//! `|X1|² = (P/m1)² / M` with `M = (u - u_p)² + u (c1/m1)²`, which is the general form with `N`, `u - u_2` and `u - u_z` replaced by 1.

use super::roots::{falls, product, sum, times};
use crate::{Bare, Coupled};

/// Relative distance within which an end of a band counts as on a natural frequency.
pub const ON_RESONANCE: f64 = 8.0 * f64::EPSILON;

/// A point on the `u` axis: `u`, `u - u_1` and `u - u_2`. The smaller difference has full relative accuracy.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    u: f64,
    past_lower: f64,
    past_upper: f64,
}

impl Point {
    /// `u` of this point minus `u` of another.
    pub fn past(&self, other: &Self) -> f64 {
        if self.past_lower.abs() + other.past_lower.abs() <= self.past_upper.abs() + other.past_upper.abs() {
            self.past_lower - other.past_lower
        } else {
            self.past_upper - other.past_upper
        }
    }

    /// Distance in `u` to the nearer natural frequency.
    pub fn off_resonance(&self) -> f64 {
        self.past_lower.abs().min(self.past_upper.abs())
    }
}

/// The zeros of the factors, with their constants.
pub struct Factors {
    /// The unit of `u`, rad²/s².
    pub unit: f64,
    /// `u_p`.
    pub primary: Point,
    lower: Point,
    upper: Point,
    damper: Point,
    in_phase: Point,
    /// `(c2/m2)²` over the unit.
    loss: f64,
    /// `ℓ²` over the unit.
    drag: f64,
    /// `1 + m2/m1`, and `(c1/m1)(c2/m2)`, 1/s².
    both: [f64; 2],
    /// The slope of the factors `u - u_2` and `u - u_z`: 1, or 0 where they are the constant 1.
    slope: f64,
}

impl Factors {
    /// The factors of a structure without a damper.
    pub fn of_bare(&Bare { m1, c1, k1, .. }: &Bare, unit: f64) -> Self {
        let natural = Point { u: k1 / m1 / unit, past_lower: 0.0, past_upper: 0.0 };
        let (primary, lower, upper, damper, in_phase) = (natural, natural, natural, natural, natural);
        let drag = (c1 / m1).powi(2) / unit;
        Self { unit, primary, lower, upper, damper, in_phase, loss: 0.0, drag, both: [1.0, 0.0], slope: 0.0 }
    }

    /// The factors of a structure with a damper.
    pub fn new(system: &Coupled, unit: f64) -> Self {
        let Bare { m1, c1, k1, .. } = *system.bare();
        let (m2, k2, c2) = system.damper();
        let (primary, damper) = (k1 / m1 / unit, k2 / m2 / unit);
        let (rate_1, rate_2, back) = (c1 / m1, c2 / m2, c2 / m1);
        // (u - u_p)(u - u_d) = u s. About u_d that is x² - (u_p - u_d + s) x - s u_d, about u_p likewise.
        let s = k2 / m1 / unit + rate_1 * rate_2 / unit;
        let [lower_d, upper_d] = about(primary - damper + s, s * damper);
        let [lower_p, upper_p] = about(damper - primary + s, s * primary);
        let upper = damper + upper_d;
        // By Vieta: a difference would lose digits.
        let share = if upper > 0.0 { primary / upper } else { 0.0 };
        let lower = share * damper;
        // Sizes of the imaginary part at u_1 and u_2, by sums of terms not below zero; its signs there are opposite.
        let at_lower = rate_2 * share * (rate_1 * rate_2 / unit - lower_p) - rate_1 * lower_d;
        let at_upper = rate_2 * upper_p + back * upper + rate_1 * upper_d;
        let slope = rate_1 + rate_2 + back;
        let between = |lower: f64, upper: f64, u: f64| Point { u, past_lower: -lower, past_upper: -upper };
        let (to_lower, to_upper) =
            if slope > 0.0 { (at_lower / slope, at_upper / slope) } else { (0.0, upper_d - lower_d) };
        Self {
            unit,
            primary: between(lower_p, upper_p, primary),
            lower: between(0.0, upper_d - lower_d, lower),
            upper: between(lower_d - upper_d, 0.0, upper),
            damper: between(lower_d, upper_d, damper),
            in_phase: between(-to_lower, to_upper, lower + to_lower),
            loss: rate_2 * rate_2 / unit,
            drag: slope * slope / unit,
            both: [1.0 + m2 / m1, rate_1 * rate_2],
            slope: 1.0,
        }
    }

    /// These factors with the `N` of `m1 X1 + m2 X2`, the inertia of both masses, in place of that of X1:
    /// `|(m1 + m2) Q - m1 m2 ω²|² / (m1 m2)²`. It is the `N` of X1 with k2 and c2 larger by `1 + m2/m1`. Its zero is `u_d + s - s_0` with
    /// `s_0` the product of the rates, and by Vieta `u_d + s - u_2 = u_1 - u_p`.
    #[must_use]
    pub fn of_both_masses(self) -> Self {
        let Self { unit, primary, upper, both: [share, product], .. } = self;
        // u_1 - u_p and u_2 - u_p.
        let [lower_p, upper_p] = [-primary.past_lower, -primary.past_upper];
        let damper = Point {
            u: self.damper.u * share,
            past_lower: upper_p - product / unit,
            past_upper: lower_p - product / unit,
        };
        debug_assert!(damper.u <= upper.u * (1.0 + 1e-9));
        Self { damper, loss: self.loss * share * share, ..self }
    }

    /// The point at an end of a band, rad/s.
    pub fn end(&self, omega: f64) -> Point {
        let u = omega * omega / self.unit;
        let past = |natural: &Point| u - natural.u;
        for natural in [self.lower, self.upper] {
            if past(&natural).abs() <= 2.0 * ON_RESONANCE * u {
                return natural;
            }
        }
        Point { u, past_lower: past(&self.lower), past_upper: past(&self.upper) }
    }

    /// The points at which a band is cut, ascending.
    pub fn cuts(&self) -> [Point; 6] {
        let gap = self.upper.past_lower;
        let middle = Point { u: self.lower.u + 0.5 * gap, past_lower: 0.5 * gap, past_upper: -0.5 * gap };
        let mut cuts = [self.lower, self.damper, self.primary, self.in_phase, middle, self.upper];
        // All lie between the natural frequencies, except that heavy damping moves the damper's zero for both masses below them.
        let first = if self.damper.past_lower < 0.0 { 0 } else { 1 };
        for last in first + 1..5 {
            for i in (first + 1..=last).rev() {
                if cuts[i - 1].past(&cuts[i]) > 0.0 {
                    cuts.swap(i - 1, i);
                }
            }
        }
        cuts
    }

    /// The piece from `start` to `end`, in either direction, with no cut inside.
    pub fn piece(&self, start: &Point, end: &Point) -> Piece {
        let ends = |zero: &Point| [start.past(zero), end.past(zero)];
        // A constant factor is 1 at both ends.
        let or_one = |[a, b]: [f64; 2]| if self.slope == 0.0 { ONE } else { [a, b] };
        Piece {
            forward: if end.past(start) < 0.0 { -1.0 } else { 1.0 },
            u: [start.u, end.u],
            damper: ends(&self.damper),
            lower: [start.past_lower, end.past_lower],
            upper: or_one([start.past_upper, end.past_upper]),
            in_phase: or_one(ends(&self.in_phase)),
            loss: self.loss,
            drag: self.drag,
            slope: self.slope,
        }
    }
}

/// The roots of `x² - b x - c`, `c >= 0`, without cancellation: the first is not above zero, the second not below.
fn about(b: f64, c: f64) -> [f64; 2] {
    let far = 0.5 * b.abs() + (0.5 * b).hypot(c.sqrt());
    let near = if far > 0.0 { c / far } else { 0.0 };
    if b >= 0.0 { [-near, far] } else { [-far, near] }
}

/// The numerator `V = u^power (a + b u) N`, or without `N`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numerator {
    pub power: i32,
    /// `[a, b]`, neither below zero.
    pub weight: [f64; 2],
    /// Whether it has the factor `N`.
    pub damper: bool,
}

/// A piece of a band on which no factor changes its sign, with the factors' values at both ends. Polynomials of `s`, from 0 at the start
/// to 1 at the end, are stored as their coefficients of `(1-s)^(n-i) s^i`.
pub struct Piece {
    /// The sign of `du/ds`. Slopes are divided by its size.
    forward: f64,
    u: [f64; 2],
    damper: [f64; 2],
    lower: [f64; 2],
    upper: [f64; 2],
    in_phase: [f64; 2],
    loss: f64,
    drag: f64,
    slope: f64,
}

/// The constant 1 as a linear polynomial; multiplying by it raises the degree.
const ONE: [f64; 2] = [1.0, 1.0];

impl Piece {
    /// `u` at `s`.
    pub fn u(&self, s: f64) -> f64 {
        at(&self.u, s)
    }

    /// `V / M` at `s`.
    pub fn ratio(&self, Numerator { power, weight: [a, b], damper }: Numerator, s: f64) -> f64 {
        let [u, x, p, q, z] =
            [&self.u, &self.damper, &self.lower, &self.upper, &self.in_phase].map(|factor| at(factor, s));
        let real = p * q;
        let damper = if damper { x * x + u * self.loss } else { 1.0 };
        u.powi(power) * ((a + b * u) * damper) / (real * real + u * self.drag * z * z)
    }

    /// `V` over `u^power`, and the slope of that.
    fn numerator(&self, Numerator { weight: [a, b], damper, .. }: Numerator) -> ([f64; 4], [f64; 3]) {
        let u = &self.u;
        let (damper, slope): ([f64; 3], [f64; 2]) = if damper {
            // N' = 2 (u - u_d) + (c2/m2)²
            (
                sum(&product(&self.damper, &self.damper), &times(&product(u, &ONE), self.loss)),
                self.damper.map(|x| self.forward * (2.0 * x + self.loss)),
            )
        } else {
            (product(&ONE, &ONE), [0.0; 2])
        };
        let weight = u.map(|u| a + b * u);
        let slope = product::<2, 2, 3>(&slope, &weight);
        (product(&damper, &weight), sum(&slope, &times(&damper, b * self.forward)))
    }

    fn denominator(&self) -> ([f64; 5], [f64; 4]) {
        let (u, p, q, z) = (&self.u, &self.lower, &self.upper, &self.in_phase);
        let real: [f64; 3] = product(p, q);
        let square: [f64; 3] = product(z, z);
        let m = sum(
            &product::<3, 3, 5>(&real, &real),
            &times(&product::<4, 2, 5>(&product::<3, 2, 4>(&square, u), &ONE), self.drag),
        );
        // M' = 2 (u - u_1)(u - u_2)((u - u_1) + (u - u_2)) + ℓ² (u - u_z)((u - u_z) + 2u)
        let both = [p[0] * self.slope + q[0], p[1] * self.slope + q[1]];
        let z_and_u = [z[0] + 2.0 * self.slope * u[0], z[1] + 2.0 * self.slope * u[1]];
        let slope = sum(
            &times(&product::<3, 2, 4>(&real, &both), 2.0 * self.forward),
            &times(&product::<3, 2, 4>(&product(z, &z_and_u), &ONE), self.drag * self.forward),
        );
        (m, slope)
    }

    /// Bounds on the largest `V` and the smallest `M` of the piece.
    pub fn bounds(&self, numerator: Numerator) -> [f64; 2] {
        let ([v0, v1, v2, v3], _) = self.numerator(numerator);
        let ([m0, m1, m2, m3, m4], _) = self.denominator();
        let [a, b] = self.u;
        let by = if numerator.power < 0 { a.min(b) } else { a.max(b) }.powi(numerator.power);
        [by * v0.max(v1 / 3.0).max(v2 / 3.0).max(v3), m0.min(m1 / 4.0).min(m2 / 6.0).min(m3 / 4.0).min(m4)]
    }

    /// Visits every downward zero crossing of the slope of `V / M`.
    pub fn falls(&self, numerator: Numerator, visit: &mut impl FnMut(f64)) {
        // With V = u^j W the slope has the sign of W' M - W M', for j > 0 of (j W + u W') M - u W M', for j < 0 of u W' M - (|j| W M + u W M').
        let (v, v_slope) = self.numerator(numerator);
        let (m, m_slope) = self.denominator();
        if numerator.power == 0 {
            let (rising, falling): ([f64; 7], [f64; 7]) = (product(&v_slope, &m), product(&v, &m_slope));
            falls(bernstein(&rising, &falling), visit);
        } else {
            let j = self.forward * f64::from(numerator.power);
            let rising: [f64; 4] = product::<3, 2, 4>(&v_slope, &self.u);
            let falling: [f64; 8] = product(&product::<4, 2, 5>(&v, &self.u), &m_slope);
            let (rising, falling): ([f64; 8], [f64; 8]) = if numerator.power > 0 {
                (product(&sum(&times(&v, j), &rising), &m), falling)
            } else {
                (product(&rising, &m), sum(&times(&product::<4, 5, 8>(&v, &m), -j), &falling))
            };
            falls(bernstein(&rising, &falling), visit);
        }
    }
}

/// The Bernstein coefficients of a difference of polynomials stored by their coefficients of `(1-s)^(n-i) s^i`.
fn bernstein<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    let mut choose = 1.0;
    std::array::from_fn(|i| {
        let coefficient = (a[i] - b[i]) / choose;
        choose *= (N - 1 - i) as f64 / (i + 1) as f64;
        coefficient
    })
}

/// A linear polynomial at `s`.
fn at([a, b]: &[f64; 2], s: f64) -> f64 {
    a * (1.0 - s) + b * s
}
