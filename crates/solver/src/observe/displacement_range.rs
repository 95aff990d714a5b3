//! The range of the relative displacement, from which stroke and contact forces follow.

use super::observer::{Observer, Path};
use super::quantity::RelativePosition;
use super::running_maximum::RunningMaximum;
use crate::linear::steps::Steps;
use crate::motion::form::Form;
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::response::Extreme;
use retune_model::{Coupled, Side, hertz_force};

/// The ends of the relative displacement `x2 - x1` from a time on.
pub struct DisplacementRange<'a> {
    system: &'a Coupled,
    from: f64,
    cutoff: f64,
    /// Whether that time has passed.
    began: bool,
    ends: [RunningMaximum<RelativePosition<'a>>; 2],
}

impl<'a> DisplacementRange<'a> {
    /// Watches a damper from time `from` (s) on; `cutoff` is for whoever reads it.
    pub fn new(system: &'a Coupled, from: f64, cutoff: f64) -> Self {
        let end = |sign: f64| RunningMaximum::new(RelativePosition::new(system, sign), f64::INFINITY);
        Self { system, from, cutoff, began: from <= 0.0, ends: [1.0, -1.0].map(end) }
    }

    /// The value above which its reader needs no more.
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// The stroke, m, and when; `-∞` and NaN while no motion has been seen.
    pub fn stroke(&self) -> Extreme {
        let rest = self.system.rest_distance();
        self.larger(|_, place| (place - rest).abs())
    }

    /// The largest contact force on either wall, N, and when; `-∞` and NaN while no motion has been seen.
    pub fn force(&self) -> Extreme {
        let system = self.system;
        self.larger(|side, place| hertz_force(system.hertz(side), side.sign() * (place - system.wall(side))))
    }

    /// The larger of a value at both ends of the range, the one nearest to each wall.
    fn larger(&self, value: impl Fn(Side, f64) -> f64) -> Extreme {
        let [farthest, nearest] = self.ends.each_ref().map(RunningMaximum::record);
        if farthest.value == f64::NEG_INFINITY {
            return farthest;
        }
        let far = Extreme { value: value(Side::Obstacle, farthest.value), ..farthest };
        let near = Extreme { value: value(Side::Primary, -nearest.value), ..nearest };
        if near.value > far.value { near } else { far }
    }
}

impl Observer<4> for DisplacementRange<'_> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        let ends = segment.ends().map(|knot| knot.t);
        self.began |= ends[0] >= self.from;
        if self.began {
            self.ends.segment(segment);
        } else if ends[1] > self.from {
            self.ends.segment(&Tail::new(segment, self.from));
        }
    }
    fn path(&mut self, path: &impl Path<4>) {
        if self.began {
            self.ends.path(path);
        } else {
            (0..path.pieces()).for_each(|piece| path.show(piece, self));
        }
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.began |= steps.from().t >= self.from;
        if self.began {
            self.ends.steps(steps);
        } else if steps.time(steps.count()) > self.from {
            (0..steps.count()).for_each(|number| self.segment(&steps.step(number)));
        }
    }
}

/// The part of a segment after a moment inside it.
struct Tail<'a, S> {
    whole: &'a S,
    skipped: f64,
    begin: Knot<4>,
}

impl<'a, S: Segment<4>> Tail<'a, S> {
    fn new(whole: &'a S, t: f64) -> Self {
        let (mut before, mut skipped) = (0.0, whole.length());
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (before + skipped);
            if whole.at(middle).t < t { before = middle } else { skipped = middle }
        }
        Self { whole, skipped, begin: whole.at(skipped) }
    }
}

impl<S: Segment<4>> Segment<4> for Tail<'_, S> {
    fn ends(&self) -> [&Knot<4>; 2] {
        [&self.begin, self.whole.ends()[1]]
    }
    fn length(&self) -> f64 {
        self.whole.length() - self.skipped
    }
    fn at(&self, theta: f64) -> Knot<4> {
        self.whole.at(self.skipped + theta)
    }
    fn at_time(&self, t: f64) -> Knot<4> {
        self.whole.at_time(t)
    }
    fn in_flight(&self) -> bool {
        self.whole.in_flight()
    }
    fn quintic_error(&self, form: &Form<4>, ends: [&Knot<4>; 2], h: f64, sharp: bool) -> Option<f64> {
        self.whole.quintic_error(form, ends, h, sharp)
    }
}
