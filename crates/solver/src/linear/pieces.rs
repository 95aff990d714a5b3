//! The pieces of an equidistant record as steps of the flow.

use super::steps::StepClock;
use crate::motion::lanes::LANES;
use retune_model::EvenForce;

/// The samples of a record, if a flow may take its steps from one to the next: no step of its own is shorter.
pub fn in_steps(force: Option<EvenForce>, step: f64) -> Option<EvenForce> {
    force.filter(|force| force.even[1] == step)
}

/// From sample `i` on the next four pieces that end by the time `to`, as steps from a moment.
#[inline(always)]
pub fn forces(force: &EvenForce, i: usize, to: f64) -> Option<[f64; LANES + 1]> {
    force.forces(i).filter(|_| force.time(i + LANES) <= to)
}

/// The clock of a record at sample `i`.
pub fn clock(force: &EvenForce, i: usize) -> StepClock {
    let [first, step] = force.even;
    let mut clock = StepClock::new(first, step);
    clock.count(i);
    clock
}
