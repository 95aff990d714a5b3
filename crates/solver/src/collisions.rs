//! Statistics of the contacts of a motion: speed, indentation and duration.

use crate::motion::segment::Segment;
use crate::observe::falls::falls;
use crate::observe::observer::Observer;
use retune_model::{Coupled, Side};

/// The contacts with one wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collisions {
    /// Touch-downs.
    pub count: u64,
    /// Largest speed at touch-down, of one body relative to the other, m/s.
    pub speed: f64,
    /// Largest indentation, m.
    pub indentation: f64,
    /// Duration of the shortest contact that has begun and ended, s; infinite if none has.
    pub shortest: f64,
    /// Duration of the longest, s; 0 if none has.
    pub longest: f64,
}

impl Collisions {
    pub(crate) const NONE: Self =
        Self { count: 0, speed: 0.0, indentation: 0.0, shortest: f64::INFINITY, longest: 0.0 };
}

/// Collects the statistics of contacts.
pub(crate) struct CollisionObserver<'a> {
    system: &'a Coupled,
    /// The contacts with each wall.
    pub walls: [Collisions; 2],
    /// Speed of the bodies relative to each other at the end of the last segment, m/s.
    speed: f64,
    /// When the present contact began, s, and with which wall.
    began: Option<(f64, Side)>,
}

/// Share of the largest indentation below which a body that moves away has left the wall: general methods end their steps there only to
/// rounding.
const SEPARATED: f64 = 1e-9;

impl<'a> CollisionObserver<'a> {
    pub fn new(system: &'a Coupled) -> Self {
        Self { system, walls: [Collisions::NONE; 2], speed: 0.0, began: None }
    }

    /// Whether a contact has ended.
    fn has_separated(&self, side: Side, y: &[f64; 4]) -> bool {
        let depth = self.system.indentation(y)[side as usize];
        depth <= SEPARATED * self.walls[side as usize].indentation && side.sign() * (y[3] - y[1]) < 0.0
    }

    fn record_depth(&mut self, y: &[f64; 4]) {
        for (wall, depth) in self.walls.iter_mut().zip(self.system.indentation(y)) {
            wall.indentation = wall.indentation.max(depth);
        }
    }

    fn end_contact(&mut self, t: f64) {
        if let Some((began, side)) = self.began.take() {
            let wall = &mut self.walls[side as usize];
            wall.shortest = wall.shortest.min(t - began);
            wall.longest = wall.longest.max(t - began);
        }
    }
}

impl Observer<4> for CollisionObserver<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let [from, to] = segment.ends();
        let separated_at_start = self.began.is_some_and(|(_, side)| self.has_separated(side, &from.y));
        if segment.in_flight() || separated_at_start {
            self.end_contact(from.t);
        } else {
            // The relative position is largest at an end of the segment, or where its rate vanishes between them.
            let rate = |y: &[f64; 4]| y[3] - y[1];
            let [first, last] = [rate(&from.y), rate(&to.y)];
            self.record_depth(&from.y);
            self.record_depth(&to.y);
            if first * last < 0.0 {
                let toward = |theta: f64| first.signum() * rate(&segment.at(theta).y);
                let turn = falls(toward, (0.0, first.abs()), (segment.length(), -last.abs()));
                self.record_depth(&segment.at(turn).y);
            }
            if self.began.is_some_and(|(_, side)| self.has_separated(side, &to.y)) {
                self.end_contact(to.t);
            }
        }
        self.speed = (to.y[3] - to.y[1]).abs();
    }
    fn touch_down(&mut self, t: f64, side: Side) {
        self.end_contact(t);
        self.began = Some((t, side));
        let wall = &mut self.walls[side as usize];
        wall.count += 1;
        wall.speed = wall.speed.max(self.speed);
    }
}
