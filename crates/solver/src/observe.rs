//! What a run is looked at with. Methods hand over their motion piece by piece; observers keep what was asked for.

use crate::settings::Extreme;
use retune_model::{Drive, Side};

/// A moment of the motion.
#[derive(Clone, Copy, Debug)]
pub struct Knot<const N: usize> {
    /// Time, s.
    pub t: f64,
    /// `[P cos ωt, P sin ωt]`, N.
    pub drive: Drive,
    /// State.
    pub y: [f64; N],
    /// `[dt/dθ, d²t/dθ²]`: how time runs in the coordinate in which the piece is smooth. `[1, 0]` where that is time itself.
    pub clock: [f64; 2],
}

/// A piece of the motion on which it is smooth in its own coordinate `θ`, from 0 to `length`.
pub trait Segment<const N: usize> {
    /// First and last moment.
    fn ends(&self) -> [&Knot<N>; 2];
    /// Length in `θ`.
    fn length(&self) -> f64;
    /// The moment at `θ`.
    fn at(&self, theta: f64) -> Knot<N>;
    /// The moment at time `t` (s) inside the piece.
    fn at_time(&self, t: f64) -> Knot<N>;
}

/// A stretch of the motion known at its knots; what lies between them is computed for who asks.
pub trait Path<const N: usize> {
    /// Number of pieces, one less than there are knots, of which there are at most [`MOST_KNOTS`].
    fn pieces(&self) -> usize;
    /// Visits the states at the knots in their order.
    fn states(&self, visit: impl FnMut(&[f64; N]));
    /// Shows the piece that follows a knot.
    fn show(&self, piece: usize, observer: &mut impl Observer<N>);
}

/// Most knots of a [`Path`].
pub const MOST_KNOTS: usize = 18;

/// Follows a run.
pub trait Observer<const N: usize> {
    /// A piece of the motion has been computed.
    fn segment(&mut self, segment: &impl Segment<N>);
    /// Many pieces at once. To look at them one by one is always right.
    fn path(&mut self, path: &impl Path<N>)
    where
        Self: Sized,
    {
        for piece in 0..path.pieces() {
            path.show(piece, self);
        }
    }
    /// The damper has touched a wall.
    fn touch_down(&mut self, _t: f64, _side: Side) {}
    /// Nothing that can still happen will change what is kept: the run may end here.
    fn satisfied(&self) -> bool {
        false
    }
}

/// Sees nothing: for the transient before a window.
pub struct Unobserved;

impl<const N: usize> Observer<N> for Unobserved {
    fn segment(&mut self, _segment: &impl Segment<N>) {}
    fn path(&mut self, _path: &impl Path<N>) {}
}

/// The largest value of a quantity, located where its rate of change is zero, to rounding.
///
/// `rates` gives the quantity with its first two time derivatives. On each segment the quintic that meets all three at both
/// ends is the screen: only where it could exceed the record (its Bernstein coefficients bound it; [`SCREEN`] allows for
/// the remainder) is the exact motion looked at.
pub struct Peak<F> {
    rates: F,
    record: Extreme,
    cutoff: f64,
    last: Option<(f64, [f64; 3])>,
    /// Halvings left in the segment being searched.
    halvings: u32,
}

/// Share of what a quantity varies over a segment, `h |slope| + h² |curvature|` at both ends, by which it may leave its
/// quintic: for one that varies no faster than `2/h` (flight steps are `1/rate` long, and energies vary at twice the rate of
/// the motion) the remainder is `2⁶ / 46080` of its amplitude.
const SCREEN: f64 = 2e-3;

/// Most halvings in a segment. A motion needs a few; only where a quantity is level to rounding (a stroke that touches its
/// record of 0 at each lift-off, the energy of a damper that does not move yet) is there no end of them.
const HALVINGS: u32 = 200;

impl<F> Peak<F> {
    /// Watches the quantity whose value and first two time derivatives `rates(drive, y)` returns; the value itself must depend on
    /// the state alone, for between the ends of a [`Path`] it is asked for without the force. The run may end early once
    /// the value exceeds `cutoff`.
    pub fn new(rates: F, cutoff: f64) -> Self {
        Self {
            rates,
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
fn quintic(h: f64, a: [f64; 3], b: [f64; 3]) -> [f64; 6] {
    let (fifth, twentieth) = (h / 5.0, h * h / 20.0);
    let (inner_a, inner_b) = (a[0] + fifth * a[1], b[0] - fifth * b[1]);
    let deep_a = inner_a + fifth * a[1] + twentieth * a[2];
    let deep_b = inner_b - fifth * b[1] + twentieth * b[2];
    [a[0], inner_a, deep_a, deep_b, inner_b, b[0]]
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

impl<F> Peak<F> {
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
        F: Fn(Drive, &[f64; N]) -> [f64; 3],
    {
        let h = b - a;
        let coefficients = quintic(h, at_a, at_b);
        let highest = coefficients.into_iter().fold(f64::NEG_INFINITY, |a, b| if a > b { a } else { b });
        if highest + remainder <= self.record.value {
            return;
        }
        let steps = || coefficients.windows(2).map(|pair| pair[1] - pair[0]);
        if steps().all(|step| step > 0.7 * remainder) || steps().all(|step| step < -0.7 * remainder) {
            return; // the larger end has been noted
        }
        let exact = |theta: f64| {
            let knot = segment.at(theta);
            (knot, in_theta((self.rates)(knot.drive, &knot.y), knot.clock))
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

impl<const N: usize, F> Observer<N> for Peak<F>
where
    F: Fn(Drive, &[f64; N]) -> [f64; 3],
{
    #[inline(always)]
    fn segment(&mut self, segment: &impl Segment<N>) {
        let [a, b] = segment.ends();
        let rates_a = match self.last {
            Some((t, rates)) if t == a.t => rates,
            _ => {
                let rates = (self.rates)(a.drive, &a.y);
                note(&mut self.record, rates[0], a.t);
                rates
            }
        };
        let rates_b = (self.rates)(b.drive, &b.y);
        self.last = Some((b.t, rates_b));
        note(&mut self.record, rates_b[0], b.t);
        let (at_a, at_b) = (in_theta(rates_a, a.clock), in_theta(rates_b, b.clock));
        let h = segment.length();
        let variation = |[_, slope, curvature]: [f64; 3]| h * (slope.abs() + h * curvature.abs());
        let remainder = SCREEN * (variation(at_a) + variation(at_b));
        self.halvings = HALVINGS;
        self.search(segment, (0.0, at_a), (h, at_b), remainder);
    }

    /// Looks only between knots where the record could be broken: a quantity that the knots resolve rises between them by
    /// less than its largest second difference (by an eighth of it, were it a parabola on even knots).
    #[inline(always)]
    fn path(&mut self, path: &impl Path<N>) {
        let mut values = [f64::NEG_INFINITY; MOST_KNOTS];
        let mut count = 0;
        path.states(|y| {
            [values[count], ..] = (self.rates)([0.0; 2], y);
            count += 1;
        });
        let bend = values[..count].windows(3).map(|v| (v[2] - 2.0 * v[1] + v[0]).abs()).fold(0.0, f64::max);
        for (piece, ends) in values[..count].windows(2).enumerate() {
            if ends[0].max(ends[1]) + bend > self.record.value {
                path.show(piece, self);
            }
        }
    }

    fn satisfied(&self) -> bool {
        self.record.value > self.cutoff
    }
}
