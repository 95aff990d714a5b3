//! A branch of periodic motions along a parameter, by pseudo-arclength continuation.
//!
//! From a motion, a step along the branch's direction, then Newton's iteration in the plane across it. A step is taken again, half as
//! long, where the iteration needs many rounds, ends far from the prediction or on a motion of a shorter period, the direction turns by more
//! than [`TURN`], or what happens on the way cannot be located, because the motions there are not one branch: so it neither jumps to another
//! branch nor cuts a fold short. At a period doubling it goes on to the branch of twice the period.

use super::events::{End, Event, EventKind, located};
use super::forced::{Damped, Forced};
use super::node::Node;
use super::orbit::Orbit;
use super::settle::least_periods;
use super::shooting::{Shooting, Solution};
use nalgebra::{DVector, Matrix4, Vector4};

/// The step at the start, the longest and the shortest, in units of the motion's size and of the parameter's span.
const FIRST: f64 = 2e-3;
const LONGEST: f64 = 0.02;
const SHORTEST: f64 = 1e-12;
/// Most steps to one side, and the most periods of unstable motions in a row: long ones in chaos wind on without end.
const MOST: usize = 3000;
const UNSTABLE: usize = 600;
/// Least cosine of the angle by which the direction may turn in a step.
const TURN: f64 = 0.95;
/// Least cosine after which steps may grow.
const STRAIGHT: f64 = 0.995;
/// How far from the prediction a solution may be, as a share of the step.
const ASTRAY: f64 = 0.3;
/// Halves of a motion nearer than this share of its size are at a period doubling, where two branches meet and Newton's iteration finds either.
const JOINED: f64 = 1e-4;
/// Halves nearer than this share of a step are the same: the step has ended on the branch of half the periods.
const MET: f64 = 0.1;

/// A branch: its motions in their order, with what happens between them.
#[derive(Clone, Debug)]
pub struct Branch<S = Damped> {
    /// The equations of its motions.
    pub shooting: Shooting<S>,
    /// Its motions. Those at events are among them.
    pub points: Vec<Orbit>,
    /// What happens along it, in this order.
    pub events: Vec<Event>,
    /// How it ends on either side.
    pub ends: [End; 2],
}

impl<S> Branch<S> {
    /// Whether the motions between point `i` and the next are stable. At a bifurcation itself a multiplier is on the unit circle, and
    /// rounding decides on which side: the other point counts.
    pub fn is_stable_after(&self, i: usize) -> bool {
        let last = self.points.len().saturating_sub(1);
        let at_bifurcation = |place: usize| {
            place == 0 && self.ends[0] == End::Halved
                || place == last && self.ends[1] == End::Halved
                || self.events.iter().any(|event| event.place == place && event.kind != EventKind::Grazing)
        };
        let mut decisive = [i, i + 1].into_iter().filter(|place| !at_bifurcation(*place)).peekable();
        i + 1 < self.points.len()
            && decisive.peek().is_some()
            && decisive.all(|place| self.points[place].is_stable())
    }

    /// Whether a motion is stable, or the limit of stable ones.
    pub fn is_stable_at(&self, i: usize) -> bool {
        i > 0 && self.is_stable_after(i - 1)
            || self.is_stable_after(i)
            || self.points.len() == 1 && self.points[0].is_stable()
    }
}

/// The branch through a solution, to both sides, as long as it goes on.
pub fn trace<S: Forced>(
    shooting: &Shooting<S>,
    seed: &Solution,
    [from, to]: [f64; 2],
    proceed: &dyn Fn() -> bool,
) -> Option<Branch<S>> {
    trace_while(shooting, seed, [from, to], &|_| proceed())
}

/// The same as long as `proceed` says so of the motion that it has come to.
pub(super) fn trace_while<S: Forced>(
    shooting: &Shooting<S>,
    seed: &Solution,
    [from, to]: [f64; 2],
    proceed: &dyn Fn(&Orbit) -> bool,
) -> Option<Branch<S>> {
    let start = Node::new(shooting, seed.clone(), &shooting.by_value())?;
    let (after, end) = side(shooting, &start, [from, to], proceed);
    if end == End::Closed {
        return Some(joined(shooting, Vec::new(), &start, after, [End::Closed; 2]));
    }
    let back = start.clone().turned();
    let (before, begin) = side(shooting, &back, [from, to], proceed);
    Some(joined(shooting, before, &start, after, [begin, end]))
}

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

