//! The largest value of a quantity over a motion.

use crate::observe::{Knot, MOST_KNOTS, Observer, Path, Quantity, Segment};
use crate::settings::Extreme;
use crate::steps::{Steps, shifted};
use wide::f64x4;

/// The largest value of a quantity, located where its rate of change is zero, to rounding.
///
/// On each segment the quintic that meets the value and its first two derivatives at both ends is the screen: only where it
/// could exceed the record (its Bernstein coefficients bound it; [`SCREEN`] allows for the remainder) is the exact motion looked
/// at.
pub struct Peak<Q> {
    quantity: Q,
    record: Extreme,
    cutoff: f64,
    last: Option<(f64, [f64; 3])>,
    /// Halvings left in the segment being searched.
    halvings: u32,
}

/// Share of what a quantity varies over a segment, `h |slope| + h² |curvature|` at both ends, by which it may leave its
/// quintic: for one that varies no faster than `2/h` (energies vary at twice the rate of the motion, and steps are about
/// `1/rate` long, see [`Steps::fineness`]) the remainder is `2⁶ / 46080` of its amplitude.
const SCREEN: f64 = 2e-3;

/// Most halvings in a segment. A motion needs a few; only where a quantity is level to rounding (a stroke that touches its
/// record of 0 at each lift-off, the energy of a damper that does not move yet) is there no end of them.
const HALVINGS: u32 = 64;

impl<Q> Peak<Q> {
    /// Watches a quantity; the run may end early once its value exceeds `cutoff`.
    pub fn new(quantity: Q, cutoff: f64) -> Self {
        Self {
            quantity,
            record: Extreme { value: f64::NEG_INFINITY, time: f64::NAN },
            cutoff,
            last: None,
            halvings: 0,
        }
    }

