//! The largest value of a quantity over a motion.
//!
//! A search by branch and bound that drops a stretch of the motion only where a bound says that no larger value is in it: see
//! `quintic`, `quantity` and `docs/bounds.md`.

mod quintic;

pub use quintic::QUINTIC;

use crate::observe::{Knot, MOST_KNOTS, Observer, Path, Quantity, Segment};
use crate::settings::Extreme;
use crate::steps::{Steps, shifted};
use quintic::{Shape, highest, quintic, shape, slope_root};
use wide::f64x4;

/// The largest value of a quantity, located where its rate of change is zero, to rounding.
pub struct Peak<Q> {
    quantity: Q,
    record: Extreme,
    cutoff: f64,
    /// Time and rates at the end of the latest piece, and whether these are rates of flight.
    last: Option<(f64, bool, [f64; 3])>,
    /// Halvings left in the segment that is searched.
    halvings: u32,
    /// Whether its sharp bound is in use.
    sharp: bool,
    /// What the largest value may be where a search ended before its bounds could tell.
    undecided: f64,
}

/// A rule of thumb where derivatives have no known bound (the interpolants of general methods): `R` over what the quantity varies by at both
/// ends, `h |slope| + h² |curvature|`. One that varies at the rate `2/h` leaves its quintic by `2⁶ / 46080 = 1.4e-3` of its amplitude.
const ASSUMED: f64 = 2e-3;

/// Rounding errors that a value may have, over `ε` times the sizes of its terms: no search is made for less.
const ROUNDING: f64 = 8.0;

/// Most halvings in a segment. Two or three are common, and 20 are many; only where parameters are so far apart that slopes are
/// lost in rounding there is no end of them.
const HALVINGS: u32 = 64;

/// Halvings from which on a search is a long one.
const SHARP: u32 = 3;

impl<Q> Peak<Q> {
    /// Watches a quantity; the run may end early once its value exceeds `cutoff`.
    pub fn new(quantity: Q, cutoff: f64) -> Self {
        Self {
            quantity,
            record: Extreme { value: f64::NEG_INFINITY, time: f64::NAN },
            cutoff,
            last: None,
            halvings: 0,
            sharp: false,
            undecided: f64::NEG_INFINITY,
        }
    }

    /// The record so far.
    pub fn record(&self) -> Extreme {
        self.record
    }

    /// By how much a value may exceed the record because a search ended before its bounds could tell; 0 where the record is proven.
    /// What is left of such a search is climbed where its slopes say that there is a maximum.
    pub fn doubt(&self) -> f64 {
        (self.undecided - self.record.value).max(0.0)
    }
}

fn note(record: &mut Extreme, value: f64, time: f64) {
    if value > record.value {
        *record = Extreme { value, time };
    }
}

/// Value, slope and curvature with respect to `θ`, from those with respect to time.
#[inline(always)]
fn in_theta([value, slope, curvature]: [f64; 3], [rate, rate_slope]: [f64; 2]) -> [f64; 3] {
    [value, slope * rate, curvature * rate * rate + slope * rate_slope]
}

/// A place in a segment: `θ`, the moment, and `[value, slope, curvature]` there.
type Place<const N: usize> = (f64, Knot<N>, [f64; 3]);

impl<Q> Peak<Q> {
    /// Begins the search of a segment.
    fn begin<const N: usize>(&mut self, segment: &impl Segment<N>, a: &Place<N>, b: &Place<N>, remainder: f64)
    where
        Q: Quantity<N>,
    {
        (self.halvings, self.sharp) = (HALVINGS, false);
        self.search(segment, a, b, remainder);
    }