/// The branch from a solution to one side alone.
fn trace_from<S: Forced>(
    shooting: &Shooting<S>,
    start: &Node,
    range: [f64; 2],
    proceed: &dyn Fn() -> bool,
) -> Branch<S> {
    let (after, end) = side(shooting, start, range, &|_| proceed());
    joined(shooting, Vec::new(), start, after, [End::Halved, end])
}

/// A motion, or an event, found on the way.
type Passed = (Orbit, Option<Event>);

/// The motions to one side of a start.
fn side(
    shooting: &Shooting<impl Forced>,
    start: &Node,
    range: [f64; 2],
    proceed: &dyn Fn(&Orbit) -> bool,
) -> (Vec<Passed>, End) {
    let mut found: Vec<Passed> = Vec::new();
    let (mut now, mut step) = (start.clone(), FIRST);
    let (mut apart, mut unstable) = (0.0, 0);
    for _ in 0..MOST {
        if !proceed(&now.orbit) {
            return (found, End::Ended);
        }
        let (next, events, end) = loop {
            let next = ahead(shooting, &now, step).and_then(|next| {
                let (node, end) = up_to_end(shooting, [start, &now], next, apart, range)?;
                let events = located(shooting, &now, &node)?;
                Some((node, events, end))
            });
            match next {
                Some(next) => break next,
                None if step < 2.0 * SHORTEST => {
                    // A parameter that may not be larger leads no step beyond the end of its range.
                    if let Some(node) = at_end(shooting, &now, range) {
                        found.push((node.orbit, None));
                        return (found, End::Range);
                    }
                    let gap = halves(shooting, &now.solution.x).map_or(f64::INFINITY, |gap| gap.amax());
                    return (found, if gap < JOINED { End::Halved } else { End::Lost });
                }
                None => step *= 0.5,
            }
        };
        let straight = shooting.inner(&next.direction, &now.direction) > STRAIGHT;
        if straight && next.solution.iterations <= 4 {
            step = (1.6 * step).min(LONGEST);
        }
        found.extend(events.into_iter().map(|event| (event.orbit.clone(), Some(event))));
        found.push((next.orbit.clone(), None));
        if let Some(end) = end {
            return (found, end);
        }
        unstable = if next.orbit.is_stable() { 0 } else { unstable + shooting.periods };
        if unstable > UNSTABLE {
            return (found, End::Steps);
        }
        apart = f64::max(apart, away(shooting, start, &next).1);
        now = next;
    }
    (found, End::Steps)
}

/// The motion a step ahead; none if the step is too long.
fn ahead(shooting: &Shooting<impl Forced>, now: &Node, step: f64) -> Option<Node> {
    let guess = &now.solution.x + &now.direction * step;
    let solution = shooting.correct(&guess, &now.direction)?;
    let astray = shooting.norm(&(&solution.x - &guess)) > ASTRAY * step;
    // Beside a period doubling its halves differ by little, but not by less than the step.
    let halved = halves(shooting, &solution.x).is_none_or(|gap| gap.amax() < MET * step);
    if astray || halved && least_periods(shooting, &solution.x) < shooting.periods {
        return None;
    }
    Node::new(shooting, solution, &now.direction)
        .filter(|node| shooting.inner(&node.direction, &now.direction) > TURN)
}

/// The share of a range in which a motion is next to its end.
const NEXT_TO: f64 = 1e-6;

/// The motion at the end of a range that is next to one, which the branch goes to; none if it is not.
fn at_end(shooting: &Shooting<impl Forced>, now: &Node, [from, to]: [f64; 2]) -> Option<Node> {
    let last = now.direction.len() - 1;
    let end = if now.direction[last] > 0.0 { to } else { from };
    if now.orbit.value == end || (now.orbit.value - end).abs() > NEXT_TO * (to - from) {
        return None;
    }
    let mut guess = now.solution.x.clone();
    guess[last] = end / shooting.span;
    located_at(shooting, &guess, now, end)
}

