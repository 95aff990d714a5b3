//! Bounds of quantities in contacts, from bounds on the four numbers that the motion there consists of: `x1`, `v1`, the spring's stretch
//! towards the wall and the speed into it (`retune_model::Growth`).

use super::{Form, amplitude, times};
use crate::system::LinearSystem;
use retune_model::{Growth, OverContact};

/// The rate at which a quantity changes in flight, as a polynomial in the numbers of [`Growth`] with every coefficient by its size:
/// `constant + (linear + square n) · n`.
///
/// It is `(linear + Σ weight (row · d) row) · (A d + b P cos ωt)`; terms that cancel, as the two by which a spring and its energy
/// exchange work, have no size.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlopeInFlight<const N: usize> {
    constant: f64,
    linear: [f64; N],
    square: [[f64; N]; N],
}

/// Weights of the numbers of [`Growth`] in a row of weights of the state: `x2 - D = x1 + sign (stretch)`, `v2 = v1 + sign w`. Their signs
/// are those of a wall in the positive direction.
fn by_number<const N: usize>(row: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| row[i] + row.get(i + 2).unwrap_or(&0.0))
}

impl<const N: usize> SlopeInFlight<N> {
    pub(super) fn new<S: LinearSystem<N>>(
        system: &S,
        linear: &[f64; N],
        squares: &[(f64, [f64; N]); 2],
    ) -> Self {
        let (of, force) = (system.linear(), amplitude(system));
        let dot = |a: &[f64; N], b: &[f64; N]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // row · A and row · b P.
        let turned = |row: &[f64; N]| {
            (by_number(&of.columns.map(|column| dot(row, &column))), dot(row, &of.input) * force)
        };
        let (own, driven) = turned(linear);
        let (mut slope, mut square) = (
            Self { constant: driven.abs(), linear: own.map(f64::abs), square: [[0.0; N]; N] },
            [[0.0; N]; N],
        );
        for (weight, row) in squares {
            let (numbers, (rate, driven)) = (by_number(row), turned(row));
            for i in 0..N {
                slope.linear[i] += (weight * numbers[i] * driven).abs();
                for j in 0..N {
                    square[i][j] += weight * numbers[i] * rate[j];
                }
            }
        }
        for i in 0..N {
            for j in 0..N {
                slope.square[i][j] = 0.5 * (square[i][j] + square[j][i]).abs();
            }
        }
        slope
    }

    /// At most, where the numbers have at most these sizes.
    fn at(&self, most: &[f64; N]) -> f64 {
        let mut sum = self.constant;
        for i in 0..N {
            let by = (0..N).map(|j| self.square[i][j] * most[j]).sum::<f64>();
            sum += (self.linear[i] + by) * most[i];
        }
        sum
    }
}

/// The sizes of [`by_number`].
fn sizes(row: &[f64; 4]) -> [f64; 4] {
    let [x1, v1, x2, v2] = row;
    [x1 + x2, v1 + v2, *x2, *v2].map(f64::abs)
}

impl Form<4> {
    /// A bound on how far a quantity without the rate of the state exceeds, in a contact, the larger of its values at both ends. `kick` is
    /// the rate of the state under Hertz's force over `q³`, `hertz_rate` (κ) that of the speed.
    ///
    /// It changes at the rate `α q³ + β`, with `β` as in flight. By Hertz's force alone `α = (linear + Σ weight (row · d) row) · kick`
    /// would never fall, since no weight is negative, so that the integral of `α q³` would be largest at an end. What other forces do to
    /// `α`, and `β`, add at most their integrals.
    pub fn rise_in_contact(&self, kick: &[f64; 4], hertz_rate: f64, over: &OverContact) -> f64 {
        let mut turn = 0.0;
        for (weight, row) in &self.squares {
            let along = row.iter().zip(kick).map(|(a, b)| a * b).sum::<f64>();
            if along != 0.0 {
                let weights = sizes(row);
                turn += weight * along.abs() * (0..4).map(|i| weights[i] * over.beside[i]).sum::<f64>();
            }
        }
        over.duration * (self.slope.at(&over.most) + turn * over.impulse / hertz_rate)
    }

    /// A bound on the Taylor coefficient of order `k` in a contact, from those of its motion and, for what is linear in the rate of
    /// the state, from those of that rate.
    pub fn in_contact<const K: usize>(&self, growth: &Growth<K>, rates: &Growth<K>, k: usize) -> f64 {
        let combined = |row: &[f64; 4]| -> [f64; K] {
            let weights = sizes(row);
            std::array::from_fn(|k| (0..4).map(|i| times(weights[i], growth[i][k])).sum())
        };
        let rated = self.rated.as_ref().map_or(0.0, |rated| {
            let weights = sizes(&rated.row);
            (0..4).map(|i| times(weights[i], rates[i][k])).sum()
        });
        let square = |(weight, row): &(f64, [f64; 4])| {
            let row = combined(row);
            let products: f64 = (0..=k).map(|i| times(row[i], row[k - i])).sum();
            times(0.5 * weight, products)
        };
        combined(&self.linear)[k] + self.squares.iter().map(square).sum::<f64>() + rated
    }
}
