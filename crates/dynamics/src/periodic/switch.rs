//! From a period doubling to the branch of twice the period.

use super::events::{Event, EventKind};
use super::forced::Forced;
use super::node::Node;
use super::orbit::Orbit;
use super::shooting::{Shooting, Solution};
use super::trace::{Branch, End, trace_from};
use nalgebra::{DVector, Matrix4, Vector4};

/// The first steps onto the new branch that are tried, in units of the motion's size.
const STEPS: [f64; 4] = [4e-3, 1e-3, 2.5e-4, 1.6e-2];
/// The places on the way there, as shares of the step.
const SHARES: [f64; 3] = [0.25, 0.5, 0.75];

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
    let here = Solution { x: start.clone(), at: twice.linearised(&start).ok()?, iterations: 0 };
    let beginning = Orbit::of(&twice, &here).ok()?;
    let at = |step: f64| {
        let solution = twice.correct(&(&start + &direction * step), &direction)?;
        let apart = (0..4 * m).map(|i| (solution.x[i] - solution.x[4 * m + i]).abs()).fold(0.0, f64::max);
        // Else it is back on the branch of half the period.
        (apart >= 0.1 * step).then_some(solution)
    };
    STEPS.iter().find_map(|step| {
        let solution = at(*step)?;
        let branch = trace_from(&twice, &Node::new(&twice, solution, &direction)?, range, goes_on);
        let way = SHARES.iter().filter_map(|share| Orbit::of(&twice, &at(share * step)?).ok());
        let first = [beginning.clone()].into_iter().chain(way).collect();
        // One that is closed does not begin at the period doubling: the step has missed.
        (branch.ends[1] != End::Closed).then(|| branch.after(first))
    })
}
