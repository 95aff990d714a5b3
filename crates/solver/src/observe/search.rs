//! The search for the largest value of a quantity on one segment, by branch and bound.
//!
//! A stretch of the motion is dropped only where a bound proves that it holds no larger value: see `quintic`, `form` and
//! `docs/bounds.md`.

use super::quantity::{Quantity, rates_in};
use super::quintic::{Shape, highest, quintic, shape, slope_root};
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::response::Extreme;
use wide::f64x4;

/// The largest value of a quantity on the segments that have been searched.
pub struct Search<Q> {
    /// The quantity.
    pub quantity: Q,
    /// The largest value so far, and its time.
    pub record: Extreme,
    /// Halvings left in the segment that is searched.
    halvings: u32,
    /// Whether the sharp bound is in use in this segment.
    sharp: bool,
    /// A bound on the largest value where a search ended before its bounds could decide.
    undecided: f64,
    /// The work so far, see [`Observer::search_work`](super::observer::Observer::search_work).
    pub search_work: u64,
}

/// An assumption for motions without a known bound (the interpolants of general methods): `R` relative to the variation at both ends,
/// `h |slope| + h² |curvature|`. A quantity that oscillates at the rate `2/h` deviates from its quintic by `2⁶ / 46080 = 1.4e-3` of its
/// amplitude.
const ASSUMED: f64 = 2e-3;

/// Rounding error of a value, relative to `ε` times the magnitudes of its terms: the search ignores smaller gains.
const ROUNDING: f64 = 8.0;

/// Limit on halvings in a segment. Two or three are common, and 20 are many; only where parameters are so many orders of magnitude
/// apart that slopes are lost in rounding would the search not end.
const HALVINGS: u32 = 64;

/// Work for the bounds of a segment, for a sharp bound, and for a moment inside a segment, which takes a separate step in a contact.
const SEGMENT_WORK: u64 = 2;
const SHARP_BOUND_WORK: u64 = 24;
const EVALUATION_WORK: u64 = 40;

/// Halvings after which a search uses the sharp bound.
const SHARP_AFTER: u32 = 3;

impl<Q> Search<Q> {
    /// A search that has seen nothing.
    pub fn new(quantity: Q) -> Self {
        Self {
            quantity,
            record: Extreme { value: f64::NEG_INFINITY, time: f64::NAN },
            halvings: 0,
            sharp: false,
            undecided: f64::NEG_INFINITY,
            search_work: 0,
        }
    }

    /// By how much a value may exceed the record because a search ended before its bounds could decide; 0 where the record is proven. In
    /// the undecided rest a maximum is still located where the slopes show one.
    pub fn doubt(&self) -> f64 {
        (self.undecided - self.record.value).max(0.0)
    }
}

/// Value, slope and curvature with respect to `θ`, from those with respect to time.
#[inline(always)]
pub fn in_theta([value, slope, curvature]: [f64; 3], [rate, rate_slope]: [f64; 2]) -> [f64; 3] {
    [value, slope * rate, curvature * rate * rate + slope * rate_slope]
}

/// A place in a segment: `θ`, the moment, and `[value, slope, curvature]` there.
pub type Place<const N: usize> = (f64, Knot<N>, [f64; 3]);

/// Whether the remainder makes up 40 % or more of the height of the bound above the lower of both ends: the bound contains 64/20 of it (see
/// `highest`).
fn is_loose<const N: usize>(remainder: f64, highest: f64, a: &Place<N>, b: &Place<N>) -> bool {
    remainder >= 0.125 * (highest - a.2[0].min(b.2[0]))
}

impl<Q> Search<Q> {
    /// Restarts the search for values above this one.
    pub fn restart(&mut self, record: Extreme) {
        (self.record, self.undecided) = (record, f64::NEG_INFINITY);
    }

    /// Keeps a value if it is the largest so far.
    #[inline]
    pub fn update_record(&mut self, value: f64, time: f64) {
        if value > self.record.value {
            self.record = Extreme { value, time };
        }
    }

    /// Begins the search of a segment.
    pub fn begin<const N: usize>(
        &mut self,
        segment: &dyn Segment<N>,
        a: &Place<N>,
        b: &Place<N>,
        remainder: f64,
    ) where
        Q: Quantity<N>,
    {
        (self.halvings, self.sharp) = (HALVINGS, false);
        self.search_work += SEGMENT_WORK * segment.cost();
        self.search(segment, a, b, remainder);
    }

    /// A bound on the largest value between two places that is coarse, but holds where [`Self::quintic_error`] is infinite.
    pub fn coarse_bound<const N: usize>(&self, segment: &dyn Segment<N>, a: &Place<N>, b: &Place<N>) -> f64
    where
        Q: Quantity<N>,
    {
        let (form, slopes) = (self.quantity.form(), [a.2[1], b.2[1]]);
        a.2[0].max(b.2[0]) + segment.rise(form, [&a.1, &b.1], slopes, b.0 - a.0)
    }

