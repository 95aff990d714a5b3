//! The largest value of a quantity over the stable motions of a branch, located between its points; and, for searches, which need it at
//! many designs, the part of a branch about that value alone.

use super::attractors::Reached;
use super::orbit::Orbit;
use super::shooting::{Shooting, Solution};
use super::trace::{Branch, trace_while};
use retune_model::Measure;
use std::cell::Cell;

/// Motions below this share of the largest known value are ignored.
pub(super) const COUNTS: f64 = 0.8;
/// A crest ends where the quantity is below this share of its largest value.
const DOWN: f64 = 0.995;
/// Local maxima as near as this share to the largest are located exactly.
const CLOSE: f64 = 0.02;
/// Most evaluations to locate a maximum.
const EVALUATIONS: usize = 40;
/// A smaller relative gain is none.
const NOTHING: f64 = 1e-14;

/// The motion with the largest value of a quantity among the stable ones of a branch, located between the points of the branch.
pub fn largest(branch: &Branch, quantity: impl Fn(&Orbit) -> f64 + Copy) -> Option<Orbit> {
    let stable = |i: usize| branch.points.get(i).filter(|_| branch.is_stable_at(i));
    let value = |i: usize| stable(i).map_or(f64::NEG_INFINITY, &quantity);
    let all = 0..branch.points.len();
    let most = all.clone().map(value).fold(f64::NEG_INFINITY, f64::max);
    let near = |&i: &usize| value(i) >= (1.0 - CLOSE) * most && stable(i).is_some();
    // The first point of a level stretch, such as a force of zero.
    let peaks = all.filter(near).filter(|&i| (i == 0 || value(i - 1) < value(i)) && value(i + 1) <= value(i));
    let located = peaks.filter_map(|i| {
        let own = stable(i)?.clone();
        let inner = i > 0 && branch.is_stable_after(i - 1) && branch.is_stable_after(i);
        let better = if inner { located(branch, i, quantity) } else { None };
        Some(better.unwrap_or(own))
    });
    located.max_by(|a, b| quantity(a).total_cmp(&quantity(b)))
}

/// The largest value between the neighbours of a point: by parabolas through the three highest points, or golden sections where these do
/// not narrow the bracket, until a parabola predicts no gain.
fn located(branch: &Branch, i: usize, quantity: impl Fn(&Orbit) -> f64) -> Option<Orbit> {
    let shooting = &branch.shooting;
    let x = |i: usize| shooting.unknowns(&branch.points[i].states, branch.points[i].value);
    let (from, middle, to) = (x(i - 1), x(i), x(i + 1));
    let way = &to - &from;
    let orbit = |share: f64| Orbit::of(shooting, &shooting.correct(&(&from + &way * share), &way)?).ok();
    let share = shooting.inner(&(&middle - &from), &way) / shooting.inner(&way, &way);
    let [low, most, high] = [i - 1, i, i + 1].map(|i| quantity(&branch.points[i]));
    let (mut best, mut three) = (None, [(0.0, low), (share, most), (1.0, high)]);
    for _ in 0..EVALUATIONS {
        let (next, gain) = higher(&three);
        if gain <= NOTHING * three[1].1.abs() || !(three[0].0..three[2].0).contains(&next) {
            break;
        }
        let found = orbit(next)?;
        let value = quantity(&found);
        let is_right = next > three[1].0;
        if value > three[1].1 {
            three = if is_right {
                [three[1], (next, value), three[2]]
            } else {
                [three[0], (next, value), three[1]]
            };
            best = Some(found);
        } else {
            three[if is_right { 2 } else { 0 }] = (next, value);
        }
    }
    best
}

/// The next point to try for three values, the middle one the largest, and the predicted gain: the vertex of their parabola, or, once one
/// side is below a thousandth of both, the golden section of the other.
fn higher([(a, low), (b, most), (c, high)]: &[(f64, f64); 3]) -> (f64, f64) {
    let [left, right] = [(most - low) / (b - a), (high - most) / (c - b)];
    let curvature = (right - left) / (c - a);
    let slope = left + curvature * (b - a);
    let vertex = b - 0.5 * slope / curvature;
    let gain = -0.25 * slope * slope / curvature;
    let (side, width) = if c - b > b - a { (1.0, c - b) } else { (-1.0, b - a) };
    let narrow = (b - a).min(c - b) < 1e-3 * (c - a);
    if curvature < 0.0 && !narrow {
        (vertex, gain)
    } else {
        (b + side * 0.382 * width, most - low.min(*high))
    }
}

/// The steps of a branch over which its motions are stable.
pub(super) fn stable_parts(branch: &Branch) -> impl Iterator<Item = [f64; 2]> {
    let pairs = branch.points.windows(2).enumerate().filter(|(i, _)| branch.is_stable_after(*i));
    pairs.map(|(_, pair)| [pair[0].value.min(pair[1].value), pair[0].value.max(pair[1].value)])
}

/// The union of intervals, as intervals apart from each other.
pub(super) fn merged(mut parts: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for part in parts {
        match all.last_mut() {
            Some(last) if part[0] <= last[1] => last[1] = last[1].max(part[1]),
            _ => all.push(part),
        }
    }
    all
}

/// The parts of the range over which a branch has stable motions.
pub(super) fn stable_ranges(branch: &Branch) -> Vec<[f64; 2]> {
    merged(stable_parts(branch).collect())
}

/// The part of the branch through a motion that leads to the largest value of a quantity among stable motions, and a little beyond.
pub(super) fn crest(
    shooting: &Shooting,
    seed: &Solution,
    range: [f64; 2],
    measure: Measure,
) -> Option<Branch> {
    let most = Cell::new(0.0);
    let proceed = |orbit: &Orbit| {
        let value = orbit.seen.largest(measure);
        most.set(f64::max(most.get(), value));
        orbit.is_stable() && value >= DOWN * most.get()
    };
    trace_while(shooting, seed, range, &proceed)
}

/// Keeps the local maxima of consecutive samples; returns the largest value of all.
pub(super) fn keep_crests(seen: &mut Vec<Reached>, measure: Measure) -> f64 {
    let reached: Vec<f64> = seen.iter().map(|seen| seen.most(measure)).collect();
    let at = |i: usize| reached.get(i).copied().unwrap_or(0.0);
    let mut places = 0..;
    seen.retain(|_| places.next().is_some_and(|i| at(i) >= at(i.wrapping_sub(1)) && at(i) >= at(i + 1)));
    reached.iter().copied().fold(0.0, f64::max)
}
