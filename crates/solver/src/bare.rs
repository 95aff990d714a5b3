//! The bare structure: one degree of freedom, exact steps, nothing to meet.

use crate::flow::{Expansion, Flow};
use crate::observe::{Knot, Observer, Segment};
use crate::settings::{SolverError, Work};
use crate::system::LinearSystem;
use retune_model::Bare;
use std::cell::OnceCell;

struct Step<'a> {
    flow: &'a Flow<2>,
    ends: [Knot<2>; 2],
    length: f64,
    expansion: OnceCell<Expansion<2>>,
}

impl Segment<2> for Step<'_> {
    fn ends(&self) -> [&Knot<2>; 2] {
        [&self.ends[0], &self.ends[1]]
    }
    fn length(&self) -> f64 {
        self.length
    }
    fn at(&self, theta: f64) -> Knot<2> {
        let from = &self.ends[0];
        let expansion = self.expansion.get_or_init(|| self.flow.expand(from.drive, &from.y));
        Knot {
            t: from.t + theta,
            drive: self.flow.drive_after(from.drive, theta),
            y: expansion.at(theta),
            clock: [1.0, 0.0],
        }
    }
    fn at_time(&self, t: f64) -> Knot<2> {
        Knot { t, ..self.at(t - self.ends[0].t) }
    }
}

/// Follows the bare structure from `y` at time `from` (s) to time `to` (s), or until the observer is satisfied; returns the
/// last state.
///
/// # Errors
/// [`SolverError::TooManySteps`], [`SolverError::NonFinite`].
pub fn propagate(
    system: &Bare,
    (from, y): (f64, [f64; 2]),
    to: f64,
    max_steps: u64,
    work: &mut Work,
    observer: &mut impl Observer<2>,
) -> Result<[f64; 2], SolverError> {
    let flow = Flow::new(system.linear(), to);
    let mut now = Knot { t: from, drive: system.drive(from), y, clock: [1.0, 0.0] };
    let mut count = 0.0;
    while now.t < to && !observer.satisfied() {
        work.steps += 1;
        if work.steps > max_steps {
            return Err(SolverError::TooManySteps { t: now.t, limit: max_steps });
        }
        let (drive, y) = flow.advance(now.drive, &now.y);
        count += 1.0;
        let mut step = Step {
            flow: &flow,
            ends: [now, Knot { t: from + count * flow.step(), drive, y, clock: [1.0, 0.0] }],
            length: flow.step(),
            expansion: OnceCell::new(),
        };
        if to - now.t < step.length {
            step.length = to - now.t;
            step.ends[1] = Knot { t: to, ..step.at(step.length) };
        }
        now = step.ends[1];
        if !now.y.iter().all(|v| v.is_finite()) {
            return Err(SolverError::NonFinite { t: step.ends[0].t });
        }
        observer.segment(&step);
    }
    Ok(now.y)
}
