//! An observer of the motion from a time on.

use super::observer::{Impact, Observer, Path};
use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::form::Form;
use crate::motion::knot::{Jet, Knot};
use crate::motion::segment::Segment;
use retune_model::Side;

/// An observer of a part of a run: from a time on, inside a segment if need be.
pub struct Since<O> {
    /// The observer of that part of the run.
    pub observer: O,
    from: f64,
    /// Whether that time has passed.
    began: bool,
}

impl<O> Since<O> {
    /// `observer` from time `from` (s) on.
    pub fn new(observer: O, from: f64) -> Self {
        Self { observer, from, began: from <= 0.0 }
    }
}

impl<O: Observer<4>> Observer<4> for Since<O> {
    fn watches_motion(&self) -> bool {
        self.observer.watches_motion()
    }
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let ends = segment.ends().map(|knot| knot.t);
        self.began |= ends[0] >= self.from;
        if self.began {
            self.observer.segment(segment);
        } else if ends[1] > self.from {
            self.observer.segment(&Tail::new(segment, self.from));
        }
    }
    fn path(&mut self, path: &dyn Path<4>) {
        if self.began {
            self.observer.path(path);
        } else {
            (0..path.pieces()).for_each(|piece| path.show(piece, &mut |part| self.see(part)));
        }
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.began |= steps.from().t >= self.from;
        if self.began {
            self.observer.steps(steps);
        } else if steps.time(steps.count()) > self.from {
            (0..steps.count()).for_each(|number| self.segment(&steps.step(number)));
        }
    }
    fn skips(&self, block: &Block<4>) -> bool {
        block.end <= self.from || (block.t >= self.from && self.observer.skips(block))
    }
    fn touch_down(&mut self, t: f64, side: Side) {
        if t >= self.from {
            self.observer.touch_down(t, side);
        }
    }
    fn impact(&mut self, impact: &Impact<4>) {
        if impact.after.t >= self.from {
            self.observer.impact(impact);
        }
    }
    fn discontinuity(&mut self) {
        self.observer.discontinuity();
    }
    fn search_work(&self) -> u64 {
        self.observer.search_work()
    }
}

/// The part of a segment after a moment inside it.
struct Tail<'a> {
    whole: &'a dyn Segment<4>,
    skipped: f64,
    begin: Knot<4>,
}

impl<'a> Tail<'a> {
    fn new(whole: &'a dyn Segment<4>, t: f64) -> Self {
        let (mut before, mut skipped) = (0.0, whole.length());
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (before + skipped);
            if whole.at(middle).t < t { before = middle } else { skipped = middle }
        }
        Self { whole, skipped, begin: whole.at(skipped) }
    }
}

impl Segment<4> for Tail<'_> {
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
    fn jet(&self, at: &Knot<4>) -> Option<Jet<4>> {
        self.whole.jet(at)
    }
    fn cost(&self) -> u64 {
        self.whole.cost()
    }
    fn quintic_error(&self, form: &Form<4>, ends: [&Knot<4>; 2], h: f64, sharp: bool) -> Option<f64> {
        self.whole.quintic_error(form, ends, h, sharp)
    }
    fn rise(&self, form: &Form<4>, ends: [&Knot<4>; 2], slopes: [f64; 2], h: f64) -> f64 {
        self.whole.rise(form, ends, slopes, h)
    }
}
