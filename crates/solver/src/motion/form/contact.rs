//! Bounds of quantities in contacts, from bounds on the four numbers that the motion there consists of (`retune_model::Growth`).

use super::{Form, times};
use retune_model::{Change, Growth, OverContact};

/// The sizes of the weights of the numbers of [`Growth`] in a row of weights of the state: `x2 - D = x1 + sign (stretch)`,
/// `v2 = v1 + sign w`.
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

    /// How far the quantity may rise above the larger of its values at two places `h` apart, from its slopes there: by its change, or, where
    /// it does not depend on the rate of the state, by the slope at the nearer of the two and the change of that.
    pub fn rise_between(&self, Change { states, rates, root }: &Change, slopes: [f64; 2], h: f64) -> f64 {
        let change = self.in_contact::<2>(states, rates, 1);
        if self.is_rated() {
            return change;
        }
        let sizes = |row: &[f64; 4], of: &Growth<2>, k: usize| -> f64 {
            let weights = sizes(row);
            (0..4).map(|i| times(weights[i], of[i][k])).sum()
        };
        // Its slope in time is linear · d' + Σ weight (row · d) (row · d').
        let (mut most, mut turn) = (sizes(&self.linear, rates, 0), sizes(&self.linear, rates, 1));
        for (weight, row) in &self.squares {
            let [d, by_d, rate, by_rate] =
                [(states, 0), (states, 1), (rates, 0), (rates, 1)].map(|(of, k)| sizes(row, of, k));
            most += weight * times(d, rate);
            turn += weight * (times(d, by_rate) + times(by_d, rate));
        }
        let turn = root[0] * turn + root[1] * most;
        let ahead = slopes[0].max(-slopes[1]).max(0.0);
        change.min(0.5 * h * (ahead + turn))
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
