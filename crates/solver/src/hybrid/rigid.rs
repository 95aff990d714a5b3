//! Rigid walls: an impact is a jump of the state, and a damper that a wall holds moves with the structure as one body.
//!
//! Flight is the same as between Hertz contacts. A rebound too slow to be told from rounding ends a chatter, if there was one: the wall
//! then holds the damper if it is pressed on it (`docs/theory.md`, "Rigid walls").

use super::flight::FlightEnd;
use super::held::{HeldStep, RigidWalls};
use super::propagator::{Hybrid, Motion, Phase};
use crate::error::SolverError;
use crate::linear::flow::Expansion;
use crate::linear::gap::{PrecisionLost, first_contact};
use crate::linear::steps::StepClock;
use crate::motion::knot::Knot;
use crate::motion::polynomial::{BLOCKS, Polynomial};
use crate::motion::segment::Segment;
use crate::observe::observer::{Impact, Observer};
use retune_model::Side;

/// Least speed of a rebound, in units in the last place of the speeds. A slower one is within the rounding errors of a flight and does not
/// count.
const REBOUND_ULPS: f64 = 64.0;

/// How a hold on a wall ended.
enum HoldEnd {
    /// The force between wall and damper has come to zero.
    Released(Knot<4>),
    /// The run ended, or the observer was satisfied.
    Stopped(Knot<4>),
}

impl Hybrid<'_> {
    /// [`Self::propagate`] between rigid walls.
    pub(super) fn propagate_rigid(
        &mut self,
        walls: &RigidWalls,
        from: Motion,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<Motion, SolverError> {
        let mut phase = from.phase;
        let mut now = self.knot(from.t, from.y);
        let stopped = |now: Knot<4>, phase| Ok(Motion { t: now.t, y: now.y, phase });
        loop {
            if let Phase::InContact(side) = phase {
                match self.hold(walls, side, now, to, observer)? {
                    HoldEnd::Stopped(end) => return stopped(end, phase),
                    HoldEnd::Released(end) => now = end,
                }
                phase = Phase::Leaving(side);
            }
            match self.flight(now, phase, to, observer)? {
                FlightEnd::Stopped(end) => return stopped(end, Phase::Flight),
                FlightEnd::TouchDown(side, touch) => {
                    (now, phase) = self.strike(walls, side, touch, from.t, observer);
                    self.work.steps += 1;
                    self.budget.check(&self.work.with_search_work(observer.search_work()), now.t)?;
                }
            }
            if observer.satisfied() || now.t >= to {
                return stopped(now, phase);
            }
        }
    }

    /// A touch-down on a wall: the moment after the impact, and the next phase.
    fn strike(
        &self,
        walls: &RigidWalls,
        side: Side,
        touch: Knot<4>,
        begun: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> (Knot<4>, Phase) {
        let [_, v1, _, v2] = touch.y;
        let closing = side.sign() * (v2 - v1);
        // A damper that rests on a wall from the start makes no touch-down.
        if touch.t > begun || closing > 0.0 {
            observer.touch_down(touch.t, side);
        }
        // The force after the impact decides whether it is held: before the impact the structure may be faster or slower.
        let at_rest = self.system.caught(side, &touch.y);
        let force =
            self.system.holding_force(side, self.system.held_acceleration(touch.excitation, &at_rest));
        let pressing = force * self.system.inverse_effective_mass();
        let rounding = REBOUND_ULPS * f64::EPSILON * (v1.abs() + v2.abs() + pressing.abs() * touch.t);
        let slow = walls.restitution * closing <= rounding;
        let caught = slow && force >= 0.0;
        let y = match caught {
            true => at_rest,
            false if closing > 0.0 => self.system.struck(walls.restitution, &touch.y),
            false => touch.y,
        };
        let after = Knot { y, ..touch };
        // The depth to which the damper would go without the wall: below the rounding of positions it is a graze.
        let depth = 0.5 * closing * closing / -pressing;
        let places = touch.y[0].abs() + touch.y[2].abs() + self.system.rest_distance();
        let grazes = !caught && force < 0.0 && depth <= REBOUND_ULPS * f64::EPSILON * places;
        observer.impact(&Impact { side, before: touch, after, caught, grazes });
        (after, if caught { Phase::InContact(side) } else { Phase::Leaving(side) })
    }

    /// Follows a damper that a wall holds until the force between them is zero, until `to`, or until the observer is satisfied.
    fn hold(
        &mut self,
        RigidWalls { held, .. }: &RigidWalls,
        side: Side,
        mut now: Knot<4>,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<HoldEnd, SolverError> {
        let (wall, [weight, constant]) = (self.system.wall(side), self.system.holding_force_weights(side));
        let mut clock = StepClock::new(now.t, held.step());
        loop {
            let remaining = to - now.t;
            if remaining <= 0.0 {
                return Ok(HoldEnd::Stopped(now));
            }
            if !now.y.iter().all(|v| v.is_finite()) {
                return Err(SolverError::NonFinite { t: now.t });
            }
            let motion: Expansion<4> = held.expand(now.excitation, &now.y);
            let inertia = self.held_inertia(&motion, weight);
            let force = inertia.with_constant(inertia.coefficient(0) + constant);
            let longest = held.step().min(remaining);
            let end =
                first_contact(force, longest).map_err(|PrecisionLost| SolverError::NonFinite { t: now.t })?;
            let last = match end {
                Some(_) => None,
                None if longest < held.step() => Some(to),
                None => Some(clock.after(1)),
            };
            let step = HeldStep::new(held, now, &motion, (end.unwrap_or(longest), last), wall);
            if step.length() > 0.0 {
                observer.segment(&step);
            }
            now = *step.ends()[1];
            self.work.steps += 1;
            self.budget.check(&self.work.with_search_work(observer.search_work()), now.t)?;
            if end.is_some() {
                return Ok(HoldEnd::Released(now));
            }
            if observer.satisfied() || now.t >= to {
                return Ok(HoldEnd::Stopped(now));
            }
            clock.count(1);
        }
    }

    /// `weight` times the acceleration of both bodies, that of the base included: on an accelerated base, the part due to the spring and
    /// the dashpot of the structure.
    fn held_inertia(&self, motion: &Expansion<4>, weight: f64) -> Polynomial<BLOCKS> {
        let [x, v, ..] = motion.0;
        if !self.system.bare().moves_with_base() {
            return Polynomial(v.derivative().0.map(|terms| terms * weight));
        }
        let (a, _) = self.system.held_linear_part();
        Polynomial(std::array::from_fn(|b| (x.0[b] * a[(1, 0)] + v.0[b] * a[(1, 1)]) * weight))
    }
}
