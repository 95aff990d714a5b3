//! What the contacts of a motion are like: how fast, how deep and how long.

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
    /// No contact.
    pub(crate) const NONE: Self =
        Self { count: 0, speed: 0.0, indentation: 0.0, shortest: f64::INFINITY, longest: 0.0 };
}

/// Watches contacts.
pub(crate) struct Touched<'a> {
    system: &'a Coupled,
    /// Those with each wall.
    pub walls: [Collisions; 2],
    /// Speed of the bodies relative to each other at the end of the last segment, m/s.
    speed: f64,
    /// When the contact that lasts began, s, and with which wall.
    began: Option<(f64, Side)>,
}

/// A body that moves away is out of the wall from this share of the largest indentation on: general methods end their pieces there only to rounding.
const OUT: f64 = 1e-9;

impl<'a> Touched<'a> {
    /// Of a system; none yet.
    pub fn new(system: &'a Coupled) -> Self {
        Self { system, walls: [Collisions::NONE; 2], speed: 0.0, began: None }
    }

    /// Whether a contact has ended.
    fn is_out(&self, side: Side, y: &[f64; 4]) -> bool {
        let depth = self.system.indentation(y)[side as usize];
        depth <= OUT * self.walls[side as usize].indentation && side.sign() * (y[3] - y[1]) < 0.0
    }

    fn deepens(&mut self, y: &[f64; 4]) {
        for (wall, depth) in self.walls.iter_mut().zip(self.system.indentation(y)) {
            wall.indentation = wall.indentation.max(depth);
        }
    }

    fn ends(&mut self, t: f64) {
        if let Some((began, side)) = self.began.take() {
            let wall = &mut self.walls[side as usize];
            wall.shortest = wall.shortest.min(t - began);
            wall.longest = wall.longest.max(t - began);
        }
    }
}

impl Observer<4> for Touched<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let [from, to] = segment.ends();
        let out_at_once = self.began.is_some_and(|(_, side)| self.is_out(side, &from.y));
        if segment.in_flight() || out_at_once {
            self.ends(from.t);
        } else {
            // The relative position is largest at an end of the segment, or where its rate vanishes between them.
            let rate = |y: &[f64; 4]| y[3] - y[1];
            let [first, last] = [rate(&from.y), rate(&to.y)];
            self.deepens(&from.y);
            self.deepens(&to.y);
            if first * last < 0.0 {
                let toward = |theta: f64| first.signum() * rate(&segment.at(theta).y);
                let turn = falls(toward, (0.0, first.abs()), (segment.length(), -last.abs()));
                self.deepens(&segment.at(turn).y);
            }
            if self.began.is_some_and(|(_, side)| self.is_out(side, &to.y)) {
                self.ends(to.t);
            }
        }
        self.speed = (to.y[3] - to.y[1]).abs();
    }
    fn touch_down(&mut self, t: f64, side: Side) {
        self.ends(t);
        self.began = Some((t, side));
        let wall = &mut self.walls[side as usize];
        wall.count += 1;
        wall.speed = wall.speed.max(self.speed);
    }
}
