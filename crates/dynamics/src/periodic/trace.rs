//! A branch of periodic motions along a parameter, by pseudo-arclength continuation.
//!
//! Each step predicts along the branch's direction and corrects by Newton's iteration in the plane across it. A step is repeated at half
//! its length where the iteration needs many rounds, ends far from the prediction or on a motion of a shorter period, where the direction
//! turns by more than [`TURN`], or where an event cannot be located because the motions there are not one branch. So the continuation
//! neither jumps to another branch nor cuts a fold short. At a period doubling it starts the branch of twice the period.

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
/// Most steps to one side, and most periods of consecutive unstable motions: long ones in chaos continue without end.
const MOST: usize = 3000;
const UNSTABLE: usize = 600;
/// Least cosine of the angle by which the direction may turn in a step.
const TURN: f64 = 0.95;
/// Least cosine after which steps may grow.
const STRAIGHT: f64 = 0.995;
/// How far from the prediction a solution may be, as a share of the step.
const ASTRAY: f64 = 0.3;
/// A motion whose halves differ by less than this share of its size is at a period doubling, where two branches meet and Newton's iteration
/// finds either.
const JOINED: f64 = 1e-4;
/// Halves nearer than this share of a step count as equal: the step has ended on the branch of half the periods.
const MET: f64 = 0.1;

/// A branch: its motions in order, with the events between them.
#[derive(Clone, Debug)]
pub struct Branch<S = Damped> {
    /// The equations of its motions.
    pub shooting: Shooting<S>,
    /// Its motions. Those at events are among them.
    pub points: Vec<Orbit>,
    /// Its events, in order.
    pub events: Vec<Event>,
    /// How it ends on either side.
    pub ends: [End; 2],
}

impl<S> Branch<S> {
    /// Whether the motions between point `i` and the next are stable. At a bifurcation a multiplier is on the unit circle and its side is
    /// due to rounding, so only the other point decides.
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

/// Traces the branch through a solution to both sides, as long as `proceed` is true.
pub fn trace<S: Forced>(
    shooting: &Shooting<S>,
    seed: &Solution,
    [from, to]: [f64; 2],
    proceed: &dyn Fn() -> bool,
) -> Option<Branch<S>> {
    trace_while(shooting, seed, [from, to], &|_| proceed())
}

/// [`trace`] as long as `proceed` is true for the current motion.
pub(super) fn trace_while<S: Forced>(
    shooting: &Shooting<S>,
    seed: &Solution,
    [from, to]: [f64; 2],
    proceed: &dyn Fn(&Orbit) -> bool,
) -> Option<Branch<S>> {
    let start = Node::new(shooting, seed.clone(), &shooting.by_value())?;
    let (after, end) = side(shooting, &start, [from, to], proceed);
    if end == End::Closed {
        return Some(assembled(shooting, Vec::new(), &start, after, [End::Closed; 2]));
    }
    let back = start.clone().reversed();
    let (before, begin) = side(shooting, &back, [from, to], proceed);
    Some(assembled(shooting, before, &start, after, [begin, end]))
}

/// The branch that begins at a period doubling; none if the event is not one, or if no motion is found.
pub fn doubled<S: Forced>(
    shooting: &Shooting<S>,
    event: &Event,
    range: [f64; 2],
    proceed: &dyn Fn() -> bool,
) -> Option<Branch<S>> {
    if event.kind != EventKind::PeriodDoubling {
        return None;
    }
    // The perturbation that returns with the opposite sign: `(M + 1) v = 0`.
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
    // A closed branch does not begin at the period doubling: the step has missed it.
    (branch.points.len() > 1 && branch.ends[1] != End::Closed).then_some(branch)
}

/// Traces the branch from a solution to one side.
fn trace_from<S: Forced>(
    shooting: &Shooting<S>,
    start: &Node,
    range: [f64; 2],
    proceed: &dyn Fn() -> bool,
) -> Branch<S> {
    let (after, end) = side(shooting, start, range, &|_| proceed());
    assembled(shooting, Vec::new(), start, after, [End::Halved, end])
}

/// A motion found on the way, with its event if it is at one.
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
                    // A parameter at the bound of its allowed values permits no step beyond the end of the range.
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

/// The share of a range within which a motion is next to its end.
const NEXT_TO: f64 = 1e-6;

/// The motion at the end of the range towards which the branch goes; none if `now` is not next to it.
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

/// The next motion, or the end of the branch if it comes first; none if the end cannot be located.
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
    // The difference of the halves changes sign where the branch passes a motion of half the periods and turns back along itself.
    let gap = halves(shooting, &now.solution.x);
    if let Some([gap, next_gap]) = gap.zip(halves(shooting, &next.solution.x)).map(<[_; 2]>::from)
        && gap.dot(&next_gap) < 0.0
    {
        let share = gap.dot(&gap) / (gap.dot(&gap) - gap.dot(&next_gap));
        return Some((doubling_between(shooting, [now, &next], &gap, share)?, Some(End::Halved)));
    }
    // Closed: the start lies between this motion and the next, the direction is the same, and the branch was farther away before. Before
    // the branch has come round it is farther from the start than its last step. A thin isola is not much longer than a step.
    let (shift, away) = away(shooting, start, &next);
    let came = shooting.norm(&(&next.solution.x - &now.solution.x));
    let [x, direction] = [&next.solution.x, &next.direction].map(|x| shooting.shifted(x, shift));
    let alike = shooting.inner(&direction, &start.direction) > TURN;
    let passed = shooting.inner(&(x - &start.solution.x), &start.direction) >= 0.0;
    if apart > came && away < came && alike && passed {
        return Some((start.clone().shifted_back(shooting, shift)?, Some(End::Closed)));
    }
    Some((next, None))
}

