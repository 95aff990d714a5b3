//! From a period doubling to the branch of twice the period.

use super::events::{End, Event, EventKind};
use super::forced::Forced;
use super::node::Node;
use super::shooting::Shooting;
use super::trace::{Branch, trace_from};
use nalgebra::{DVector, Matrix4, Vector4};

/// The branch that begins at a period doubling of another; none if it is not one, or no motion is found on it.
pub fn doubled<S: Forced>(
    shooting: &Shooting<S>,
    event: &Event,
    range: [f64; 2],
    proceed: &dyn Fn() -> bool,
) -> Option<Branch<S>> {
    if event.kind != EventKind::PeriodDoubling {
        return None;
    }
    // The change that comes back with the opposite sign: `(M + 1) v = 0`.
    let svd = (event.at.monodromy() + Matrix4::identity()).svd(false, true);
    let least = svd.singular_values.imin();
    let mut change: Vector4<f64> = svd.v_t?.row(least).transpose();
    let twice = shooting.of_periods(2 * shooting.periods);
    let m = shooting.segments;
    let mut direction = DVector::zeros(8 * m + 1);
    for (k, transition) in event.at.transitions.iter().enumerate() {
        for i in 0..4 {
            direction[4 * k + i] = change[i];
            direction[4 * (m + k) + i] = -change[i];
        }
        change = transition * change;
    }
    direction /= twice.norm(&direction);
    let start = Node::doubled(&twice, &event.orbit.states, event.orbit.value, direction)?;
    let branch = trace_from(&twice, &start, range, proceed);
    // One that is closed does not begin at the period doubling: the step has missed.
    (branch.points.len() > 1 && branch.ends[1] != End::Closed).then_some(branch)
}
