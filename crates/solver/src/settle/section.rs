//! The Poincaré section of a motion: its states at whole periods of the force.

use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::observe::observer::{Observer, Path};
use std::collections::VecDeque;

/// The latest states at whole periods of the force.
pub struct PoincareSection {
    period: f64,
    /// Periods that have passed.
    count: f64,
    most: usize,
    states: VecDeque<[f64; 4]>,
}

impl PoincareSection {
    /// For a force of this period, s; the latest `most` states are kept.
    pub fn new(period: f64, most: usize) -> Self {
        Self { period, count: 0.0, most, states: VecDeque::new() }
    }

    /// Periods that have passed.
    pub fn count(&self) -> f64 {
        self.count
    }

    /// Lets some periods pass and begins anew after them.
    pub fn skip(&mut self, periods: f64) {
        self.count += periods;
        self.states.clear();
    }

    /// The latest states.
    pub fn states(&mut self) -> &[[f64; 4]] {
        self.states.make_contiguous()
    }

    /// The next time at which a state is kept, s.
    fn next(&self) -> f64 {
        (self.count + 1.0) * self.period
    }
}

impl Observer<4> for PoincareSection {
    fn segment(&mut self, segment: &impl Segment<4>) {
        let [begin, end] = segment.ends();
        while self.next() <= end.t {
            let state = match self.next() {
                t if t == end.t => end.y,
                t if t <= begin.t => begin.y, // between two pieces, by rounding
                t => segment.at_time(t).y,
            };
            self.count += 1.0;
            if self.states.len() == self.most {
                self.states.pop_front();
            }
            self.states.push_back(state);
        }
    }
    fn path(&mut self, path: &impl Path<4>) {
        // A path does not say how long it is; its last piece does.
        let mut end = End(f64::NEG_INFINITY);
        path.show(path.pieces() - 1, &mut end);
        if self.next() <= end.0 {
            (0..path.pieces()).for_each(|piece| path.show(piece, self));
        }
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        if self.next() <= steps.time(steps.count()) {
            (0..steps.count()).for_each(|number| self.segment(&steps.step(number)));
        }
    }
}

/// When the last piece ended, s.
struct End(f64);

impl Observer<4> for End {
    fn segment(&mut self, segment: &impl Segment<4>) {
        self.0 = segment.ends()[1].t;
    }
}