    /// Looks for a maximum above the record between two places. `remainder` bounds how far the quantity leaves its quintic there.
    fn search<const N: usize>(
        &mut self,
        segment: &impl Segment<N>,
        a: &Place<N>,
        b: &Place<N>,
        remainder: f64,
    ) where
        Q: Quantity<N>,
    {
        let coefficients = quintic(b.0 - a.0, a.2.map(f64x4::splat), b.2.map(f64x4::splat));
        let highest = highest(coefficients, f64x4::splat(remainder)).to_array()[0];
        // A bound that is no number drops nothing.
        if highest <= self.record.value {
            return;
        }
        match shape(coefficients.map(|lanes| lanes.to_array()[0]), remainder) {
            Shape::EndsAreLargest => {} // and have been noted
            Shape::OneMaximum => self.climb(segment, a, b),
            Shape::Unknown => self.halve(segment, a, b, remainder, highest),
        }
    }

    /// Searches both halves of a stretch on which no value exceeds `highest`. A half has a 64th of the remainder, unless the segment can only
    /// tell for shorter stretches; a search that goes on asks for a sharper bound.
    fn halve<const N: usize>(
        &mut self,
        segment: &impl Segment<N>,
        a: &Place<N>,
        b: &Place<N>,
        mut remainder: f64,
        highest: f64,
    ) where
        Q: Quantity<N>,
    {
        if self.halvings <= HALVINGS - SHARP {
            let form = self.quantity.form();
            let rounding = ROUNDING * f64::EPSILON * form.size(&a.1.y).max(form.size(&b.1.y));
            if highest <= self.record.value + rounding {
                return;
            }
            if self.halvings == 0 {
                self.undecided = self.undecided.max(highest);
                if a.2[1] > 0.0 && b.2[1] < 0.0 {
                    self.climb(segment, a, b);
                }
                return;
            }
            if !self.sharp || remainder.is_infinite() {
                self.sharp = true;
                let sharper = self.quintic_error(segment, a, b, true);
                if sharper < remainder {
                    return self.search(segment, a, b, sharper);
                }
            }
        }
        self.halvings -= 1;
        remainder /= 64.0;
        let middle = self.look(segment, 0.5 * (a.0 + b.0));
        note(&mut self.record, middle.2[0], middle.1.t);
        for (from, to) in [(a, &middle), (&middle, b)] {
            self.search(segment, from, to, remainder);
        }
    }

    fn look<const N: usize>(&self, segment: &impl Segment<N>, theta: f64) -> Place<N>
    where
        Q: Quantity<N>,
    {
        let knot = segment.at(theta);
        (theta, knot, in_theta(knot.rates(&self.quantity, segment.in_flight()), knot.clock))
    }

    fn quintic_error<const N: usize>(
        &self,
        segment: &impl Segment<N>,
        a: &Place<N>,
        b: &Place<N>,
        sharp: bool,
    ) -> f64
    where
        Q: Quantity<N>,
    {
        let h = b.0 - a.0;
        let assumed = || {
            let variation = |[_, slope, curvature]: [f64; 3]| (slope.abs() + curvature.abs() * h) * h;
            ASSUMED * (variation(a.2) + variation(b.2))
        };
        let error =
            segment.quintic_error(self.quantity.form(), [&a.1, &b.1], h, sharp).unwrap_or_else(assumed);
        if error.is_nan() { f64::INFINITY } else { error }
    }

    /// The only maximum between two places, where the quantity is concave: Newton's method on the slope, kept inside by bisection.
    /// The quantity is flat there: an error δ of its place costs δ², and that is put right by the parabola,
    /// `slope² / 2|curvature|` more, which leaves an error of order δ³.
    fn climb<const N: usize>(&mut self, segment: &impl Segment<N>, a: &Place<N>, b: &Place<N>)
    where
        Q: Quantity<N>,
    {
        let (mut lower, mut upper) = (a.0, b.0);
        let mut theta = a.0 + slope_root(b.0 - a.0, a.2, b.2);
        for _ in 0..60 {
            let (_, Knot { t, clock: [rate, rate_slope], .. }, [value, slope, curvature]) =
                self.look(segment, theta);
            note(&mut self.record, value, t);
            if slope > 0.0 {
                lower = theta
            } else {
                upper = theta
            }
            let step = -slope / curvature;
            let gain = 0.5 * slope * step;
            if curvature < 0.0 && gain <= 1e-10 * value.abs() {
                // Where the quantity is all but level, the parabola's top may lie far outside the bracket.
                let way = step.max(lower - theta).min(upper - theta);
                return note(&mut self.record, value + gain, t + way * (rate + 0.5 * way * rate_slope));
            }
            let newton = theta + step;
            theta = if newton > lower && newton < upper { newton } else { 0.5 * (lower + upper) };
        }
    }
}