/// The next motion, or the end of the branch where that comes first; none if it cannot be located.
fn up_to_end(
    shooting: &Shooting<impl Forced>,
    [start, now]: [&Node; 2],
    next: Node,
    apart: f64,
    [from, to]: [f64; 2],
) -> Option<(Node, Option<End>)> {
    let value = next.orbit.value;
    if value < from || value > to {
        return Some((
            at_value(shooting, [now, &next], if value < from { from } else { to })?,
            Some(End::Range),
        ));
    }
    // The difference of its halves changes sign where it passes a motion of half its periods, and turns back along itself.
    let own = halves(shooting, &now.solution.x);
    if let Some([own, other]) = own.zip(halves(shooting, &next.solution.x)).map(<[_; 2]>::from)
        && own.dot(&other) < 0.0
    {
        let share = own.dot(&own) / (own.dot(&own) - own.dot(&other));
        return Some((joint(shooting, [now, &next], &own, share)?, Some(End::Halved)));
    }
    // Back at the start: it lies between the last motion and the next, which were farther away before and go in the same direction. Before the
    // branch has turned all the way round, it is away by more than its last step. A thin isola is not much longer than a step.
    let (shift, away) = away(shooting, start, &next);
    let came = shooting.norm(&(&next.solution.x - &now.solution.x));
    let [x, direction] = [&next.solution.x, &next.direction].map(|x| shooting.moved_on(x, shift));
    let alike = shooting.inner(&direction, &start.direction) > TURN;
    let passed = shooting.inner(&(x - &start.solution.x), &start.direction) >= 0.0;
    if apart > came && away < came && alike && passed {
        return Some((start.clone().moved_back(shooting, shift)?, Some(End::Closed)));
    }
    Some((next, None))
}

/// By how many segments a motion is to be moved on to come nearest to the start of its branch, and how far it is from that then.
fn away(shooting: &Shooting<impl Forced>, start: &Node, node: &Node) -> (usize, f64) {
    let (shift, _) = shooting.nearest(&start.solution.x, &node.solution.x);
    (shift, shooting.norm(&(shooting.moved_on(&node.solution.x, shift) - &start.solution.x)))
}

/// The period doubling at a share of the way between two motions, where half the difference of the halves, `own` at the first, is 0. The parameter goes with
/// the square of that difference.
fn joint(
    shooting: &Shooting<impl Forced>,
    [now, next]: [&Node; 2],
    own: &DVector<f64>,
    share: f64,
) -> Option<Node> {
    let last = 4 * shooting.segments;
    let away = halves(shooting, &now.direction)?.dot(own) / own.dot(own);
    let x = &now.solution.x + (&next.solution.x - &now.solution.x) * share;
    let mut middle = 0.5 * (x.rows(0, last / 2) + x.rows(last / 2, last / 2));
    middle = middle.push(now.solution.x[last] - 0.5 * now.direction[last] / away);
    let half = shooting.of_periods(shooting.periods / 2).in_segments(shooting.segments / 2);
    let solution = half.correct_at_value(&middle)?;
    let (states, value) = (half.states(&solution.x), half.value(&solution.x));
    Node::doubled(shooting, &states, value, now.direction.clone())
}

/// The motion between two at a value of the parameter.
fn at_value(shooting: &Shooting<impl Forced>, [now, next]: [&Node; 2], value: f64) -> Option<Node> {
    let [a, b] = [now.orbit.value, next.orbit.value];
    let share = (value - a) / (b - a);
    let mut guess = &now.solution.x + (&next.solution.x - &now.solution.x) * share;
    let last = guess.len() - 1;
    guess[last] = value / shooting.span;
    located_at(shooting, &guess, now, value)
}

/// The motion at a value, from a guess of it.
fn located_at(
    shooting: &Shooting<impl Forced>,
    guess: &DVector<f64>,
    now: &Node,
    value: f64,
) -> Option<Node> {
    let mut node = Node::new(shooting, shooting.correct_at_value(guess)?, &now.direction)?;
    node.orbit.value = value;
    node.orbit.seen_anew(shooting)?;
    Some(node)
}

/// The difference of the halves of a motion of an even number of periods.
fn halves(shooting: &Shooting<impl Forced>, x: &DVector<f64>) -> Option<DVector<f64>> {
    let half = 2 * shooting.segments;
    let even = shooting.periods.is_multiple_of(2) && shooting.segments.is_multiple_of(2);
    even.then(|| x.rows(0, half) - x.rows(half, half))
}

/// Both sides as one branch.
fn joined<S: Forced>(
    shooting: &Shooting<S>,
    before: Vec<Passed>,
    start: &Node,
    after: Vec<Passed>,
    ends: [End; 2],
) -> Branch<S> {
    let middle = (start.orbit.clone(), None);
    let all = before.into_iter().rev().chain([middle]).chain(after);
    let (mut points, mut events) = (Vec::new(), Vec::new());
    for (orbit, event) in all {
        events.extend(event.map(|event| Event { place: points.len(), ..event }));
        points.push(orbit);
    }
    Branch { shooting: shooting.clone(), points, events, ends }
}