    /// The record so far.
    pub fn record(&self) -> Extreme {
        self.record
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

/// The quintic that meets value, slope and curvature at both ends of an interval, by its Bernstein coefficients: it stays
/// between the least and the largest of them, and its slope between those of their differences times `5/h`.
#[inline(always)]
fn quintic(h: f64, a: [f64x4; 3], b: [f64x4; 3]) -> [f64x4; 6] {
    let (fifth, twentieth) = (h / 5.0, h * h / 20.0);
    let (inner_a, inner_b) = (a[0] + a[1] * fifth, b[0] - b[1] * fifth);
    let deep_a = inner_a + a[1] * fifth + a[2] * twentieth;
    let deep_b = inner_b - b[1] * fifth + b[2] * twentieth;
    [a[0], inner_a, deep_a, deep_b, inner_b, b[0]]
}

/// A bound on what has these coefficients but for a remainder `r s³ (h - s)³ / (h/2)⁶`: that is [`MIDDLE`]` r` more in the middle one of
/// seven, when the degree is raised by one; the others are means of these six.
#[inline(always)]
fn highest(coefficients: [f64x4; 6], remainder: f64x4) -> f64x4 {
    let middle = (coefficients[2] + coefficients[3]) * 0.5 + remainder * MIDDLE;
    coefficients.into_iter().fold(middle, f64x4::fast_max)
}

/// `t³ (1 - t)³` is a twentieth of the middle Bernstein polynomial of degree six, and at most 1/64.
const MIDDLE: f64 = 64.0 / 20.0;

/// What a quantity varies by over a length `h`, from its rates at one end.
#[inline(always)]
fn variation(h: f64, [_, slope, curvature]: [f64x4; 3]) -> f64x4 {
    (slope.abs() + curvature.abs() * h) * h
}

/// Where the slope is zero on an interval of length `h` at whose ends it is positive, then negative: a root of the cubic that
/// meets slope and curvature at both ends.
fn slope_root(h: f64, a: [f64; 3], b: [f64; 3]) -> f64 {
    let (c0, c1) = (a[1], h * a[2]);
    let (c2, c3) = (3.0 * (b[1] - a[1]) - h * (2.0 * a[2] + b[2]), 2.0 * (a[1] - b[1]) + h * (a[2] + b[2]));
    let mut s = a[1] / (a[1] - b[1]);
    for _ in 0..3 {
        let (value, slope) = (c0 + s * (c1 + s * (c2 + s * c3)), c1 + s * (2.0 * c2 + s * 3.0 * c3));
        s = (s - value / slope).clamp(0.0, 1.0);
    }
    if s.is_nan() { 0.5 * h } else { s * h }
}

/// A place in a segment with `[value, slope, curvature]` there.
type Place = (f64, [f64; 3]);

impl<Q> Peak<Q> {
    /// Looks for a maximum above the record between two places.
    ///
    /// Branch and bound: an interval on which the quantity stays below the record, or is monotone, is dropped; one with a
    /// simple maximum is solved by Newton steps on the slope; any other is halved. `remainder` bounds how far the quantity
    /// leaves its quintic; its slope leaves the quintic's by at most 3.5 times that over `h` (a sixth-order remainder).
    fn search<const N: usize>(
        &mut self,
        segment: &impl Segment<N>,
        (a, at_a): Place,
        (b, at_b): Place,
        remainder: f64,
    ) where
        Q: Quantity<N>,
    {
        let h = b - a;
        let coefficients = quintic(h, at_a.map(f64x4::splat), at_b.map(f64x4::splat));
        if highest(coefficients, f64x4::splat(remainder)).to_array()[0] <= self.record.value {
            return;
        }
        let c = coefficients.map(|lanes| lanes.to_array()[0]);
        let rises = [c[1] - c[0], c[2] - c[1], c[3] - c[2], c[4] - c[3], c[5] - c[4]];
        let next_to_middle = [rises[1] / 3.0 + rises[2] / 2.0, rises[2] / 2.0 + rises[3] / 3.0];
        let monotone = |sign: f64| {
            rises.iter().all(|rise| sign * rise >= 0.0)
                && next_to_middle.iter().all(|rise| sign * rise >= MIDDLE * remainder)
        };
        if monotone(1.0) || monotone(-1.0) {
            return; // the larger end has been noted
        }
        let exact = |theta: f64| {
            let knot = segment.at(theta);
            (knot, in_theta(self.quantity.rates(knot.drive, &knot.y), knot.clock))
        };
        if at_a[1] > 0.0 && at_b[1] < 0.0 && at_a[2] < 0.0 && at_b[2] < 0.0 {
            // Concave at both ends: one maximum. The quantity is flat there: an error δ of its place costs δ², and that is
            // put right by the parabola, `slope² / 2|curvature|` more, which leaves an error of order δ³.
            let (mut lower, mut upper) = (a, b);
            let mut theta = a + slope_root(h, at_a, at_b);
            for _ in 0..60 {
                let (Knot { t, clock: [rate, rate_slope], .. }, [value, slope, curvature]) = exact(theta);
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
            return;
        }
        let middle = 0.5 * (a + b);
        if remainder < 1e-15 * self.record.value.abs() || self.halvings == 0 {
            return;
        }
        self.halvings -= 1;
        let (knot, at_middle) = exact(middle);
        note(&mut self.record, at_middle[0], knot.t);
        self.search(segment, (a, at_a), (middle, at_middle), remainder / 64.0);
        self.search(segment, (middle, at_middle), (b, at_b), remainder / 64.0);
    }
}

impl<const N: usize, Q> Observer<N> for Peak<Q>
where
    Q: Quantity<N>,
{
    #[inline(always)]
    fn segment(&mut self, segment: &impl Segment<N>) {
        let [a, b] = segment.ends();
        let rates_a = match self.last {
            Some((t, rates)) if t == a.t => rates,
            _ => {
                let rates = self.quantity.rates(a.drive, &a.y);
                note(&mut self.record, rates[0], a.t);
                rates
            }
        };
        let rates_b = self.quantity.rates(b.drive, &b.y);
        self.last = Some((b.t, rates_b));
        note(&mut self.record, rates_b[0], b.t);
        let (at_a, at_b) = (in_theta(rates_a, a.clock), in_theta(rates_b, b.clock));
        let h = segment.length();
        let remainder = SCREEN
            * (variation(h, at_a.map(f64x4::splat)) + variation(h, at_b.map(f64x4::splat))).to_array()[0];
        self.halvings = HALVINGS;
        self.search(segment, (0.0, at_a), (h, at_b), remainder);
    }

    /// Looks only between knots where the record could be broken: a quantity that the knots resolve rises between two of them by
    /// less than half the larger of its second differences there (by an eighth, were it a parabola on even knots).
    #[inline(always)]
    fn path(&mut self, path: &impl Path<N>) {
        let mut values = [f64::NEG_INFINITY; MOST_KNOTS];
        let mut count = 0;
        path.states(|y| {
            [values[count], ..] = self.quantity.rates([0.0; 2], y);
            count += 1;
        });
        let mut bends = [0.0; MOST_KNOTS];
        for knot in 2..count {
            bends[knot - 1] = (values[knot] - 2.0 * values[knot - 1] + values[knot - 2]).abs();
        }
        (bends[0], bends[count - 1]) = (bends[1], bends[count - 2]);
        for piece in 0..count - 1 {
            let rise = 0.5 * bends[piece].max(bends[piece + 1]);
            if values[piece].max(values[piece + 1]) + rise > self.record.value {
                path.show(piece, self);
            }
        }
    }

    /// The screen of [`Self::segment`] for all steps side by side.
    #[inline(always)]
    fn steps(&mut self, steps: &Steps<'_, N>) {
        let (from, to) = (steps.from(), steps.ends());
        let first = match self.last {
            Some((t, rates)) if t == from.t => rates,
            _ => self.quantity.rates(from.drive, &from.y),
        };
        let ends = self.quantity.rates_in_flight(&to.drive, &to.y);
        let begins = [0, 1, 2].map(|order| shifted(first[order], ends[order]));
        let h = steps.length();
        let remainder = (variation(h, begins) + variation(h, ends)) * (SCREEN * steps.fineness());
        let highest = highest(quintic(h, begins, ends), remainder);
        let last = steps.count() - 1;
        self.last = Some((steps.time(last + 1), ends.map(|lanes| lanes.to_array()[last])));
        // The values at both ends are among the coefficients.
        let above = highest.simd_gt(f64x4::splat(self.record.value)).to_bitmask();
        if above & ((2 << last) - 1) == 0 {
            return;
        }
        for number in 0..=last {
            note(&mut self.record, begins[0].to_array()[number], steps.time(number));
            note(&mut self.record, ends[0].to_array()[number], steps.time(number + 1));
        }
        for number in (0..=last).filter(|number| above >> number & 1 == 1) {
            self.halvings = HALVINGS;
            let [a, b] = [begins, ends].map(|all| all.map(|lanes| lanes.to_array()[number]));
            self.search(&steps.step(number), (0.0, a), (h, b), remainder.to_array()[number]);
        }
    }

    fn satisfied(&self) -> bool {
        self.record.value > self.cutoff
    }
}
