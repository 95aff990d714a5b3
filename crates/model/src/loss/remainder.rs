//! The stage of a contact by polynomials instead of its equation.
//!
//! With `r = √(h² + 2 G)`, the root of the share of its energy that an undisturbed collision still has (1 at touch-down, e at lift-off), and
//! `x = ż / √(ż² + 2 S)`, which alone determines the stage, `h = x r` and `v = √(ż² + 2 S) / r`. `r` is analytic in `x` from -1 to 1, with a
//! branch point of a square root not far beyond touch-down: as a function of the root of the distance from it, r is smooth there, too.

use crate::polynomial::{self as few, Number, polynomial};
use std::f64::consts::PI;
use std::sync::LazyLock;
use wide::f64x4;

/// Terms of a polynomial.
const TERMS: usize = 4 * few::TERMS;
/// Where one polynomial ends and the next begins.
const ENDS: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
/// A branch point beyond this is far.
const FAR: f64 = 3.0;
/// What the last coefficients of an interpolant to rounding are below.
const ROUNDING: f64 = 1e-15;

/// `r(x)`.
#[derive(Clone, Debug)]
pub(super) struct Remainder {
    /// Coefficients in the variable that runs from -1 to 1 between two ends: x itself below 0, the root of the distance from the branch point
    /// above.
    pieces: [[[f64; few::TERMS]; 4]; 4],
    branch: f64,
    /// Middle and the inverse of half the length of each piece in its variable.
    places: [[f64; 2]; 4],
    exact: bool,
}

impl Remainder {
    /// 1 throughout, as without loss.
    pub const NONE: Self = {
        let mut one = [[0.0; few::TERMS]; 4];
        one[0][0] = 1.0;
        Self { pieces: [one; 4], branch: FAR, places: [[0.0; 2]; 4], exact: false }
    };

    /// Of its values and its branch point.
    pub fn new(branch: f64, value: impl Fn(f64) -> f64) -> Self {
        let mut table = Self { branch: FAR.min(branch), exact: true, ..Self::NONE };
        for piece in 0..4 {
            let [from, to] = [0, 1].map(|end| table.variable(piece, ENDS[piece + end]));
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            table.places[piece] = [middle, 1.0 / half];
            let values: [f64; TERMS] = std::array::from_fn(|node| {
                let own = middle + half * cosine(1, node);
                value(if piece < 2 { own } else { table.branch - own * own })
            });
            let chebyshev: [f64; TERMS] = std::array::from_fn(|k| {
                let sum: f64 = (0..TERMS).map(|node| values[node] * cosine(k, node)).sum();
                sum * if k == 0 { 1.0 } else { 2.0 } / TERMS as f64
            });
            let last = chebyshev[TERMS - 2].abs().max(chebyshev[TERMS - 1].abs());
            table.exact = table.exact && last < ROUNDING;
            let powers = powers(&chebyshev);
            table.pieces[piece] =
                std::array::from_fn(|i| std::array::from_fn(|k| powers[few::TERMS * i + k]));
        }
        table
    }

    fn variable(&self, piece: usize, x: f64) -> f64 {
        if piece < 2 { x } else { (self.branch - x).sqrt() }
    }

    /// Whether [`Self::at`] is exact to rounding: of restitutions of 0.3 and above.
    pub fn is_exact(&self) -> bool {
        self.exact
    }

    /// r.
    #[inline]
    pub fn at(&self, x: f64) -> f64 {
        let piece = piece(x);
        let [middle, scale] = self.places[piece];
        let t = (self.variable(piece, x) - middle) * scale;
        sum(&self.pieces[piece], t)
    }

    /// The same, bit by bit, of four x at once: of each polynomial that one of them needs.
    pub fn at_four(&self, x: f64x4) -> f64x4 {
        let pieces = x.to_array().map(piece);
        let (first, last) = pieces.iter().fold((3, 0), |(a, b), &piece| (piece.min(a), piece.max(b)));
        let mut all = f64x4::ZERO;
        for piece in first..=last {
            let [middle, scale] = self.places[piece];
            let variable = if piece < 2 { x } else { (f64x4::splat(self.branch) - x).sqrt() };
            let t = (variable - middle) * scale;
            let here = sum(&self.pieces[piece], t);
            all = if piece == first { here } else { x.simd_ge(f64x4::splat(ENDS[piece])).select(here, all) };
        }
        all
    }
}

/// `Σ c_k t^k` of a number or of four.
#[inline(always)]
fn sum<T: Number>(pieces: &[[f64; few::TERMS]; 4], t: T) -> T {
    let [a, b, c, d] = pieces.each_ref().map(|few| polynomial(few, t));
    let t2 = t * t;
    let t8 = (t2 * t2) * (t2 * t2);
    (a + t8 * b) + (t8 * t8) * (c + t8 * d)
}

/// The polynomial for an x.
fn piece(x: f64) -> usize {
    usize::from(x >= ENDS[1]) + usize::from(x >= ENDS[2]) + usize::from(x >= ENDS[3])
}

/// Chebyshev's polynomial of an order at a node; multiples of whole turns are left out exactly.
fn cosine(order: usize, node: usize) -> f64 {
    static COSINES: LazyLock<[f64; 4 * TERMS]> =
        LazyLock::new(|| std::array::from_fn(|part| (0.5 * PI * part as f64 / TERMS as f64).cos()));
    COSINES[(order * (2 * node + 1)) % (4 * TERMS)]
}

/// The coefficients of the powers in a sum of Chebyshev polynomials.
fn powers(chebyshev: &[f64; TERMS]) -> [f64; TERMS] {
    let (mut sum, mut before, mut now) = ([0.0; TERMS], [0.0; TERMS], [0.0; TERMS]);
    now[0] = 1.0;
    for (order, c) in chebyshev.iter().enumerate() {
        for (sum, now) in sum.iter_mut().zip(now) {
            *sum += c * now;
        }
        // T_(k + 1) = 2 t T_k - T_(k - 1), and T_1 = t.
        let twice = if order == 0 { 1.0 } else { 2.0 };
        let next = std::array::from_fn(|k| if k == 0 { 0.0 } else { twice * now[k - 1] } - before[k]);
        (before, now) = (now, next);
    }
    sum
}
