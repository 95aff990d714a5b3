//! The data of the hybrid propagator: prepared once for a system, then used for any stretch of its motion.

use super::held::RigidWalls;
use crate::budget::Budget;
use crate::contact::collocation::response::Collisions;
use crate::contact::regularised::shared::Shared;
use crate::linear::flow::{Expansion, Flow};
use crate::linear::pieces::{Pieces, longest_step};
use crate::linear::reduced::Reduced;
use crate::motion::form::{derivative_bounds, derivative_bounds_of};
use crate::motion::knot::Knot;
use crate::motion::polynomial::{BLOCKS, Polynomial};
use crate::response::Work;
use crate::system::LinearSystem;
use retune_model::{Coupled, RegularisedContact, SampledForce, Side, Stretch};

/// The phase of the damper's motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Between the walls.
    Flight,
    /// Between the walls, having just left one, where the gap is zero by definition rather than by arithmetic.
    Leaving(Side),
    /// In contact with a wall; with a rigid wall, held by it.
    InContact(Side),
}

impl Phase {
    /// The phase of a state that was set rather than reached: in contact where the damper overlaps a wall, or rests on a rigid one.
    pub fn of(system: &Coupled, y: &[f64; 4]) -> Self {
        if system.is_rigid() {
            let wall = Side::BOTH.into_iter().find(|&side| system.rests_on(side, y));
            return wall.map_or(Self::Flight, Self::InContact);
        }
        let overlaps = system.indentation(y);
        let contact = Side::BOTH.into_iter().find(|&side| overlaps[side as usize] > 0.0);
        contact.map_or(Self::Flight, Self::InContact)
    }
}

/// A moment from which the motion can be continued.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Time, s.
    pub t: f64,
    /// `[x1, v1, x2, v2]`.
    pub y: [f64; 4],
    /// The phase of the damper's motion.
    pub phase: Phase,
}

impl Motion {
    /// The start of a run at t = 0.
    pub fn start(system: &Coupled) -> Self {
        let y = system.start();
        Self { t: 0.0, y, phase: Phase::of(system, &y) }
    }
}

/// The propagator of one coupled system. Preparing it costs about as much as a hundred flight steps; it allocates nothing.
pub struct Hybrid<'a> {
    pub(super) system: &'a Coupled,
    pub(super) flow: Flow<4>,
    pub(super) contacts: [RegularisedContact; 2],
    /// The flow in longer steps, where a part of the motion decays so fast that it can be left out.
    pub(super) reduced: Option<Box<ReducedFlight>>,
    pub(super) collisions: [Collisions; 2],
    pub(super) rigid: Option<Box<RigidWalls>>,
    /// `|d⁴r/dt⁴| <= fourth[0] e + fourth[1]` at energy norm `e` (√J), m/s⁴; see [`derivative_bounds`].
    pub(super) fourth: [f64; 2],
    /// The same bound on the second derivative, m/s².
    pub(super) second: [f64; 2],
    pub(super) rtol: f64,
    /// The longest step of a flight without samples, s.
    longest: f64,
    pub(super) max_steps: u64,
    /// The sampled force, if the flow can step over its pieces.
    pub(super) samples: Option<Pieces<4>>,
    /// The present stretch of time, for a force that has several.
    pub(super) stretch: Option<Stretch>,
    /// The end of the present call of [`Self::propagate`], s.
    pub(super) end: f64,
    pub(super) budget: Budget,
    /// What observers of a piece of a contact share.
    pub(super) shared: Shared,
    /// Work done so far.
    pub work: Work,
}

/// The flow without its fast part, with the same bounds as [`Hybrid::fourth`].
pub(super) struct ReducedFlight {
    pub flow: Reduced<4>,
    pub fourth: [f64; 2],
}

impl ReducedFlight {
    fn of(system: &Coupled, whole: &Flow<4>, longest: f64) -> Option<Box<Self>> {
        let flow = Reduced::of(whole, longest)?;
        let fourth = derivative_bounds_of::<_, 4, 5>(system, flow.flow.linear(), STROKE)[4];
        Some(Box::new(Self { flow, fourth }))
    }
}

/// The row that picks `r = x2 - x1` from a state.
const STROKE: [f64; 4] = [-1.0, 0.0, 1.0, 0.0];

impl<'a> Hybrid<'a> {
    /// Prepares the propagator. `rtol` is the relative error allowed in a step of a contact, `longest` (s) the longest
    /// flight step, `max_steps` the most steps a run may take.
    pub fn new(system: &'a Coupled, rtol: f64, longest: f64, max_steps: u64) -> Self {
        Self::with_samples(system.bare().sampled_force(), system, rtol, longest, max_steps)
    }

    /// [`Self::new`] with these samples of the force.
    fn with_samples(
        force: Option<SampledForce>,
        system: &'a Coupled,
        rtol: f64,
        whole: f64,
        max_steps: u64,
    ) -> Self {
        let longest = longest_step(force, whole);
        let flow = Flow::new(system.linear(), longest);
        let bounds = derivative_bounds::<_, 4, 5>(system, STROKE);
        Self {
            system,
            collisions: Side::BOTH.map(|side| Collisions::new(system, side, &flow, rtol)),
            budget: Budget::new(flow.pace(), max_steps, Work::default(), [0.0; 2]),
            reduced: ReducedFlight::of(system, &flow, longest),
            samples: Pieces::of(force, &flow),
            rigid: RigidWalls::of(system, longest),
            flow,
            contacts: Side::BOTH.map(|side| system.regularised_contact(side)),
            fourth: bounds[4],
            second: bounds[2],
            rtol,
            longest: whole,
            max_steps,
            stretch: None,
            end: f64::INFINITY,
            shared: Shared::default(),
            work: Work::default(),
        }
    }

    /// The propagator without the longer steps of a flight whose fast part has decayed.
    #[must_use]
    pub fn in_short_steps(self) -> Self {
        Self { reduced: None, ..self }
    }

    /// Continues in steps set by the motion where samples set them [no longer](retune_model::Course::paced_until).
    #[cold]
    pub(super) fn leave_samples(&mut self, t: f64) {
        if self.samples.is_some() && t >= self.system.bare().paced_until() {
            let free = Self::with_samples(None, self.system, self.rtol, self.longest, self.max_steps);
            *self =
                Self { stretch: self.stretch, end: self.end, work: self.work, budget: self.budget, ..free };
        }
    }

    /// The moment of flight with this state.
    pub(super) fn knot(&self, t: f64, y: [f64; 4]) -> Knot<4> {
        let excitation = match &self.stretch {
            Some(stretch) => self.system.bare().excitation_in(stretch, t),
            None => self.system.excitation(t),
        };
        Knot { t, excitation, y, clock: [1.0, 0.0] }
    }
}

/// `sign r` over the next step.
pub fn relative_position(motion: &Expansion<4>, sign: f64) -> Polynomial<BLOCKS> {
    let [x1, _, x2, _] = motion.0;
    Polynomial(std::array::from_fn(|b| (x2.0[b] - x1.0[b]) * sign))
}