impl<const N: usize, Q> Observer<N> for Peak<Q>
where
    Q: Quantity<N>,
{
    #[inline(always)]
    fn segment(&mut self, segment: &impl Segment<N>) {
        let ([a, b], in_flight) = (segment.ends(), segment.in_flight());
        let rates_a = match self.last {
            Some((t, flown, rates)) if t == a.t && flown == in_flight => rates,
            _ => {
                let rates = a.rates(&self.quantity, in_flight);
                note(&mut self.record, rates[0], a.t);
                rates
            }
        };
        let rates_b = b.rates(&self.quantity, in_flight);
        self.last = Some((b.t, in_flight, rates_b));
        note(&mut self.record, rates_b[0], b.t);
        let from = (0.0, *a, in_theta(rates_a, a.clock));
        let to = (segment.length(), *b, in_theta(rates_b, b.clock));
        let remainder = self.quintic_error(segment, &from, &to, false);
        self.begin(segment, &from, &to, remainder);
    }

    /// Looks only between knots where the record could be broken: what has a second derivative of at most `m` rises above the
    /// larger of two values `t` seconds apart by at most `m t² / 8`.
    #[inline(always)]
    fn path(&mut self, path: &impl Path<N>) {
        let (mut times, mut values) = ([0.0; MOST_KNOTS], [f64::NEG_INFINITY; MOST_KNOTS]);
        let mut count = 0;
        path.states(|t, y| {
            [values[count], ..] = self.quantity.rates([0.0; 2], y);
            times[count] = t;
            count += 1;
        });
        let second = path.second_derivative(self.quantity.form());
        for piece in 0..count - 1 {
            let rise = 0.125 * second * (times[piece + 1] - times[piece]).powi(2);
            let dropped = values[piece].max(values[piece + 1]) + rise <= self.record.value;
            if !dropped {
                path.show(piece, self);
            }
        }
    }

    /// The bound of [`Self::segment`] for all steps side by side.
    #[inline(always)]
    fn steps(&mut self, steps: &Steps<'_, N>) {
        let (from, to) = (steps.from(), steps.ends());
        let first = match self.last {
            Some((t, true, rates)) if t == from.t => rates,
            _ => from.rates(&self.quantity, true),
        };
        let ends = self.quantity.rates_in_flight(&to.drive, &to.y);
        let begins = [0, 1, 2].map(|order| shifted(first[order], ends[order]));
        let h = steps.length();
        let sixth = self.quantity.form().sixth_in_flight(steps.energy());
        let remainder = QUINTIC * h.powi(6) * sixth;
        let highest = highest(quintic(h, begins, ends), f64x4::splat(remainder));
        let last = steps.count() - 1;
        self.last = Some((steps.time(last + 1), true, ends.map(|lanes| lanes.to_array()[last])));
        // The values at both ends are among the coefficients.
        let dropped = highest.simd_le(f64x4::splat(self.record.value)).to_bitmask();
        let wanted = !dropped & ((2 << last) - 1);
        if wanted == 0 {
            return;
        }
        for number in 0..=last {
            note(&mut self.record, begins[0].to_array()[number], steps.time(number));
            note(&mut self.record, ends[0].to_array()[number], steps.time(number + 1));
        }
        for number in (0..=last).filter(|number| wanted >> number & 1 == 1) {
            let step = steps.step(number);
            let [begin, end] = step.ends();
            let rates = |all: [f64x4; 3]| all.map(|lanes| lanes.to_array()[number]);
            let (from, to) = ((0.0, *begin, rates(begins)), (h, *end, rates(ends)));
            self.begin(&step, &from, &to, remainder);
        }
    }

    fn satisfied(&self) -> bool {
        self.record.value > self.cutoff
    }
}