/// The shift in segments that brings a motion nearest to the start of its branch, and the distance then.
fn away(shooting: &Shooting<impl Forced>, start: &Node, node: &Node) -> (usize, f64) {
    let (shift, _) = shooting.nearest(&start.solution.x, &node.solution.x);
    (shift, shooting.norm(&(shooting.shifted(&node.solution.x, shift) - &start.solution.x)))
}

/// The period doubling at a share of the way between two motions, where the difference of the halves, `gap` at the first, is 0. The
/// parameter varies with the square of that difference.
fn doubling_between(
    shooting: &Shooting<impl Forced>,
    [now, next]: [&Node; 2],
    gap: &DVector<f64>,
    share: f64,
) -> Option<Node> {
    let last = 4 * shooting.segments;
    let away = halves(shooting, &now.direction)?.dot(gap) / gap.dot(gap);
    let x = &now.solution.x + (&next.solution.x - &now.solution.x) * share;
    let mut middle = 0.5 * (x.rows(0, last / 2) + x.rows(last / 2, last / 2));
    middle = middle.push(now.solution.x[last] - 0.5 * now.direction[last] / away);
    let half = shooting.of_periods(shooting.periods / 2).in_segments(shooting.segments / 2);
    let solution = half.correct_at_value(&middle)?;
    let (states, value) = (half.states(&solution.x), half.value(&solution.x));
    Node::doubled(shooting, &states, value, now.direction.clone())
}

/// The motion at a value of the parameter between those of two motions.
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
    node.orbit.recompute_seen(shooting)?;
    Some(node)
}

/// The difference between the halves of a motion of an even number of periods.
fn halves(shooting: &Shooting<impl Forced>, x: &DVector<f64>) -> Option<DVector<f64>> {
    let half = 2 * shooting.segments;
    let even = shooting.periods.is_multiple_of(2) && shooting.segments.is_multiple_of(2);
    even.then(|| x.rows(0, half) - x.rows(half, half))
}

/// Assembles both sides into one branch.
fn assembled<S: Forced>(
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
