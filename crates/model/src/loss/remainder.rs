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
/// The ends of the first pieces; a piece on which one polynomial is not exact is halved recursively.
const ENDS: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
/// Maximum depth of halving.
const HALVINGS: u32 = 12;
/// A branch point beyond this is taken to be here.
const FAR: f64 = 3.0;
/// Bound on the last coefficients of an interpolant that is exact to rounding.
const ROUNDING: f64 = 1e-15;
/// Maximum number of polynomials for which four numbers are evaluated together.
const TOGETHER: usize = 4;

/// `r(x)`.
#[derive(Clone, Debug)]
pub(super) struct Remainder {
    /// Where each piece begins, in ascending order.
    starts: Vec<f64>,
    pieces: Vec<Piece>,
    branch: f64,
}

/// A polynomial in the variable that runs from -1 to 1 between two ends: x itself below 0, the root of the distance from the branch point above.
#[derive(Clone, Debug)]
struct Piece {
    coefficients: [[f64; few::TERMS]; 4],
    /// Middle and the inverse of half the length of the piece in its variable.
    middle: f64,
    scale: f64,
    by_root: bool,
}

impl Remainder {
    /// Interpolates r from its values and its branch point. None where r bends too sharply for polynomials exact to rounding.
    pub fn new(branch: f64, value: impl Fn(f64) -> f64) -> Option<Self> {
        let mut table = Self { starts: Vec::new(), pieces: Vec::new(), branch: FAR.min(branch) };
        ENDS.windows(2).all(|ends| table.fill([ends[0], ends[1]], HALVINGS, &value)).then_some(table)
    }

    /// Adds the pieces between two ends; returns whether they are exact.
    fn fill(&mut self, [from, to]: [f64; 2], halvings: u32, value: &impl Fn(f64) -> f64) -> bool {
        let by_root = from >= 0.0;
        let ends = [from, to].map(|x| self.variable(by_root, x));
        let of_variable =
            |variable: f64| value(if by_root { self.branch - variable * variable } else { variable });
        if let Some(piece) = Piece::new(by_root, ends, of_variable) {
            self.starts.push(from);
            self.pieces.push(piece);
            return true;
        }
        let middle = 0.5 * (from + to);
        halvings > 0
            && self.fill([from, middle], halvings - 1, value)
            && self.fill([middle, to], halvings - 1, value)
    }

    #[inline(always)]
    fn variable(&self, by_root: bool, x: f64) -> f64 {
        if by_root { (self.branch - x).sqrt() } else { x }
    }

    /// The index of the piece at an x; the first one also beyond lift-off.
    #[inline(always)]
    fn index(&self, x: f64) -> usize {
        self.starts.iter().skip(1).map(|start| usize::from(x >= *start)).sum()
    }

    /// r.
    #[inline]
    pub fn at(&self, x: f64) -> f64 {
        let piece = &self.pieces[self.index(x)];
        let t = (self.variable(piece.by_root, x) - piece.middle) * piece.scale;
        sum(&piece.coefficients, t)
    }

    /// [`Self::at`] for four x at once, with bitwise equal results: each polynomial that one of them needs.
    pub fn at_four(&self, x: f64x4) -> f64x4 {
        let places = x.to_array().map(|x| self.index(x));
        let (first, last) =
            places.iter().fold((usize::MAX, 0), |(a, b), &index| (index.min(a), index.max(b)));
        if last - first >= TOGETHER {
            return f64x4::new(x.to_array().map(|x| self.at(x)));
        }
        let mut all = f64x4::ZERO;
        for index in first..=last {
            let Piece { coefficients, middle, scale, by_root } = &self.pieces[index];
            let variable = if *by_root { (f64x4::splat(self.branch) - x).sqrt() } else { x };
            let here = sum(coefficients, (variable - *middle) * *scale);
            let start = f64x4::splat(self.starts[index]);
            all = if index == first { here } else { x.simd_ge(start).select(here, all) };
        }
        all
    }
}

impl Piece {
    /// Interpolates values given by its variable between two ends; none if not exact to rounding.
    fn new(by_root: bool, [from, to]: [f64; 2], value: impl Fn(f64) -> f64) -> Option<Self> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let values: [f64; TERMS] = std::array::from_fn(|node| value(middle + half * cosine(1, node)));
        let chebyshev: [f64; TERMS] = std::array::from_fn(|k| {
            let sum: f64 = (0..TERMS).map(|node| values[node] * cosine(k, node)).sum();
            sum * if k == 0 { 1.0 } else { 2.0 } / TERMS as f64
        });
        if chebyshev[TERMS - 2].abs().max(chebyshev[TERMS - 1].abs()) >= ROUNDING {
            return None;
        }
        let powers = powers(&chebyshev);
        let coefficients = std::array::from_fn(|i| std::array::from_fn(|k| powers[few::TERMS * i + k]));
        Some(Self { coefficients, middle, scale: 1.0 / half, by_root })
    }
}

/// `Σ c_k t^k` for one number or four.
#[inline(always)]
fn sum<T: Number>(pieces: &[[f64; few::TERMS]; 4], t: T) -> T {
    let [a, b, c, d] = pieces.each_ref().map(|few| polynomial(few, t));
    let t2 = t * t;
    let t8 = (t2 * t2) * (t2 * t2);
    (a + t8 * b) + (t8 * t8) * (c + t8 * d)
}

/// A Chebyshev polynomial at a node, with exact reduction of the angle by whole turns.
fn cosine(order: usize, node: usize) -> f64 {
    static COSINES: LazyLock<[f64; 4 * TERMS]> =
        LazyLock::new(|| std::array::from_fn(|part| (0.5 * PI * part as f64 / TERMS as f64).cos()));
    COSINES[(order * (2 * node + 1)) % (4 * TERMS)]
}

/// Converts Chebyshev coefficients to those of powers.
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
