//! The Poincaré section of a motion: its states at whole periods of the force.

use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::observe::observer::{Observer, Part, Path};
use std::collections::VecDeque;

/// Counts whole periods of the force.
pub struct Periods {
    period: f64,
    /// Periods that have passed.
    count: f64,
}

impl Periods {
    pub fn of(period: f64) -> Self {
        Self { period, count: 0.0 }
    }

    /// The end of the next period, s.
    fn next(&self) -> f64 {
        (self.count + 1.0) * self.period
    }

    /// Whether the next period has ended at a time, s.
    pub fn is_due_by(&self, t: f64) -> bool {
        self.next() <= t
    }

    pub fn skip(&mut self, periods: usize) {
        self.count += periods as f64;
    }

    /// Passes the states at the ends of the periods in a segment to `keep`; returns the end of the latest period, s.
    pub fn states(&mut self, segment: &dyn Segment<4>, mut keep: impl FnMut([f64; 4])) -> f64 {
        let [begin, end] = segment.ends();
        while self.next() <= end.t {
            keep(match self.next() {
                t if t == end.t => end.y,
                t if t <= begin.t => begin.y, // between two pieces, by rounding
                t => segment.at_time(t).y,
            });
            self.count += 1.0;
        }
        self.count * self.period
    }
}

/// The latest states at whole periods of the force.
pub struct PoincareSection {
    periods: Periods,
    most: usize,
    states: VecDeque<[f64; 4]>,
}

impl PoincareSection {
    /// For a force of this period, s; the latest `most` states are kept.
    pub fn new(period: f64, most: usize) -> Self {
        Self { periods: Periods::of(period), most, states: VecDeque::new() }
    }

    pub fn states(&mut self) -> &[[f64; 4]] {
        self.states.make_contiguous()
    }
}

impl Observer<4> for PoincareSection {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let Self { periods, most, states } = self;
        periods.states(segment, |state| {
            if states.len() == *most {
                states.pop_front();
            }
            states.push_back(state);
        });
    }
    fn path(&mut self, path: &dyn Path<4>) {
        // A path does not say how long it is; its last piece does.
        let mut end = f64::NEG_INFINITY;
        path.show(path.pieces() - 1, &mut |part| {
            if let Part::Segment(segment) = part {
                end = segment.ends()[1].t;
            }
        });
        if self.periods.is_due_by(end) {
            (0..path.pieces()).for_each(|piece| path.show(piece, &mut |part| self.see(part)));
        }
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        if self.periods.is_due_by(steps.time(steps.count())) {
            (0..steps.count()).for_each(|number| self.segment(&steps.step(number)));
        }
    }
}
