//! The derivatives of a run, computed while it is followed.

use super::collision::{Change, ContactMap, Kicks};
use super::contact::{Nodes, carry, nodes};
use super::flight::Flight;
use super::rigid::{ImpactMap, hold};
use super::series::Moment;
use crate::error::SolverError;
use crate::hybrid::propagator::{Motion, Phase};
use crate::linear::steps::Steps;
use crate::motion::knot::Knot;
use crate::motion::linearised::LinearContact;
use crate::motion::segment::Segment;
use crate::observe::observer::{Impact, Observer, Path, Unobserved};
use crate::run::Follower;
use crate::settings::Settings;
use retune_model::{Coupled, Excitation, Parameter, Side};

/// The state of a motion at a fixed time, and its derivatives by the first state and by parameters.
#[derive(Clone, Debug)]
pub struct Transition {
    /// The motion at its end.
    pub end: Motion,
    /// `by_state[j][i]`: the derivative of component `i` of the last state by component `j` of the first.
    pub by_state: [[f64; 4]; 4],
    /// The derivatives of the last state by each parameter, the first state held.
    pub by: Vec<[f64; 4]>,
}

/// An impact with a rigid wall, and the derivatives at its own time, which moves.
pub(super) struct ImpactTransition {
    /// Just before and just after it.
    pub sides: [Transition; 2],
    /// The derivatives of its time by each parameter, and by each component of the first state, s per unit.
    pub delays: Vec<f64>,
    pub delays_by_state: [f64; 4],
}

/// Follows motions of one system with their derivatives.
pub struct Tangent<'a> {
    follower: Follower<'a>,
    prepared: Prepared<'a>,
}

/// What the derivatives of one system need for any stretch of its motion.
struct Prepared<'a> {
    system: &'a Coupled,
    flight: Flight,
    kicks: [Kicks; 2],
    parameters: Vec<Parameter>,
    /// Whether the force depends on each of them.
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
        let prepared = Prepared {
            system,
            kicks: Side::BOTH.map(|side| Kicks::new(system, &flight, side, parameters)),
            flight,
            parameters: parameters.to_vec(),
            forces: parameters.iter().map(forces).collect(),
        };
        Self { follower: Follower::new(system, &settings.exact(), longest), prepared }
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
        observer: &mut dyn Observer<4>,
    ) -> Result<Transition, SolverError> {
        let mut derivatives = DerivativeObserver::new(&self.prepared, from);
        let end = self.follower.propagate(from, to, &mut (&mut derivatives, observer))?;
        derivatives.fly_to(end.t);
        let DerivativeObserver { by_state, by, grazed, .. } = derivatives;
        match grazed {
            Some(t) => Err(SolverError::Grazing { t }),
            None => Ok(Transition { end, by_state, by }),
        }
    }

    /// The first impact with a rigid wall at `near` (s) or later, up to time `to`: the derivatives just before and after it.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    pub(super) fn first_impact(
        &mut self,
        from: Motion,
        near: f64,
        to: f64,
    ) -> Result<Option<ImpactTransition>, SolverError> {
        let mut derivatives = DerivativeObserver::new(&self.prepared, from);
        derivatives.near = near;
        self.follower.propagate(from, to, &mut (&mut derivatives, Unobserved))?;
        Ok(derivatives.first_impact)
    }
}

/// The derivatives at a moment of a run.
struct DerivativeObserver<'a> {
    system: &'a Coupled,
    flight: &'a Flight,
    kicks: &'a [Kicks; 2],
    parameters: &'a [Parameter],
    forces: &'a [bool],
    t: f64,
    y: [f64; 4],
    by_state: [[f64; 4]; 4],
    by: Vec<[f64; 4]>,
    /// When the damper first grazed a rigid wall, s.
    grazed: Option<f64>,
    /// The time (s) from which on the first impact is kept, and the derivatives at its own time, which moves, before and after it.
    near: f64,
    first_impact: Option<ImpactTransition>,
}

impl<'a> DerivativeObserver<'a> {
    fn new(prepared: &'a Prepared<'_>, from: Motion) -> Self {
        Self {
            system: prepared.system,
            flight: &prepared.flight,
            kicks: &prepared.kicks,
            parameters: &prepared.parameters,
            forces: &prepared.forces,
            t: from.t,
            y: from.y,
            by_state: std::array::from_fn(|j| std::array::from_fn(|i| f64::from(u8::from(i == j)))),
            by: vec![[0.0; 4]; prepared.parameters.len()],
            grazed: None,
            near: f64::INFINITY,
            first_impact: None,
        }
    }

    /// The derivative of the force by the parameter of this number at `t` (s).
    fn force_by(&self, number: usize, t: f64) -> Excitation {
        if self.forces[number] {
            self.system.bare().excitation_by(self.parameters[number], t)
        } else {
            [0.0; 2]
        }
    }

