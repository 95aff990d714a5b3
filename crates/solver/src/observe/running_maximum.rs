//! The running maximum of a quantity: the observer of most runs.

use super::observer::{Impact, MOST_KNOTS, Observer, Path};
use super::quantity::{Quantity, rates_in};
use super::quintic::{highest, quintic};
use super::search::{Search, in_theta};
use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::form::QUINTIC;
use crate::motion::lanes::shifted;
use crate::motion::segment::Segment;
use crate::response::Extreme;
use wide::f64x4;

/// The largest value of a quantity, located where its rate of change is zero, to rounding.
pub struct RunningMaximum<Q> {
    search: Search<Q>,
    cutoff: f64,
    /// Time and rates at the end of the latest segment, and whether these are rates in flight.
    last: Option<(f64, bool, [f64; 3])>,
}

impl<Q> RunningMaximum<Q> {
    /// Observes a quantity; the run may end early once its value exceeds `cutoff`.
    pub fn new(quantity: Q, cutoff: f64) -> Self {
        Self { search: Search::new(quantity), cutoff, last: None }
    }

    /// The largest value so far and its time; `-∞` and NaN before any motion was seen.
    pub fn record(&self) -> Extreme {
        self.search.record
    }

    /// Raises the record to a higher one, such as that of the quantity with the other sign.
    #[inline(always)]
    pub(super) fn raise_record(&mut self, record: Extreme) {
        self.search.update_record(record.value, record.time);
    }

    /// By how much a value may exceed the record because a search ended before its bounds could decide; 0 where the record is proven.
    pub fn doubt(&self) -> f64 {
        self.search.doubt()
    }
}

impl<Q> RunningMaximum<Q> {
    /// Whether no value in these pieces of a record exceeds `most`.
    #[inline(always)]
    pub(super) fn stays_below<const N: usize>(&self, block: &Block<N>, most: f64) -> bool
    where
        Q: Quantity<N>,
    {
        let quantity = &self.search.quantity;
        let value = |force: &[f64x4; 2], y: &[f64x4; N]| quantity.rates_in_flight(force, y)[0];
        block.range(value, quantity.form().second_in_flight(block.energy))[1] <= most
    }

    /// [`Observer::path`] for a quantity that depends on the force; `values` are those without the force.
    fn forced_path<const N: usize>(&mut self, path: &dyn Path<N>, times: &[f64], values: &[f64])
    where
        Q: Quantity<N>,
    {
        let form = self.search.quantity.form();
        let (first, force) = (path.first_derivative(form), form.size_of_force());
        for (piece, (times, values)) in times.windows(2).zip(values.windows(2)).enumerate() {
            let most = 0.5 * (values[0] + values[1] + first * (times[1] - times[0])) + force;
            let dropped = most <= self.search.record.value;
            if !dropped {
                path.show(piece, &mut |part| Observer::<N>::see(self, part));
            }
        }
    }
}

/// How far a quantity may rise above the larger of two values, `t` apart, that differ by `change`, where its second derivative is at most
/// `m` and `bend` is `m t²`: inside, where its slope is zero, it exceeds a value at the distance `s` by at most `m s² / 2`, so that both
/// values allow `m t² / 8 (1 - 2 change / (m t²))²`, and no rise once the change leaves no room for a zero of the slope.
fn rise_by_curvature(change: f64, bend: f64) -> f64 {
    if 2.0 * change >= bend { 0.0 } else { 0.125 * bend * (1.0 - 2.0 * change / bend).powi(2) }
}

