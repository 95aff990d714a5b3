//! Flight between contacts: whole steps where both gaps are certified open, an exact search for the touch-down in any other.

use super::propagator::{Hybrid, Phase, ReducedFlight, relative_position};
use crate::error::SolverError;
use crate::linear::flow::Expansion;
use crate::linear::gap::{CUBIC, PrecisionLost, ceiling, cubic, first_contact, floor, opening_floor};
use crate::linear::steps::{Step, StepClock, Steps};
use crate::motion::knot::Knot;
use crate::motion::lanes::{LANES, shifted};
use crate::motion::polynomial::{BLOCKS, Polynomial};
use crate::motion::segment::Segment;
use crate::observe::observer::Observer;
use retune_model::Side;
use wide::f64x4;

/// How a flight ended.
pub enum FlightEnd {
    /// The damper has touched a wall.
    TouchDown(Side, Knot<4>),
    /// The run ended, or the observer was satisfied.
    Stopped(Knot<4>),
}

impl Hybrid<'_> {
    /// Flies until a touch-down, until `to`, or until the observer is satisfied.
    #[inline(always)]
    pub(super) fn flight(
        &mut self,
        from: Knot<4>,
        phase: Phase,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
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
            if self.reduced.is_some()
                && let Some(settled) = self.without_fast_part(&now, leaving)
            {
                return self.reduced_flight(settled, to, observer);
            }
            let growth = LANES as f64 * whole * self.system.energy_norm_growth();
            let mut steps = Steps::new(&self.flow, now, clock, energy + growth);
            let (open, near) = self.open_steps(&steps, leaving);
            let whole_steps = open.min((remaining / whole) as usize);
            let needs_search = whole_steps < LANES;
            steps.keep(whole_steps);
            self.work.steps += whole_steps as u64 + u64::from(needs_search);
            self.budget.check(&self.work.with_search_work(observer.search_work()), now.t)?;
            if whole_steps > 0 {
                observer.steps(&steps);
                now = steps.knot(whole_steps);
                clock.count(whole_steps);
                leaving = None;
                if observer.satisfied() {
                    return Ok(FlightEnd::Stopped(now));
                }
            }
            if needs_search {
                let remaining = to - now.t;
                if remaining <= 0.0 {
                    return Ok(FlightEnd::Stopped(now));
                }
                let walls = Side::BOTH.into_iter().filter(|&side| whole_steps == open && near[side as usize]);
                let motion = self.flow.expand(now.excitation, &now.y);
                let longest = whole.min(remaining);
                let (length, touched) = self.first_touch(&now, &motion, walls, leaving, longest)?;
                let energy = steps.energy();
                let mut step = if length == whole {
                    Step::between(&self.flow, [now, steps.knot(whole_steps + 1)], whole, energy)
                } else {
                    Step::part(&self.flow, now, &motion, length, energy)
                };
                match touched {
                    Some(side) => step.end().y[2] = step.end().y[0] + self.system.wall(side),
                    None if length < whole => step.end().t = now.t + remaining,
                    None => {}
                }
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

    /// The moment without the fast part of the motion, if that has decayed.
    #[cold]
    fn without_fast_part(&self, now: &Knot<4>, leaving: Option<Side>) -> Option<Knot<4>> {
        let reduced = self.reduced.as_deref().filter(|_| leaving.is_none())?;
        reduced.flow.without_transient(now).map(|y| Knot { y, ..*now })
    }

    /// Continues the flight in longer steps from a moment at which the fast part of the motion has decayed.
    #[cold]
    #[inline(never)]
    fn reduced_flight(
        &mut self,
        now: Knot<4>,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<FlightEnd, SolverError> {
        let Some(reduced) = self.reduced.take() else { return Ok(FlightEnd::Stopped(now)) };
        let end = self.reduced_steps(&reduced, now, to, observer);
        self.reduced = Some(reduced);
        end
    }

    fn reduced_steps(
        &mut self,
        reduced: &ReducedFlight,
        mut now: Knot<4>,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<FlightEnd, SolverError> {
        let (flow, whole) = (&reduced.flow.flow, reduced.flow.flow.step());
        let growth = LANES as f64 * whole * self.system.energy_norm_growth();
        let mut clock = StepClock::new(now.t, whole);
        observer.discontinuity();
        loop {
            let energy = self.system.energy_norm(&now.y) + growth;
            if !energy.is_finite() {
                return Err(SolverError::NonFinite { t: now.t });
            }
            let steps = Steps::new(flow, now, clock, energy);
            let (open, near) = self.open(&steps, reduced.fourth, None);
            for number in 0..LANES {
                let remaining = to - now.t;
                if remaining <= 0.0 || observer.satisfied() {
                    return Ok(FlightEnd::Stopped(now));
                }
                self.work.steps += 1;
                self.budget.check(&self.work.with_search_work(observer.search_work()), now.t)?;
                let mut step = steps.step(number);
                let mut touched = None;
                if number >= open || remaining < whole {
                    let walls = Side::BOTH.into_iter().filter(|&side| number >= open && near[side as usize]);
                    let motion = flow.expand(now.excitation, &now.y);
                    let (length, side) =
                        self.first_touch(&now, &motion, walls, None, whole.min(remaining))?;
                    touched = side;
                    if length < whole {
                        step = Step::part(flow, now, &motion, length, energy);
                        match touched {
                            Some(side) => step.end().y[2] = step.end().y[0] + self.system.wall(side),
                            None => step.end().t = now.t + remaining,
                        }
                    }
                }
                if step.length() > 0.0 {
                    observer.segment(&step);
                }
                now = *step.ends()[1];
                if let Some(side) = touched {
                    return Ok(FlightEnd::TouchDown(side, now));
                }
                if now.t >= to {
                    return Ok(FlightEnd::Stopped(now));
                }
                clock.count(1);
                if number >= open {
                    break;
                }
            }
        }
    }

    /// The number of steps that are certified to touch no wall, and the walls that the next one may touch.
    #[inline(always)]
    pub(super) fn open_steps(&self, steps: &Steps<'_, 4>, leaving: Option<Side>) -> (usize, [bool; 2]) {
        self.open(steps, self.fourth, leaving)
    }

    /// [`Self::open_steps`] with these bounds on the fourth derivative of the relative displacement, see [`Hybrid::fourth`].
    #[inline(always)]
    fn open(&self, steps: &Steps<'_, 4>, fourth: [f64; 2], leaving: Option<Side>) -> (usize, [bool; 2]) {
        let (from, to, lengths) = (steps.from(), steps.ends(), steps.lengths());
        let square = lengths * lengths;
        let margin = square * square * CUBIC * (fourth[0] * steps.energy() + fourth[1]);
        let [x1, v1, x2, v2] = to.y;
        let ends = [x2 - x1, v2 - v1];
        let starts = [shifted(from.y[2] - from.y[0], ends[0]), shifted(from.y[3] - from.y[1], ends[1])];
        let bounds = cubic(lengths, starts, ends);
        let wall = f64x4::splat(self.system.wall(Side::Obstacle));
        let mut gaps = [floor(bounds), wall - ceiling(bounds)];
        if let Some(side) = leaving {
            let sign = f64x4::splat(-side.sign());
            let gap = |stroke: f64x4| sign * (stroke - self.system.wall(side));
            let opening = opening_floor(cubic(
                lengths,
                [f64x4::ZERO, sign * starts[1]],
                [gap(ends[0]), sign * ends[1]],
            ));
            gaps[side as usize].as_mut_array()[0] = opening.to_array()[0];
        }
        let open = gaps.map(|gap| gap.simd_gt(margin).to_bitmask());
        let count = (open[0] & open[1]).trailing_ones();
        (count as usize, open.map(|lanes| lanes >> count & 1 == 0))
    }

    /// The length (s) of a step of at most `longest` seconds from `now` up to the first touch of one of `walls`, and that wall.
    fn first_touch(
        &self,
        now: &Knot<4>,
        motion: &Expansion<4>,
        walls: impl Iterator<Item = Side>,
        leaving: Option<Side>,
        longest: f64,
    ) -> Result<(f64, Option<Side>), SolverError> {
        let mut first = (longest, None);
        for side in walls {
            let found = first_contact(self.gap_polynomial(motion, side, leaving), first.0);
            if let Some(s) = found.map_err(|PrecisionLost| SolverError::NonFinite { t: now.t })? {
                first = (s, Some(side));
            }
        }
        Ok(first)
    }

    /// The gap to a wall over the next step as a polynomial. For a damper on the wall, by definition or to rounding, it begins at zero.
    fn gap_polynomial(&self, motion: &Expansion<4>, side: Side, leaving: Option<Side>) -> Polynomial<BLOCKS> {
        let gap = relative_position(motion, -side.sign());
        let now = gap.coefficient(0) + side.sign() * self.system.wall(side);
        if leaving != Some(side) {
            return gap.with_constant(now.max(0.0));
        }
        let mut gap = gap.with_constant(0.0);
        // A rigid wall releases the damper where the force between them is zero: the gap opens from rest, at first without acceleration.
        if gap.coefficient(1) == 0.0 && self.system.is_rigid() {
            let terms = gap.0[0].as_mut_array();
            terms[2] = terms[2].max(0.0);
        }
        gap
    }
}
