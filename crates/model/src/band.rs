//! The largest steady response over a band of frequencies, in closed form: no narrow peak can hide between samples, for there
//! are none.
//!
//! With `u = ω²` the square of an amplitude is `N / M`, two polynomials in `u`, so it is largest at an end of the band or where
//! the sign of its slope, that of `W = N' M - N M'` (of degree 6 at most), falls through zero. The roots of `W` are isolated by
//! halving: on an interval its Bernstein coefficients change sign at least as often as it has roots, and if once, exactly once
//! (Descartes' rule of signs; R. T. Farouki, The Bernstein polynomial basis, Comput. Aided Geom. Des. 29, 2012).
//! A root of `W` is simple however narrow the peak, so its place is found to rounding, and the value there is that of
//! [`Steady`](crate::Steady).

use crate::{Bare, Coupled};
use std::ops::{Add, Mul, Sub};

/// A largest value over a band, and where it is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// The angular frequency, rad/s.
    pub frequency: f64,
}

impl Bare {
    /// Largest steady E1max, J, over the band `[from, to]` of angular frequencies, rad/s, `0 < from <= to`. Infinite, or
    /// as large as rounding allows, at the resonance of an undamped structure.
    pub fn steady_e1_max(&self, band: [f64; 2]) -> Worst {
        let mut search = Search::new(|omega| self.steady(omega).e1_max);
        for (piece, weight) in pieces(self, band) {
            search.over(piece, |u| {
                let [real, imaginary] = self.impedance(u);
                [weight(u), real * real + u * imaginary * imaginary]
            });
        }
        search.worst
    }

    /// `k1 - m1 ω² + iω c1` as real part and imaginary part over `ω`.
    fn impedance(&self, u: Polynomial) -> [Polynomial; 2] {
        [constant(self.k1) - u * constant(self.m1), constant(self.c1)]
    }
}

impl Coupled {
    /// Largest steady E1max, J, over the band `[from, to]` of angular frequencies, rad/s, `0 < from <= to`, as long as the
    /// damper touches neither wall (compare [`Self::steady_stroke_max`] with `D` and `C`). Infinite, or as large as
    /// rounding allows, at the resonance of an undamped system.
    pub fn steady_e1_max(&self, band: [f64; 2]) -> Worst {
        let (m2, k2, c2) = self.damper();
        let mut search = Search::new(|omega| self.steady(omega).e1_max);
        for (piece, weight) in pieces(self.bare(), band) {
            search.over(piece, |u| {
                let dynamic = constant(k2) - u * constant(m2);
                [(dynamic * dynamic + u * constant(c2 * c2)) * weight(u), self.resonance(u)]
            });
        }
        search.worst
    }

    /// Largest amplitude `|X1|`, m, of the primary structure over a band; as [`Self::steady_e1_max`].
    pub fn steady_displacement_max(&self, band: [f64; 2]) -> Worst {
        let (m2, k2, c2) = self.damper();
        let mut search = Search::new(|omega| self.steady(omega).x1.norm());
        search.over(band, |u| {
            let dynamic = constant(k2) - u * constant(m2);
            [dynamic * dynamic + u * constant(c2 * c2), self.resonance(u)]
        });
        search.worst
    }

    /// Largest steady stroke (spring deflection) `|X2 - X1|`, m, over a band; as [`Self::steady_e1_max`].
    pub fn steady_stroke_max(&self, band: [f64; 2]) -> Worst {
        let mut search = Search::new(|omega| self.steady(omega).stroke());
        search.over(band, |u| [u * u, self.resonance(u)]); // X2 - X1 = P m2 ω² / (S d - m2 ω² Q)
        search.worst
    }

    /// `|S d - m2 ω² Q|²` of [`Self::steady`].
    fn resonance(&self, u: Polynomial) -> Polynomial {
        let (m2, k2, c2) = self.damper();
        let [primary, c1] = self.bare().impedance(u);
        let (inertia, c2) = (u * constant(m2), constant(c2));
        let dynamic = constant(k2) - inertia;
        let real = primary * dynamic - u * c1 * c2 - inertia * constant(k2);
        let imaginary = primary * c2 + dynamic * c1 - inertia * c2;
        real * real + u * imaginary * imaginary
    }
}

/// What E1max is as a multiple of `|X1|²`, but for a factor.
type Weight = fn(Polynomial) -> Polynomial;

/// The band below the natural frequency of the structure, where E1max is that of its spring, and above, where it is that of
/// its mass.
fn pieces(bare: &Bare, [from, to]: [f64; 2]) -> [([f64; 2], Weight); 2] {
    let natural = (bare.k1 / bare.m1).sqrt().clamp(from, to.max(from));
    [([from, natural], |_| constant(1.0)), ([natural, to], |u| u)]
}

/// The largest of a function of ω among the places looked at so far.
struct Search<F> {
    value: F,
    worst: Worst,
}

