//! The hybrid propagator: exact linear flight between contacts, regularised contacts, both ends located to rounding.
//!
//! Flight steps are exact whatever their length, so the only error made is that of the contact phase (see `contact`), and a
//! flight step must only be short enough to *see* a contact: a certified bound on the gap over the step decides at once in
//! nearly all cases, an exact polynomial search (`gap`) in the rest.

mod pressing;

use crate::budget::Budget;
use crate::collision::Collisions;
use crate::contact;
use crate::flow::{BLOCKS, Expansion, Flow, LANES};
use crate::gap::{CUBIC, ceiling, cubic, first_contact, floor, opening_floor};
use crate::observe::{Knot, Observer, Segment};
use crate::polynomial::Polynomial;
use crate::quantity::derivative_bounds;
use crate::settings::{Method, SolverError, Work};
use crate::steps::{Step, StepClock, Steps, shifted};
use crate::system::LinearSystem;
use retune_model::{Compression, Coupled, Side};
use wide::f64x4;

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
    system: &'a Coupled,
    flow: Flow<4>,
    contacts: [Compression; 2],
    collisions: [Collisions; 2],
    /// `|d⁴r/dt⁴| <= fourth[0] e + fourth[1]` at energy norm `e` (√J), m/s⁴; see [`derivative_bounds`].
    fourth: [f64; 2],
    rtol: f64,
    max_steps: u64,
    budget: Budget,
    /// Work done so far.
    pub work: Work,
}

