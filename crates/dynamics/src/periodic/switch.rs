//! From a period doubling to the branch of twice the period.

use super::events::{Event, EventKind};
use super::forced::Forced;
use super::node::Node;
use super::shooting::Shooting;
use super::trace::{Branch, End, trace_from};
use nalgebra::{DVector, Matrix4, Vector4};

/// The first steps onto the new branch that are tried, in units of the motion's size.
const STEPS: [f64; 4] = [4e-3, 1e-3, 2.5e-4, 1.6e-2];

/// The branch that begins at a period doubling of another; none if it is not one, or no motion is found on it.
pub fn doubled<S: Forced>(
    shooting: &Shooting<S>,
    event: &Event,
    range: [f64; 2],
    goes_on: &dyn Fn() -> bool,
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
    let states = [&event.orbit.states[..], &event.orbit.states[..]].concat();
    let start = twice.unknowns(&states, event.orbit.value);
    STEPS.iter().find_map(|step| {
        let solution = twice.correct(&(&start + &direction * *step), &direction)?;
        let apart = (0..4 * m).map(|i| (solution.x[i] - solution.x[4 * m + i]).abs()).fold(0.0, f64::max);
        if apart < 0.1 * step {
            return None; // back on the branch of half the period
        }
        let node = Node::new(&twice, solution, &direction)?;
        let branch = trace_from(&twice, &node, range, goes_on);
        // One that is closed does not begin at the period doubling: the step has missed.
        (branch.ends[1] != End::Closed).then_some(branch)
    })
}
