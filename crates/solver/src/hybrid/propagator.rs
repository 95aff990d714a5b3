//! The state of the hybrid propagator: prepared once a system, then continued from motion to motion.

use crate::budget::Budget;
use crate::contact::collocation::response::Collisions;
use crate::linear::flow::{Expansion, Flow};
use crate::motion::form::derivative_bounds;
use crate::motion::knot::Knot;
use crate::motion::polynomial::{BLOCKS, Polynomial};
use crate::response::Work;
use crate::system::LinearSystem;
use retune_model::{Compression, Coupled, Side};

/// What the damper is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Between the walls.
    Flight,
    /// Between the walls, having just left one, where the gap is zero by definition rather than by arithmetic.
    Leaving(Side),
    /// Pressed into a wall.
    Pressed(Side),
}

impl Phase {
    /// What the damper does in a state that was not reached by moving there: pressed into a wall where it overlaps one.
    pub fn of(system: &Coupled, y: &[f64; 4]) -> Self {
        let overlaps = system.rapprochement(y);
        let pressed = Side::BOTH.into_iter().find(|&side| overlaps[side as usize] > 0.0);
        pressed.map_or(Self::Flight, Self::Pressed)
    }
}

/// A moment from which the motion can be continued.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Time, s.
    pub t: f64,
    /// `[x1, v1, x2, v2]`.
    pub y: [f64; 4],
    /// What the damper is doing.
    pub phase: Phase,
}

/// The propagator of one coupled system. Preparing it costs about as much as a hundred flight steps; it allocates nothing.
pub struct Hybrid<'a> {
    pub(super) system: &'a Coupled,
    pub(super) flow: Flow<4>,
    pub(super) contacts: [Compression; 2],
    pub(super) collisions: [Collisions; 2],
    /// `|d⁴r/dt⁴| <= fourth[0] e + fourth[1]` at energy norm `e` (√J), m/s⁴; see [`derivative_bounds`].
    pub(super) fourth: [f64; 2],
    pub(super) rtol: f64,
    pub(super) max_steps: u64,
    pub(super) budget: Budget,
    /// Work done so far.
    pub work: Work,
}

/// The row that picks `r = x2 - x1` from a state.
const STROKE: [f64; 4] = [-1.0, 0.0, 1.0, 0.0];

impl<'a> Hybrid<'a> {
    /// Prepares the propagator. `rtol` is the relative error allowed in a step of a contact, `longest` (s) the longest
    /// flight step, `max_steps` the most steps a run may take.
    pub fn new(system: &'a Coupled, rtol: f64, longest: f64, max_steps: u64) -> Self {
        let linear = system.linear();
        let flow = Flow::new(linear, longest);
        Self {
            system,
            collisions: Side::BOTH.map(|side| Collisions::new(system, side, &flow, rtol)),
            budget: Budget::new(flow.pace(), max_steps, 0, [0.0; 2]),
            flow,
            contacts: Side::BOTH.map(|side| system.compression(side)),
            fourth: derivative_bounds::<_, 4, 5>(system, STROKE)[4],
            rtol,
            max_steps,
            work: Work::default(),
        }
    }

    /// The moment of flight with this state.
    pub(super) fn knot(&self, t: f64, y: [f64; 4]) -> Knot<4> {
        Knot { t, drive: self.system.drive(t), y, clock: [1.0, 0.0] }
    }
}

/// `sign r` over the next step.
pub fn relative_position(motion: &Expansion<4>, sign: f64) -> Polynomial<BLOCKS> {
    let [x1, _, x2, _] = motion.0;
    Polynomial(std::array::from_fn(|b| (x2.0[b] - x1.0[b]) * sign))
}
