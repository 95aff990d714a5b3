//! What the contacts of a motion are like: how fast, how deep and how long.

use crate::error::SolverError;
use crate::motion::segment::Segment;
use crate::observe::observer::{Observer, Unobserved};
use crate::plan::{Plan, Request};
use crate::run::Follow;
use crate::settings::{Settings, Window};
use retune_model::{Coupled, Scene, Side};

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
    const NONE: Self = Self { count: 0, speed: 0.0, indentation: 0.0, shortest: f64::INFINITY, longest: 0.0 };
}

/// The contacts with the structure and with the obstacle in a window of the run of a scene from its start.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn collisions(
    scene: &Scene,
    window: Window,
    settings: &Settings,
) -> Result<[Collisions; 2], SolverError> {
    let Some(damper) = &scene.damper else { return Ok([Collisions::NONE; 2]) };
    let system = Coupled::new(&scene.primary, &scene.forcing, damper);
    let mut observer = Observed { system: &system, walls: [Collisions::NONE; 2], speed: 0.0, began: None };
    let plan = Plan::of(&system, settings, Request::Motion);
    system.follow(plan, window, settings, &mut Unobserved, &mut observer)?;
    Ok(observer.walls)
}

struct Observed<'a> {
    system: &'a Coupled,
    walls: [Collisions; 2],
    /// Speed of the bodies relative to each other at the end of the last segment, m/s.
    speed: f64,
    /// When the contact that lasts began, s, and with which wall.
    began: Option<(f64, Side)>,
}

/// A body that moves away is out of the wall from this share of the largest indentation on: general methods end their pieces there only to rounding.
const OUT: f64 = 1e-9;

impl Observed<'_> {
    /// Whether a contact has ended.
    fn is_out(&self, side: Side, y: &[f64; 4]) -> bool {
        let depth = self.system.indentation(y)[side as usize];
        depth <= OUT * self.walls[side as usize].indentation && side.sign() * (y[3] - y[1]) < 0.0
    }

    fn ends(&mut self, t: f64) {
        if let Some((began, side)) = self.began.take() {
            let wall = &mut self.walls[side as usize];
            wall.shortest = wall.shortest.min(t - began);
            wall.longest = wall.longest.max(t - began);
        }
    }
}

impl Observer<4> for Observed<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let [from, to] = segment.ends();
        let out_at_once = self.began.is_some_and(|(_, side)| self.is_out(side, &from.y));
        if segment.in_flight() || out_at_once {
            self.ends(from.t);
        } else {
            // The relative position is largest at an end of the segment, or where its rate vanishes between them.
            let rate = |theta: f64| {
                let y = segment.at(theta).y;
                y[3] - y[1]
            };
            let [mut low, mut high] = [0.0, segment.length()];
            let rises = rate(low);
            if rises * rate(high) < 0.0 {
                for _ in 0..f64::MANTISSA_DIGITS {
                    let middle = 0.5 * (low + high);
                    if rises * rate(middle) > 0.0 { low = middle } else { high = middle }
                }
            }
            for y in [from.y, to.y, segment.at(high).y] {
                for (wall, depth) in self.walls.iter_mut().zip(self.system.indentation(&y)) {
                    wall.indentation = wall.indentation.max(depth);
                }
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
