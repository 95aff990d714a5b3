//! The data of rigid walls: what is prepared for a system, and a step of the motion in which a wall holds the damper.

use crate::linear::flow::{Expansion, Flow};
use crate::linear::steps::Step;
use crate::motion::form::Form;
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::system::held_linear;
use retune_model::Coupled;

/// Rigid walls, prepared for a system.
pub(super) struct RigidWalls {
    pub restitution: f64,
    /// The flow of both bodies as one.
    pub held: Flow<4>,
}

impl RigidWalls {
    /// The rigid walls of a system, in steps of at most `longest` seconds; `None` if it has none.
    pub(super) fn of(system: &Coupled, longest: f64) -> Option<Box<Self>> {
        let restitution = system.restitution()?;
        Some(Box::new(Self { restitution, held: Flow::new(held_linear(system), longest) }))
    }
}

/// A step of the motion in which a wall holds the damper.
pub(super) struct HeldStep<'a> {
    step: Step<'a, 4>,
    wall: f64,
}

impl<'a> HeldStep<'a> {
    /// The step from a moment over `length` seconds; `last` is its end time (s) where that is known better than by their sum.
    pub(super) fn new(
        flow: &'a Flow<4>,
        from: Knot<4>,
        motion: &Expansion<4>,
        (length, last): (f64, Option<f64>),
        wall: f64,
    ) -> Self {
        // Only the bounds by its Taylor polynomial hold: those by the energy are for flight.
        let mut step = Step::part(flow, from, motion, length, f64::INFINITY);
        let end = on_wall(*step.ends()[1], wall);
        *step.end() = Knot { t: last.unwrap_or(end.t), ..end };
        Self { step, wall }
    }
}

/// A moment on a wall: its place and speed are those of the structure by definition rather than by arithmetic.
fn on_wall(knot: Knot<4>, wall: f64) -> Knot<4> {
    let [x, v, ..] = knot.y;
    Knot { y: [x, v, x + wall, v], ..knot }
}

impl Segment<4> for HeldStep<'_> {
    fn ends(&self) -> [&Knot<4>; 2] {
        self.step.ends()
    }
    fn length(&self) -> f64 {
        self.step.length()
    }
    fn at(&self, theta: f64) -> Knot<4> {
        on_wall(self.step.at(theta), self.wall)
    }
    fn at_time(&self, t: f64) -> Knot<4> {
        on_wall(self.step.at_time(t), self.wall)
    }
    fn quintic_error(&self, form: &Form<4>, ends: [&Knot<4>; 2], h: f64, _sharp: bool) -> Option<f64> {
        self.step.quintic_error(form, ends, h, true)
    }
}