impl<const N: usize, Q> Observer<N> for RunningMaximum<Q>
where
    Q: Quantity<N>,
{
    #[inline(always)]
    fn segment(&mut self, segment: &dyn Segment<N>) {
        let energy = segment.energy();
        if energy.is_finite() && self.search.quantity.form().upper_bound(energy) <= self.search.record.value {
            self.last = None;
            return;
        }
        let ([a, b], in_flight) = (segment.ends(), segment.in_flight());
        let rates_a = match self.last {
            Some((t, flown, rates)) if t == a.t && flown == in_flight => rates,
            _ => {
                let rates = rates_in(segment, a, &self.search.quantity);
                self.search.update_record(rates[0], a.t);
                rates
            }
        };
        let rates_b = rates_in(segment, b, &self.search.quantity);
        self.last = Some((b.t, in_flight, rates_b));
        self.search.update_record(rates_b[0], b.t);
        let from = (0.0, *a, in_theta(rates_a, a.clock));
        let to = (segment.length(), *b, in_theta(rates_b, b.clock));
        // In a contact the coarse bound costs less than the quintic.
        if self.search.coarse_bound(segment, &from, &to) <= self.search.record.value {
            self.search.search_work += segment.cost();
            return;
        }
        let remainder = self.search.quintic_error(segment, &from, &to, false);
        self.search.begin(segment, &from, &to, remainder);
    }

    /// Searches only where bounds from the values at both ends, or at the knots, allow a new record (see [`rise_by_curvature`]). A quantity
    /// that depends on contact forces has no second derivative, but a first of at most some `m`: it rises above the mean of two values `t`
    /// seconds apart by at most `m t / 2`.
    #[inline(always)]
    fn path(&mut self, path: &dyn Path<N>) {
        let quantity = &self.search.quantity;
        let mut rise = f64::INFINITY;
        if !quantity.is_forced() {
            let [begin, end] = path.ends().map(|y| quantity.value(y));
            rise = path.rise(quantity.form());
            if begin.max(end) + rise <= self.search.record.value {
                return;
            }
        }
        let (mut times, mut values) = ([0.0; MOST_KNOTS], [f64::NEG_INFINITY; MOST_KNOTS]);
        let mut count = 0;
        path.states(&mut |t, y| {
            values[count] = self.search.quantity.value(y);
            times[count] = t;
            count += 1;
        });
        if self.search.quantity.is_forced() {
            return self.forced_path(path, &times[..count], &values[..count]);
        }
        let second = path.second_derivative(self.search.quantity.form());
        // For a piece of the path the first bound falls at least in proportion to its duration. A piece that cannot reach the largest value
        // at a knot is skipped: another piece has it.
        let slope = rise / times[count - 1];
        let largest = values[..count].iter().fold(f64::NEG_INFINITY, |largest, value| largest.max(*value));
        for piece in 0..count - 1 {
            let h = times[piece + 1] - times[piece];
            let change = (values[piece + 1] - values[piece]).abs();
            let rise = rise_by_curvature(change, second * h * h).min(slope * h);
            let most = values[piece].max(values[piece + 1]) + rise;
            let dropped = most <= self.search.record.value || most < largest;
            if !dropped {
                path.show(piece, &mut |part| Observer::<N>::see(self, part));
            }
        }
    }

    /// The bound of [`Self::segment`] for all steps side by side.
    #[inline(always)]
    fn steps(&mut self, steps: &Steps<'_, N>) {
        let (from, to) = (steps.from(), steps.ends());
        // A record has many pieces: most of a run has too little energy for any of them to matter.
        if steps.begin().is_some()
            && self.search.quantity.form().upper_bound(steps.energy()) <= self.search.record.value
        {
            self.last = None;
            return;
        }
        self.search.search_work += steps.count() as u64;
        let ends = self.search.quantity.rates_in_flight(&to.excitation, &to.y);
        let begins = match steps.begin() {
            None => {
                let first = match self.last {
                    Some((t, true, rates)) if t == from.t => rates,
                    _ => from.rates(&self.search.quantity, true),
                };
                [0, 1, 2].map(|order| shifted(first[order], ends[order]))
            }
            // Rates jump between the steps.
            Some(force) => {
                let y: [f64x4; N] = std::array::from_fn(|i| shifted(from.y[i], to.y[i]));
                self.search.quantity.rates_in_flight(force, &y)
            }
        };
        let h = steps.lengths();
        let sixth = self.search.quantity.form().sixth_in_flight(steps.energy());
        let square = h * h;
        let remainder = square * (square * square) * QUINTIC * sixth;
        let highest = highest(quintic(h, begins, ends), remainder);
        let last = steps.count() - 1;
        let end = (steps.time(last + 1), true, ends.map(|lanes| lanes.to_array()[last]));
        self.last = steps.begin().is_none().then_some(end);
        // The values at both ends are among the coefficients.
        let dropped = highest.simd_le(f64x4::splat(self.search.record.value)).to_bitmask();
        let wanted = !dropped & ((2 << last) - 1);
        if wanted == 0 {
            return;
        }
        for number in 0..=last {
            self.search.update_record(begins[0].to_array()[number], steps.time(number));
            self.search.update_record(ends[0].to_array()[number], steps.time(number + 1));
        }
        for number in (0..=last).filter(|number| wanted >> number & 1 == 1) {
            let step = steps.step(number);
            let [begin, end] = step.ends();
            let rates = |all: [f64x4; 3]| all.map(|lanes| lanes.to_array()[number]);
            let (from, to) = ((0.0, *begin, rates(begins)), (step.length(), *end, rates(ends)));
            self.search.begin(&step, &from, &to, remainder.to_array()[number]);
        }
    }

    #[inline(always)]
    fn skips(&self, block: &Block<N>) -> bool {
        self.stays_below(block, self.search.record.value)
    }

    /// The rates jump, too.
    fn impact(&mut self, impact: &Impact<N>) {
        self.last = None;
        // The next segment may not be searched, but the value after the impact counts.
        let rates = impact.after.rates(&self.search.quantity, !impact.caught);
        self.search.update_record(rates[0], impact.after.t);
    }

    fn discontinuity(&mut self) {
        self.last = None;
    }

    fn satisfied(&self) -> bool {
        self.search.record.value > self.cutoff
    }

    fn search_work(&self) -> u64 {
        self.search.search_work
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A parabola with its vertex in the stretch rises exactly so far.
    #[test]
    fn exact_the_rise_of_a_parabola_above_its_ends() {
        let (m, t) = (3.0, 0.7_f64);
        for share in [0.01, 0.3, 0.5, 0.8] {
            let [before, after] = [share * t, (1.0 - share) * t].map(|s| 0.5 * m * s * s);
            let rise = rise_by_curvature((before - after).abs(), m * t * t);
            assert!((rise / before.min(after) - 1.0).abs() < 1e-12, "{share}: {rise}");
        }
        assert_eq!(rise_by_curvature(0.5 * m * t * t, m * t * t), 0.0, "the slope is zero at an end at most");
        assert_eq!(rise_by_curvature(1.0, f64::INFINITY), f64::INFINITY, "no bound");
    }
}
