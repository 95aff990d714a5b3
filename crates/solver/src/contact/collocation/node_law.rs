//! The law of a restitution at the nodes of a rule, as a polynomial for each about its undisturbed collision.
//!
//! The factor of the force is a function of `x = ż / √(ż² + 2 S)` alone (see `retune_model::Restoring`). At one node contacts differ little
//! in x, so that few terms suffice, and all nodes are computed side by side.

use super::nodes::{Nodes, packed};
use super::unit_law::UnitLaw;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use wide::f64x4;

const TERMS: usize = 12;
/// The largest range of x to either side, the factor by which it is narrowed until the terms suffice, and the largest number of narrowings.
const WIDEST: f64 = 0.3;
const NARROWER: f64 = 0.8;
const NARROWED: usize = 20;
/// Largest error of a polynomial that suffices.
const ROUNDING: f64 = 2e-15;

/// The polynomials, in a variable that runs from -1 to 1 over each range.
pub struct NodeLaw<const M: usize> {
    middle: Nodes<M>,
    /// Over half its width.
    scale: Nodes<M>,
    terms: [Nodes<M>; TERMS],
}

impl<const M: usize> NodeLaw<M> {
    /// About the depths and speeds of an undisturbed collision; `None` for a law whose own rounding is larger than that of the polynomials.
    pub fn new<const N: usize>(law: &UnitLaw, depths: &[f64; N], speeds: &[f64; N]) -> Option<Self> {
        let factor = |x: f64| law.push(0.5 * (1.0 - x) * (1.0 + x), x);
        let piece = |i: usize| {
            let x = speeds[i] / (speeds[i] * speeds[i] + depths[i].powf(2.5)).sqrt();
            std::iter::successors(Some(WIDEST), |width| Some(NARROWER * width))
                .take(NARROWED)
                .map(|width| Piece::new(&factor, x, width))
                .find(|piece| piece.error(&factor) <= ROUNDING)
        };
        let pieces = (0..N).map(piece).collect::<Option<Vec<_>>>()?;
        let each =
            |number: &dyn Fn(&Piece) -> f64| packed::<N, M>(&std::array::from_fn(|i| number(&pieces[i])));
        Some(Self {
            middle: each(&|piece| piece.middle),
            scale: each(&|piece| 1.0 / piece.half),
            terms: std::array::from_fn(|k| each(&|piece| piece.terms[k])),
        })
    }

    /// The factor at `S = z^(5/2)/2` and `ż`; `None` where a node is out of its range.
    #[inline(always)]
    pub fn push(&self, s: &Nodes<M>, w: &Nodes<M>) -> Option<Nodes<M>> {
        let mut at = [f64x4::ZERO; M];
        let mut is_within = true;
        for i in 0..M {
            let x = w[i] / (w[i] * w[i] + s[i] * 2.0).sqrt();
            at[i] = (x - self.middle[i]) * self.scale[i];
            // False for a NaN, too.
            is_within &= at[i].abs().simd_le(f64x4::ONE).all();
        }
        if !is_within {
            return None;
        }
        let mut sum = self.terms[TERMS - 1];
        for terms in self.terms[..TERMS - 1].iter().rev() {
            for i in 0..M {
                sum[i] = sum[i] * at[i] + terms[i];
            }
        }
        Some(sum)
    }
}

struct Piece {
    middle: f64,
    half: f64,
    terms: [f64; TERMS],
}

impl Piece {
    /// By interpolation at Chebyshev's nodes.
    fn new(factor: &impl Fn(f64) -> f64, x: f64, width: f64) -> Self {
        let [low, high] = [(x - width).max(-1.0), (x + width).min(1.0)];
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let nodes: [f64; TERMS] = std::array::from_fn(|i| (PI * (i as f64 + 0.5) / TERMS as f64).cos());
        let powers = DMatrix::from_fn(TERMS, TERMS, |i, k| nodes[i].powi(k as i32));
        let values = DVector::from_fn(TERMS, |i, _| factor(middle + half * nodes[i]));
        let terms = powers.lu().solve(&values).expect("the nodes differ");
        Self { middle, half, terms: std::array::from_fn(|k| terms[k]) }
    }

    /// The largest error between nodes.
    fn error(&self, factor: &impl Fn(f64) -> f64) -> f64 {
        let left = |i: usize| {
            let at = -1.0 + i as f64 / (2 * TERMS) as f64;
            let value = self.terms.iter().rev().fold(0.0, |sum, term| sum * at + term);
            (value - factor(self.middle + self.half * at)).abs()
        };
        (0..=4 * TERMS).map(left).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::super::nodes::node;
    use super::*;
    use retune_model::Side;
    use retune_testkit::scenes::{Numbers, SSVI};
    use std::sync::Arc;

    #[test]
    fn exact_the_factor_at_the_nodes_is_that_of_the_law() {
        for e in [0.3, 0.5, 0.7, 0.95] {
            let equations = Numbers { e, ..SSVI }.coupled().regularised_contact(Side::Primary);
            let law = UnitLaw::Restoring(Arc::clone(equations.restoring().expect("a restitution")));
            // Somewhere in a collision: the energy that is left falls from 1 to e².
            let speeds = [0.99, 0.8, 0.4, 0.1, -0.1, -0.3 * e, -0.6 * e, -0.99 * e];
            let depths = [0.1, 0.5, 0.8, 0.9, 0.8, 0.6, 0.4, 0.02];
            let nodes = NodeLaw::<2>::new(&law, &depths, &speeds).expect("polynomials");
            for change in [-0.006, 0.0, 0.004] {
                let w = packed::<8, 2>(&speeds.map(|w| w * (1.0 + change) - 0.3 * change));
                let s = packed::<8, 2>(&depths.map(|z| 0.5 * (z * (1.0 - change)).powf(2.5)));
                let factors = nodes.push(&s, &w).expect("within the ranges");
                for i in 0..8 {
                    let expected = law.push(node(&s, i), node(&w, i));
                    assert!((node(&factors, i) - expected).abs() < 4e-15, "e = {e}, {change}, node {i}");
                }
            }
            assert!(nodes.push(&packed(&[0.5; 8]), &packed(&[-1.0; 8])).is_none(), "far from all of it");
            assert!(nodes.push(&packed(&[f64::NAN; 8]), &packed(&speeds)).is_none(), "no number");
        }
    }

    /// Once narrowed without end: next to the least restitution that has a table the law itself has more rounding.
    #[test]
    fn regress_a_law_that_no_polynomial_meets_has_none() {
        let equations = Numbers { e: 0.301, ..SSVI }.coupled().regularised_contact(Side::Primary);
        let law = UnitLaw::Restoring(Arc::clone(equations.restoring().expect("a restitution")));
        // x = ż / √(ż² + z^(5/2))
        let polynomials = |x: f64| NodeLaw::<1>::new(&law, &[(1.0 - x * x).powf(0.4); 4], &[x; 4]);
        assert!(polynomials(0.992).is_none() && polynomials(0.5).is_some());
    }
}
