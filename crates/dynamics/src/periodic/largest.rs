//! The largest value of a quantity over the stable motions of a branch, located between its points.

use super::orbit::Orbit;
use super::trace::Branch;

/// Local maxima as near as this share to the largest are located exactly.
const CLOSE: f64 = 0.02;
/// Evaluations to locate a maximum.
const EVALUATIONS: usize = 40;

/// The motion with the largest value of a quantity among the stable ones of a branch, located between the points of the branch.
pub fn largest(branch: &Branch, quantity: impl Fn(&Orbit) -> f64 + Copy) -> Option<Orbit> {
    let stable = |i: usize| branch.points.get(i).filter(|_| branch.is_stable_at(i));
    let value = |i: usize| stable(i).map_or(f64::NEG_INFINITY, &quantity);
    let all = 0..branch.points.len();
    let most = all.clone().map(value).fold(f64::NEG_INFINITY, f64::max);
    let near = |&i: &usize| value(i) >= (1.0 - CLOSE) * most && stable(i).is_some();
    // Of a level stretch, as a force of zero is, the first point.
    let peaks = all.filter(near).filter(|&i| (i == 0 || value(i - 1) < value(i)) && value(i + 1) <= value(i));
    let located = peaks.filter_map(|i| {
        let own = stable(i)?.clone();
        let inner = i > 0 && branch.is_stable_after(i - 1) && branch.is_stable_after(i);
        let better = if inner { located(branch, i, quantity) } else { None };
        Some(better.filter(|better| quantity(better) > quantity(&own)).unwrap_or(own))
    });
    located.max_by(|a, b| quantity(a).total_cmp(&quantity(b)))
}

/// The largest value between the neighbours of a point, by golden sections.
fn located(branch: &Branch, i: usize, quantity: impl Fn(&Orbit) -> f64) -> Option<Orbit> {
    let shooting = &branch.shooting;
    let x = |i: usize| shooting.unknowns(&branch.points[i].states, branch.points[i].value);
    let (from, way) = (x(i - 1), x(i + 1) - x(i - 1));
    let at = |share: f64| Orbit::of(shooting, &shooting.correct(&(&from + &way * share), &way)?).ok();
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (0.0, 1.0);
    let (mut a, mut b) = (at(1.0 - golden)?, at(golden)?);
    for _ in 0..EVALUATIONS {
        if quantity(&a) > quantity(&b) {
            high = low + golden * (high - low);
            b = a;
            a = at(high - golden * (high - low))?;
        } else {
            low = high - golden * (high - low);
            a = b;
            b = at(low + golden * (high - low))?;
        }
    }
    Some(if quantity(&a) > quantity(&b) { a } else { b })
}