impl<F: Fn(f64) -> f64> Search<F> {
    fn new(value: F) -> Self {
        Self { value, worst: Worst { value: f64::NEG_INFINITY, frequency: f64::NAN } }
    }

    fn note(&mut self, frequency: f64) {
        let value = (self.value)(frequency);
        let value = if value.is_nan() { f64::INFINITY } else { value }; // 0/0 where nothing resists the force
        if value > self.worst.value {
            self.worst = Worst { value, frequency };
        }
    }

    /// Looks at both ends of a band and at every maximum between, where `squared(u) = [N, M]`.
    fn over(&mut self, [from, to]: [f64; 2], squared: impl Fn(Polynomial) -> [Polynomial; 2]) {
        self.note(from);
        if to <= from {
            return;
        }
        let (low, width) = (from * from, (to - from) * (to + from));
        let [n, m] = squared(linear(low, width));
        let w = (n.slope() * m - n * m.slope()).bernstein();
        let mut halvings = HALVINGS;
        falls(w, [0.0, 1.0], &mut halvings, &mut |s| self.note((low + width * s).sqrt()));
        self.note(to);
    }
}

/// Most halvings of a band. Six roots need a few dozen; only roots that rounding cannot tell apart would need more.
const HALVINGS: u32 = 200;

/// Visits every place where a polynomial, by its Bernstein coefficients on `[a, b]`, falls through zero.
fn falls(w: [f64; 7], [a, b]: [f64; 2], halvings: &mut u32, visit: &mut impl FnMut(f64)) {
    let mut signs = w.into_iter().filter(|c| *c != 0.0).map(|c| c > 0.0);
    let Some(first) = signs.next() else { return };
    let (_, changes) =
        signs.fold((first, 0), |(last, changes), sign| (sign, changes + u32::from(sign != last)));
    let middle = 0.5 * (a + b);
    if changes == 1 && first {
        visit(a + (b - a) * root(&w));
    } else if changes > 1 && *halvings == 0 {
        visit(middle);
    } else if changes > 1 {
        *halvings -= 1;
        let (mut left, mut right) = (w, w);
        for level in 1..7 {
            for i in (level..7).rev() {
                left[i] = 0.5 * (left[i - 1] + left[i]);
            }
            right[6 - level] = left[6]; // the last of this level of de Casteljau's triangle
        }
        if left[6] == 0.0 {
            visit(middle);
        }
        falls(left, [a, middle], halvings, visit);
        falls(right, [middle, b], halvings, visit);
    }
}

/// The only root, on [0, 1], of a polynomial that is positive before it and negative after: Newton steps, bisection where they
/// leave the bracket.
fn root(w: &[f64; 7]) -> f64 {
    let (mut lower, mut upper, mut t) = (0.0, 1.0, 0.5);
    for _ in 0..64 {
        let mut triangle = *w;
        for level in 1..6 {
            for i in 0..7 - level {
                triangle[i] += t * (triangle[i + 1] - triangle[i]);
            }
        }
        let slope = triangle[1] - triangle[0]; // a sixth of it
        let value = triangle[0] + t * slope;
        if value > 0.0 {
            lower = t;
        } else {
            upper = t;
        }
        let newton = t - value / (6.0 * slope);
        let next = if newton > lower && newton < upper { newton } else { 0.5 * (lower + upper) };
        if (next - t).abs() <= f64::EPSILON {
            return next;
        }
        t = next;
    }
    t
}

/// Coefficients of a polynomial of degree 6 at most, of the lowest power first.
#[derive(Clone, Copy)]
struct Polynomial([f64; 7]);

fn constant(value: f64) -> Polynomial {
    linear(value, 0.0)
}

fn linear(value: f64, slope: f64) -> Polynomial {
    Polynomial([value, slope, 0.0, 0.0, 0.0, 0.0, 0.0])
}

impl Polynomial {
    fn slope(self) -> Self {
        let Self(a) = self;
        Self([a[1], 2.0 * a[2], 3.0 * a[3], 4.0 * a[4], 5.0 * a[5], 6.0 * a[6], 0.0])
    }

    /// The coefficients `Σ_j C(i, j) / C(6, j) a_j` in the Bernstein basis on [0, 1], by repeated sums.
    fn bernstein(self) -> [f64; 7] {
        const BINOMIAL: [f64; 7] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];
        let mut b: [f64; 7] = std::array::from_fn(|j| self.0[j] / BINOMIAL[j]);
        for level in 1..7 {
            for i in (level..7).rev() {
                b[i] += b[i - 1];
            }
        }
        b
    }
}

impl Add for Polynomial {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Polynomial {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul for Polynomial {
    type Output = Self;
    /// The product as far as degree 6; no product here has a higher one.
    fn mul(self, other: Self) -> Self {
        let mut product = [0.0; 7];
        for i in 0..7 {
            for j in 0..7 - i {
                product[i + j] += self.0[i] * other.0[j];
            }
        }
        Self(product)
    }
}