    /// Advances to `t` (s) in flight.
    fn fly_to(&mut self, t: f64) {
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

    /// Advances through a stretch of a contact that is followed step by step.
    fn carry_through_steps(&mut self, nodes: &Nodes) {
        self.fly_to(nodes.span[0]);
        let from = self.t;
        let (mut by_state, mut by) = (self.by_state, std::mem::take(&mut self.by));
        let force_by = |number: usize, elapsed: f64| self.force_by(number, from + elapsed);
        carry(self.system, self.flight, nodes, self.parameters, force_by, &mut by_state, &mut by);
        (self.t, self.y, self.by_state, self.by) = (nodes.span[1], nodes.end, by_state, by);
    }

    /// The derivatives at the time of an impact, which moves; `by_state` and `by` are those after it.
    fn impact_transition(
        &self,
        impact: &Impact<4>,
        jump: &ImpactMap<'_>,
        by_state: &[[f64; 4]; 4],
        by: &[[f64; 4]],
    ) -> ImpactTransition {
        let delays = self.by_state.map(|change| jump.delay(&change, None));
        let numbered = self.by.iter().zip(self.parameters);
        let by_parameter: Vec<f64> =
            numbered.map(|(change, &parameter)| jump.delay(change, Some(parameter))).collect();
        let moved = |change: &[f64; 4], rate: &[f64; 4], delay: f64| -> [f64; 4] {
            std::array::from_fn(|i| change[i] + rate[i] * delay)
        };
        let side = |knot: &Knot<4>, rate: &[f64; 4], by_state: &[[f64; 4]; 4], by: &[[f64; 4]]| Transition {
            end: Motion { t: knot.t, y: knot.y, phase: Phase::Flight },
            by_state: std::array::from_fn(|j| moved(&by_state[j], rate, delays[j])),
            by: by.iter().zip(&by_parameter).map(|(change, &delay)| moved(change, rate, delay)).collect(),
        };
        let [before, after] = &jump.rates;
        let sides = [
            side(&impact.before, before, &self.by_state, &self.by),
            side(&impact.after, after, by_state, by),
        ];
        ImpactTransition { sides, delays: by_parameter, delays_by_state: delays }
    }

    /// Advances through a contact that was computed at once.
    fn carry_through_collision(&mut self, contact: LinearContact) {
        let (t, side) = (contact.touch.t, contact.side);
        self.fly_to(t);
        let (end, lift_off) = (contact.end, t + contact.duration);
        let map = ContactMap::new(self.system, self.flight, &self.kicks[side as usize], contact);
        let by_state = self.by_state.map(|y| {
            map.carry(&Change { at: Moment { y, force: [0.0; 2] }, parameter: None, wall: 0.0, loss: false })
        });
        let by = self.by.iter().enumerate().map(|(number, &y)| {
            let at = Moment { y, force: self.force_by(number, t) };
            let wall = self.system.wall_by(self.parameters[number], side);
            let loss = self.parameters[number] == Parameter::Lambda;
            map.carry(&Change { at, parameter: Some(number), wall, loss })
        });
        let by = by.collect();
        (self.t, self.y, self.by_state, self.by) = (lift_off, end, by_state, by);
    }
}

impl Observer<4> for DerivativeObserver<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        if segment.in_flight() {
            return;
        }
        if !self.system.is_rigid() {
            return self.carry_through_steps(&nodes(segment));
        }
        let [begin, end] = segment.ends();
        self.fly_to(begin.t);
        let (from, seconds) = ((begin.t, begin.y), segment.length());
        let (mut by_state, mut by) = (self.by_state, std::mem::take(&mut self.by));
        let force_by = |number: usize, elapsed: f64| self.force_by(number, begin.t + elapsed);
        hold(self.system, from, seconds, &mut by_state, &mut by, self.parameters, force_by);
        (self.t, self.y, self.by_state, self.by) = (end.t, end.y, by_state, by);
    }
    fn impact(&mut self, impact: &Impact<4>) {
        self.fly_to(impact.before.t);
        if impact.grazes {
            self.grazed.get_or_insert(impact.before.t);
        }
        let jump = ImpactMap::new(self.system, impact);
        let by_state = self.by_state.map(|change| jump.carry(&change, None));
        let numbered = self.by.iter().zip(self.parameters);
        let by: Vec<[f64; 4]> =
            numbered.map(|(change, &parameter)| jump.carry(change, Some(parameter))).collect();
        if impact.before.t >= self.near && self.first_impact.is_none() {
            self.first_impact = Some(self.impact_transition(impact, &jump, &by_state, &by));
        }
        (self.t, self.y, self.by_state, self.by) = (impact.after.t, impact.after.y, by_state, by);
    }
    fn satisfied(&self) -> bool {
        self.first_impact.is_some()
    }
    /// The force of a lossy contact is not a function of the depths alone, so [`Path::linearised`] does not hold for it.
    fn follows_contacts(&self) -> bool {
        true
    }
    fn path(&mut self, path: &dyn Path<4>) {
        self.carry_through_collision(path.linearised(self.parameters.contains(&Parameter::Lambda)));
    }
    fn steps(&mut self, _steps: &Steps<'_, 4>) {}
}