    /// Searches for a maximum above the record between two places. `remainder` bounds the deviation of the quantity from its quintic there.
    fn search<const N: usize>(&mut self, segment: &dyn Segment<N>, a: &Place<N>, b: &Place<N>, remainder: f64)
    where
        Q: Quantity<N>,
    {
        let coefficients = quintic(f64x4::splat(b.0 - a.0), a.2.map(f64x4::splat), b.2.map(f64x4::splat));
        let mut highest = if remainder.is_finite() {
            highest(coefficients, f64x4::splat(remainder)).to_array()[0]
        } else {
            f64::INFINITY
        };
        if is_loose(remainder, highest, a, b) {
            highest = highest.min(self.coarse_bound(segment, a, b));
        }
        // A bound that is NaN drops nothing.
        if highest <= self.record.value {
            return;
        }
        match shape(coefficients.map(|lanes| lanes.to_array()[0]), remainder) {
            Shape::EndsAreLargest => {} // and have been noted
            Shape::OneMaximum => self.refine_maximum(segment, a, b),
            Shape::Unknown => self.bisect(segment, a, b, remainder, highest),
        }
    }

    /// Searches both halves of a stretch on which no value exceeds `highest`. A half has a 64th of the remainder; a long search first
    /// computes a sharper one.
    fn bisect<const N: usize>(
        &mut self,
        segment: &dyn Segment<N>,
        a: &Place<N>,
        b: &Place<N>,
        mut remainder: f64,
        highest: f64,
    ) where
        Q: Quantity<N>,
    {
        if self.halvings <= HALVINGS - SHARP_AFTER {
            let size = self.quantity.size(&a.1.y).max(self.quantity.size(&b.1.y));
            let rounding = ROUNDING * f64::EPSILON * size;
            if highest <= self.record.value + rounding {
                return;
            }
            if self.halvings == 0 {
                self.undecided = self.undecided.max(highest);
                if a.2[1] > 0.0 && b.2[1] < 0.0 {
                    self.refine_maximum(segment, a, b);
                }
                return;
            }
            // Repeated wherever the bound of this stretch is loose.
            if !self.sharp || is_loose(remainder, highest, a, b) {
                self.sharp = true;
                self.search_work += SHARP_BOUND_WORK * segment.cost();
                let sharper = self.quintic_error(segment, a, b, true);
                if sharper < remainder {
                    return self.search(segment, a, b, sharper);
                }
            }
        }
        self.halvings -= 1;
        remainder /= 64.0;
        let middle = self.evaluate_at(segment, 0.5 * (a.0 + b.0));
        self.update_record(middle.2[0], middle.1.t);
        for (from, to) in [(a, &middle), (&middle, b)] {
            self.search(segment, from, to, remainder);
        }
    }

    fn evaluate_at<const N: usize>(&mut self, segment: &dyn Segment<N>, theta: f64) -> Place<N>
    where
        Q: Quantity<N>,
    {
        self.search_work += EVALUATION_WORK * segment.cost();
        let knot = segment.at(theta);
        (theta, knot, in_theta(rates_in(segment, &knot, &self.quantity), knot.clock))
    }

    /// A bound on the deviation of the quantity from its quintic between two places.
    pub fn quintic_error<const N: usize>(
        &self,
        segment: &dyn Segment<N>,
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

    /// The only maximum between two places, where the quantity is concave: Newton's method on the slope, safeguarded by bisection. The
    /// quantity is flat there: an error δ of the place costs δ², which the parabola corrects by `slope² / 2|curvature|`, so that an error
    /// of order δ³ is left.
    fn refine_maximum<const N: usize>(&mut self, segment: &dyn Segment<N>, a: &Place<N>, b: &Place<N>)
    where
        Q: Quantity<N>,
    {
        let (mut lower, mut upper) = (a.0, b.0);
        let mut theta = a.0 + slope_root(b.0 - a.0, a.2, b.2);
        for _ in 0..60 {
            let (_, Knot { t, clock: [rate, rate_slope], .. }, [value, slope, curvature]) =
                self.evaluate_at(segment, theta);
            self.update_record(value, t);
            if slope > 0.0 {
                lower = theta
            } else {
                upper = theta
            }
            let step = -slope / curvature;
            let gain = 0.5 * slope * step;
            if curvature < 0.0 && gain <= 1e-10 * value.abs() {
                // Where the quantity is almost level, the vertex of the parabola may lie far outside the bracket.
                let way = step.max(lower - theta).min(upper - theta);
                return self.update_record(value + gain, t + way * (rate + 0.5 * way * rate_slope));
            }
            let newton = theta + step;
            theta = if newton > lower && newton < upper { newton } else { 0.5 * (lower + upper) };
        }
    }
}