enum FlightEnd {
    TouchDown(Side, Knot<4>),
    Stopped(Knot<4>),
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
            flow,
            contacts: Side::BOTH.map(|side| system.compression(side)),
            fourth: derivative_bounds::<_, 4, 5>(system, STROKE)[4],
            rtol,
            max_steps,
            budget: Budget::new(Method::Hybrid, max_steps, 0, [0.0; 2]),
            work: Work::default(),
        }
    }

    /// Follows the motion to time `to` (s) or until the observer is satisfied.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    #[inline(always)]
    pub fn propagate(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut impl Observer<4>,
    ) -> Result<Motion, SolverError> {
        self.flow.check_step(from.t, to)?;
        self.budget = Budget::new(Method::Hybrid, self.max_steps, self.work.steps, [from.t, to]);
        let mut phase = from.phase;
        let mut now = self.knot(from.t, from.y);
        let stopped = |now: Knot<4>, phase| Ok(Motion { t: now.t, y: now.y, phase });
        loop {
            if let Phase::Pressed(side) = phase {
                let equations = self.contacts[side as usize];
                let pressed = equations.compress(&now.y);
                match self.contact(equations, &now, pressed, to, observer)? {
                    contact::End::Pressed(end) => return stopped(end, phase),
                    contact::End::LiftOff(end) => now = self.knot(end.t, end.y),
                }
                phase = Phase::Leaving(side);
            }
            match self.flight(now, phase, to, observer)? {
                FlightEnd::Stopped(end) => return stopped(end, Phase::Flight),
                FlightEnd::TouchDown(side, touch) => {
                    // A damper that rests on a wall from the start has not struck it.
                    let closing = side.sign() * (touch.y[3] - touch.y[1]);
                    if touch.t > from.t || closing > 0.0 {
                        observer.touch_down(touch.t, side);
                    }
                    if let Some((end, evaluations)) =
                        self.collisions[side as usize].collide(&self.flow, touch, to, observer)
                    {
                        self.work.steps += 1;
                        self.work.evaluations += evaluations;
                        now = end;
                        phase = Phase::Leaving(side);
                        if observer.satisfied() {
                            return stopped(now, phase);
                        }
                        continue;
                    }
                    let equations = self.contacts[side as usize];
                    let (begin, pressed) = self.press_in(equations, touch, to, observer)?;
                    if begin.t >= to {
                        return stopped(begin, Phase::Pressed(side));
                    }
                    match self.contact(equations, &begin, pressed, to, observer)? {
                        contact::End::Pressed(end) => return stopped(end, Phase::Pressed(side)),
                        contact::End::LiftOff(end) => now = self.knot(end.t, end.y),
                    }
                    phase = Phase::Leaving(side);
                }
            }
            if observer.satisfied() || now.t >= to {
                return stopped(now, phase);
            }
        }
    }

    fn knot(&self, t: f64, y: [f64; 4]) -> Knot<4> {
        Knot { t, drive: self.system.drive(t), y, clock: [1.0, 0.0] }
    }

    /// Flies until a touch-down, until `to`, or until the observer is satisfied.
    #[inline(always)]
    fn flight(
        &mut self,
        from: Knot<4>,
        phase: Phase,
        to: f64,
        observer: &mut impl Observer<4>,
    ) -> Result<FlightEnd, SolverError> {
        let whole = self.flow.step();
        let mut clock = StepClock::new(from.t, whole);
        let mut now = from;
        let mut leaving = if let Phase::Leaving(side) = phase { Some(side) } else { None };
        loop {
            let remaining = to - now.t;
            if remaining <= 0.0 {
                return Ok(FlightEnd::Stopped(now));
            }
            let energy = self.system.energy_norm(&now.y);
            if !energy.is_finite() {
                return Err(SolverError::NonFinite { t: now.t });
            }
            let growth = LANES as f64 * whole * self.system.energy_norm_growth();
            let mut steps = Steps::new(&self.flow, now, clock, energy + growth);
            let (open, near) = self.open_steps(&steps, leaving);
            let seen = open.min((remaining / whole) as usize);
            let careful = seen < LANES;
            steps.keep(seen);
            self.work.steps += seen as u64 + u64::from(careful);
            self.budget.check(self.work.steps, now.t)?;
            if seen > 0 {
                observer.steps(&steps);
                now = steps.knot(seen);
                clock.count(seen);
                leaving = None;
                if observer.satisfied() {
                    return Ok(FlightEnd::Stopped(now));
                }
            }
            if careful {
                let remaining = to - now.t;
                if remaining <= 0.0 {
                    return Ok(FlightEnd::Stopped(now));
                }
                let walls = Side::BOTH.into_iter().filter(|&side| seen == open && near[side as usize]);
                let (step, touched) = self.careful_step(
                    [now, steps.knot(seen + 1)],
                    walls,
                    leaving,
                    (remaining, steps.energy()),
                );
                if step.length() > 0.0 {
                    observer.segment(&step);
                }
                now = *step.ends()[1];
                if let Some(side) = touched {
                    return Ok(FlightEnd::TouchDown(side, now));
                }
                if observer.satisfied() || now.t >= to {
                    return Ok(FlightEnd::Stopped(now));
                }
                clock.count(1);
                leaving = None;
            }
        }
    }

    /// How many of some steps are certified to touch no wall, and which walls the next one may touch.
    #[inline(always)]
    fn open_steps(&self, steps: &Steps<'_, 4>, leaving: Option<Side>) -> (usize, [bool; 2]) {
        let (from, to, whole) = (steps.from(), steps.ends(), self.flow.step());
        let margin = CUBIC * whole.powi(4) * (self.fourth[0] * steps.energy() + self.fourth[1]);
        let [x1, v1, x2, v2] = to.y;
        let ends = [x2 - x1, v2 - v1];
        let starts = [shifted(from.y[2] - from.y[0], ends[0]), shifted(from.y[3] - from.y[1], ends[1])];
        let bounds = cubic(whole, starts, ends);
        let wall = f64x4::splat(self.system.wall(Side::Obstacle));
        let mut gaps = [floor(bounds), wall - ceiling(bounds)];
        if let Some(side) = leaving {
            let sign = f64x4::splat(-side.sign());
            let gap = |stroke: f64x4| sign * (stroke - self.system.wall(side));
            let opening =
                opening_floor(cubic(whole, [f64x4::ZERO, sign * starts[1]], [gap(ends[0]), sign * ends[1]]));
            gaps[side as usize].as_mut_array()[0] = opening.to_array()[0];
        }
        let open = gaps.map(|gap| gap.simd_gt(f64x4::splat(margin)).to_bitmask());
        let count = (open[0] & open[1]).trailing_ones();
        (count as usize, open.map(|lanes| lanes >> count & 1 == 0))
    }

    /// A step that may touch one of `walls` or pass the end of the run, `remaining` seconds ahead: as far as it
    /// goes. `energy` bounds the energy norm of the motion, √J.
    fn careful_step(
        &self,
        [now, end]: [Knot<4>; 2],
        walls: impl Iterator<Item = Side>,
        leaving: Option<Side>,
        (remaining, energy): (f64, f64),
    ) -> (Step<'_, 4>, Option<Side>) {
        let whole = self.flow.step();
        let motion = self.flow.expand(now.drive, &now.y);
        let (mut length, mut touched) = (whole.min(remaining), None);
        for side in walls {
            if let Some(s) = first_contact(self.gap_polynomial(&motion, side, leaving), length) {
                (length, touched) = (s, Some(side));
            }
        }
        if length == whole {
            return (Step::whole(&self.flow, [now, end], energy), touched);
        }
        let mut step = Step::part(&self.flow, now, &motion, length, energy);
        match touched {
            Some(side) => step.end().y[2] = step.end().y[0] + self.system.wall(side),
            None => step.end().t = now.t + remaining,
        }
        (step, touched)
    }

    /// The gap to a wall over the next step as a polynomial. A damper on the wall, by definition or to rounding, has none.
    fn gap_polynomial(&self, motion: &Expansion<4>, side: Side, leaving: Option<Side>) -> Polynomial<BLOCKS> {
        let gap = press(motion, -side.sign());
        let now = gap.coefficient(0) + side.sign() * self.system.wall(side);
        gap.with_constant(if leaving == Some(side) { 0.0 } else { now.max(0.0) })
    }
}

/// `sign r` over the next step.
fn press(motion: &Expansion<4>, sign: f64) -> Polynomial<BLOCKS> {
    let [x1, _, x2, _] = motion.0;
    Polynomial(std::array::from_fn(|b| (x2.0[b] - x1.0[b]) * sign))
}
