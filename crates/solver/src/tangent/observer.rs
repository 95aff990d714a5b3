//! The derivatives of a run, taken along as it is followed.

use super::collision::{Change, Crossing, Kicks};
use super::contact::{Nodes, carry, nodes};
use super::flight::Flight;
use super::series::Moment;
use crate::error::SolverError;
use crate::hybrid::propagator::Motion;
use crate::linear::steps::Steps;
use crate::motion::linearised::LinearContact;
use crate::motion::segment::Segment;
use crate::observe::observer::{Observer, Path};
use crate::run::Follower;
use crate::settings::Settings;
use retune_model::{Coupled, Excitation, Parameter, Side};

/// Where a motion is after some time, and how that changes with where it started and with parameters, at a fixed time.
#[derive(Clone, Debug)]
pub struct Transition {
    /// The motion at its end.
    pub end: Motion,
    /// `by_state[j][i]`: the derivative of component `i` of the last state by component `j` of the first.
    pub by_state: [[f64; 4]; 4],
    /// The derivatives of the last state by each parameter, the first state held.
    pub by: Vec<[f64; 4]>,
}

/// Follows motions of one system with their derivatives.
pub struct Tangent<'a> {
    system: &'a Coupled,
    follower: Follower<'a>,
    flight: Flight,
    kicks: [Kicks; 2],
    parameters: Vec<Parameter>,
    /// Those on which the force depends.
    forces: Vec<bool>,
}

impl<'a> Tangent<'a> {
    /// Prepares for derivatives by these parameters, of stretches of at most `longest` seconds, by the exact method at the tolerance in
    /// the settings.
    pub fn new(system: &'a Coupled, settings: &Settings, longest: f64, parameters: &[Parameter]) -> Self {
        let bare = system.bare();
        let forces =
            |&parameter: &Parameter| [0.0, 1.0].iter().any(|t| bare.excitation_by(parameter, *t) != [0.0; 2]);
        let flight = Flight::new(system, parameters);
        Self {
            system,
            kicks: Side::BOTH.map(|side| Kicks::new(system, &flight, side, parameters)),
            follower: Follower::new(system, &settings.exact(), longest),
            flight,
            parameters: parameters.to_vec(),
            forces: parameters.iter().map(forces).collect(),
        }
    }

    /// Follows the motion to time `to` (s), or until the observer is satisfied, with its derivatives by the state in `from` and by the
    /// parameters.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    pub fn propagate(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut impl Observer<4>,
    ) -> Result<Transition, SolverError> {
        let mut course = Course {
            system: self.system,
            flight: &self.flight,
            kicks: &self.kicks,
            parameters: &self.parameters,
            forces: &self.forces,
            t: from.t,
            y: from.y,
            by_state: std::array::from_fn(|j| std::array::from_fn(|i| f64::from(u8::from(i == j)))),
            by: vec![[0.0; 4]; self.parameters.len()],
        };
        let end = self.follower.propagate(from, to, &mut (&mut course, observer))?;
        course.fly(end.t);
        let Course { by_state, by, .. } = course;
        Ok(Transition { end, by_state, by })
    }
}

/// The derivatives at a moment of a run.
struct Course<'a> {
    system: &'a Coupled,
    flight: &'a Flight,
    kicks: &'a [Kicks; 2],
    parameters: &'a [Parameter],
    forces: &'a [bool],
    t: f64,
    y: [f64; 4],
    by_state: [[f64; 4]; 4],
    by: Vec<[f64; 4]>,
}

impl Course<'_> {
    /// The derivative of the force by the parameter of this number at `t` (s).
    fn force_by(&self, number: usize, t: f64) -> Excitation {
        if self.forces[number] {
            self.system.bare().excitation_by(self.parameters[number], t)
        } else {
            [0.0; 2]
        }
    }

    /// Goes on to `t` (s) in flight.
    fn fly(&mut self, t: f64) {
        let (seconds, from) = (t - self.t, self.t);
        if seconds <= 0.0 {
            return;
        }
        let (mut by_state, mut by) = (self.by_state, std::mem::take(&mut self.by));
        let force = |elapsed: f64| self.system.excitation(from + elapsed);
        let force_by = |number: usize, elapsed: f64| self.force_by(number, from + elapsed);
        self.flight.fly(seconds, self.y, force, &mut by_state, &mut by, force_by);
        (self.t, self.by_state, self.by) = (t, by_state, by);
    }

    /// Goes on through a stretch of a contact that is followed.
    fn follow(&mut self, nodes: &Nodes) {
        self.fly(nodes.span[0]);
        let from = self.t;
        let (mut by_state, mut by) = (self.by_state, std::mem::take(&mut self.by));
        let force_by = |number: usize, elapsed: f64| self.force_by(number, from + elapsed);
        carry(self.system, self.flight, nodes, self.parameters, force_by, &mut by_state, &mut by);
        (self.t, self.y, self.by_state, self.by) = (nodes.span[1], nodes.end, by_state, by);
    }

    /// Goes on through a contact that was computed at once.
    fn cross(&mut self, contact: LinearContact) {
        let (t, side) = (contact.touch.t, contact.side);
        self.fly(t);
        let (end, lift_off) = (contact.end, t + contact.duration);
        let crossing = Crossing::new(self.system, self.flight, &self.kicks[side as usize], contact);
        let by_state = self.by_state.map(|y| {
            crossing.carry(&Change {
                at: Moment { y, force: [0.0; 2] },
                parameter: None,
                wall: 0.0,
                loss: false,
            })
        });
        let by = self.by.iter().enumerate().map(|(number, &y)| {
            let at = Moment { y, force: self.force_by(number, t) };
            let wall = self.system.wall_by(self.parameters[number], side);
            let loss = self.parameters[number] == Parameter::Lambda;
            crossing.carry(&Change { at, parameter: Some(number), wall, loss })
        });
        let by = by.collect();
        (self.t, self.y, self.by_state, self.by) = (lift_off, end, by_state, by);
    }
}

impl Observer<4> for Course<'_> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        if !segment.in_flight() {
            self.follow(&nodes(segment));
        }
    }
    fn path(&mut self, path: &impl Path<4>) {
        self.cross(path.linearised(self.parameters.contains(&Parameter::Lambda)));
    }
    fn steps(&mut self, _steps: &Steps<'_, 4>) {}
}
