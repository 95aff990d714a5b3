//! Bounds of quantities in contacts, from bounds on the four numbers that the motion there consists of (`retune_model::Growth`).

use super::{Form, times};
use retune_model::{Change, Forces, Growth, OverContact};

/// The magnitudes of the weights of the numbers of [`Growth`], from a row of weights of the state:
/// `x2 - D = x1 + sign (stretch)`, `v2 = v1 + sign w`.
fn absolute_weights(row: &[f64; 4]) -> [f64; 4] {
    let [x1, v1, x2, v2] = row;
    [x1 + x2, v1 + v2, *x2, *v2].map(f64::abs)
}

/// How far a quantity may rise between two places `h` apart above the larger of its values there, where its slope is no farther than `turn`
/// from that at the nearer of the two. Where the quantity rises throughout one half towards the middle, its largest value lies in the other
/// half, whose bound alone counts.
fn rise_by_slopes(slopes: [f64; 2], turn: f64, h: f64) -> f64 {
    let ahead = [slopes[0], -slopes[1]]; // from either end towards the middle
    let rises = ahead.map(|slope| 0.5 * h * (slope + turn).max(0.0));
    match ahead.map(|slope| slope >= turn) {
        [true, true] => rises[0].min(rises[1]),
        [true, false] => rises[1],
        [false, true] => rises[0],
        [false, false] => rises[0].max(rises[1]),
    }
}

impl Form<4> {
    /// A bound on how far, in a contact, a quantity that does not depend on the rate of the state exceeds the larger of its values at both
    /// ends. `kick` is the rate of the state under Hertz's force over `q³`, `hertz_rate` (κ) that of the speed.
    ///
    /// It changes at the rate `α q³ + β`, with `β` as in flight. By Hertz's force alone `α = (linear + Σ weight (row · d) row) · kick`
    /// would never fall, since no weight is negative, so the integral of `α q³` would be largest at an end. The effect of other forces on
    /// `α`, and `β`, add at most their integrals.
    pub fn rise_in_contact(&self, kick: &[f64; 4], hertz_rate: f64, over: &OverContact) -> f64 {
        let mut turn = 0.0;
        for (weight, row) in &self.squares {
            let along = row.iter().zip(kick).map(|(a, b)| a * b).sum::<f64>();
            if along != 0.0 {
                let weights = absolute_weights(row);
                turn += weight * along.abs() * (0..4).map(|i| weights[i] * over.beside[i]).sum::<f64>();
            }
        }
        over.duration * (self.slope.bound(&over.most) + turn * over.impulse / hertz_rate)
    }

    /// How far the quantity may rise above the larger of its values at two places `h` apart, from its slopes there: from its change, or,
    /// where it does not depend on the rate of the state, from these slopes and a bound on how far the slope may be from the nearer of
    /// them.
    pub fn rise_between(&self, change: &Change, slopes: [f64; 2], h: f64) -> f64 {
        let rise = self.in_contact::<2>(&change.states, &change.rates, 1);
        if self.is_rated() {
            return rise;
        }
        let [most, turn] = change.forces.map_or_else(
            || self.slopes_by_rates(&change.states, &change.rates),
            |forces| self.slopes_by_forces(&change.states, &forces),
        );
        rise.min(rise_by_slopes(slopes, change.root[0] * turn + change.root[1] * most, h))
    }

    /// A bound on the slope in time, `linear · d' + Σ weight (row · d) (row · d')`, and on how far it is from the slope at the nearer of
    /// two places, from states and their rates.
    fn slopes_by_rates(&self, states: &Growth<2>, rates: &Growth<2>) -> [f64; 2] {
        let sizes = |row: &[f64; 4], of: &Growth<2>, k: usize| -> f64 {
            let weights = absolute_weights(row);
            (0..4).map(|i| times(weights[i], of[i][k])).sum()
        };
        let (mut most, mut turn) = (sizes(&self.linear, rates, 0), sizes(&self.linear, rates, 1));
        for (weight, row) in &self.squares {
            let [d, by_d, rate, by_rate] =
                [(states, 0), (states, 1), (rates, 0), (rates, 1)].map(|(of, k)| sizes(row, of, k));
            most += weight * times(d, rate);
            turn += weight * (times(d, by_rate) + times(by_d, rate));
        }
        [most, turn]
    }

    /// [`Self::slopes_by_rates`] from states and forces, where the work that a spring exchanges with its energy cancels.
    fn slopes_by_forces(&self, states: &Growth<2>, Forces { contact, turn, kick }: &Forces) -> [f64; 2] {
        let [most, of] = [0, 1].map(|k| states.map(|number| number[k]));
        let mut slopes = [self.slope.bound(&most), self.slope.variation(&most, &of, *turn)];
        let along = |row: &[f64; 4]| row.iter().zip(kick).map(|(a, b)| a * b).sum::<f64>().abs();
        let linear = along(&self.linear);
        let mut kicked = [linear, 0.0];
        for (weight, row) in &self.squares {
            let (by, weights) = (weight * along(row), absolute_weights(row));
            for (kicked, numbers) in kicked.iter_mut().zip([&most, &of]) {
                *kicked += times(by, (0..4).map(|i| times(weights[i], numbers[i])).sum());
            }
        }
        slopes[0] += times(kicked[0], contact[0]);
        slopes[1] += times(kicked[0], contact[1]) + times(kicked[1], contact[0]);
        slopes
    }

    /// A bound on the Taylor coefficient of order `k` in a contact, from those of its motion and, for what is linear in the rate of
    /// the state, from those of that rate.
    pub fn in_contact<const K: usize>(&self, growth: &Growth<K>, rates: &Growth<K>, k: usize) -> f64 {
        let combined = |row: &[f64; 4]| -> [f64; K] {
            let weights = absolute_weights(row);
            std::array::from_fn(|k| (0..4).map(|i| times(weights[i], growth[i][k])).sum())
        };
        let rated = self.rated.as_ref().map_or(0.0, |rated| {
            let weights = absolute_weights(&rated.row);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic whose slope is at most `turn` from that at the nearer end rises by no more than that allows, and not at all where both slopes have
    /// one sign and outweigh it.
    #[test]
    fn exact_the_rise_of_a_cubic_by_its_slopes() {
        let (mut level, mut tight) = (0, 0);
        for draw in 0..20_000 {
            let number =
                |i: u32| (f64::from(draw) * 0.7 + f64::from(i) * 1.3).sin() / f64::from(1 + draw % 5 * i);
            let (c, h) = ([number(1), number(2), number(3)], 0.5 + number(4).abs());
            let value = |t: f64| t * (c[0] + t * (c[1] + t * c[2]));
            let slope = |t: f64| c[0] + t * (2.0 * c[1] + t * 3.0 * c[2]);
            let moments = (0..=200).map(|i| h * f64::from(i) / 200.0);
            let ends = [slope(0.0), slope(h)];
            let turned = |t: f64| (slope(t) - ends[usize::from(2.0 * t > h)]).abs();
            let turn = moments.clone().map(turned).fold(0.0, f64::max);
            let rise = moments.map(value).fold(f64::NEG_INFINITY, f64::max) - value(h).max(0.0);
            let found = rise_by_slopes(ends, turn * (1.0 + 1e-9), h);
            assert!(rise <= found + 1e-12, "{c:?} {h}: {rise} {found}");
            level += u32::from(found == 0.0);
            tight += u32::from(rise > 0.2 * found);
        }
        assert!(level > 5000 && tight > 100, "{level} {tight}");
    }
}
