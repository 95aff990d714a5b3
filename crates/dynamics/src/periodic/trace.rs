//! A branch of periodic motions along a parameter, by pseudo-arclength continuation.
//!
//! From a motion, a step along the branch's direction, then Newton's iteration in the plane across it. A step is taken again, half as
//! long, where the iteration needs many rounds, ends far from the prediction or on a motion of a shorter period, the direction turns by more
//! than [`TURN`], or what happens on the way cannot be located, because the motions there are not one branch: so it neither jumps to another
//! branch nor cuts a fold short.

use super::events::{Event, EventKind, located};
use super::forced::{Damped, Forced};
use super::node::{Node, tests};
use super::orbit::Orbit;
use super::settle::least_periods;
use super::shooting::{Shooting, Solution};
use nalgebra::DVector;

/// The step at the start, the longest and the shortest, in units of the motion's size and of the parameter's span.
const FIRST: f64 = 2e-3;
const LONGEST: f64 = 0.02;
const SHORTEST: f64 = 1e-8;
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

/// Two events of a closed branch as near as this share of the range are one.
const AGAIN: f64 = 1e-8;

/// Why a branch was followed no farther.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The parameter left its range.
    Range,
    /// It is closed: it came back to where it began.
    Closed,
    /// It has joined the branch of half its period, at a period doubling.
    Halved,
    /// After the most steps, or the most unstable motions in a row.
    Steps,
    /// No solution was found a shortest step ahead.
    Lost,
    /// Whoever watches ended the search.
    Ended,
}

impl End {
    /// In words, after "the branch".
    pub const fn words(self) -> &'static str {
        match self {
            Self::Range => "ends where the range ends",
            Self::Closed => "is closed",
            Self::Halved => "ends at a period doubling",
            Self::Steps => {
                "was followed no farther after the most steps, or the most unstable motions in a row"
            }
            Self::Lost => "was lost: no motion was found a shortest step ahead",
            Self::Ended => "was followed no farther, for the search was ended",
        }
    }
}

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

    /// The same with motions before its first.
    pub(super) fn after(mut self, first: Vec<Orbit>) -> Self {
        for event in &mut self.events {
            event.place += first.len();
        }
        self.points.splice(..0, first);
        self
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
    goes_on: &dyn Fn() -> bool,
) -> Option<Branch<S>> {
    let start = Node::new(shooting, seed.clone(), &shooting.by_value())?;
    let (after, end) = side(shooting, &start, [from, to], goes_on);
    if end == End::Closed {
        return Some(joined(shooting, Vec::new(), &start, after, [End::Closed; 2]));
    }
    let back = Node { direction: -&start.direction, ..start.clone() };
    let back = Node { tests: tests(&back.orbit, &back.direction), ..back };
    let (before, begin) = side(shooting, &back, [from, to], goes_on);
    Some(joined(shooting, before, &start, after, [begin, end]))
}

/// The branch from a solution to one side alone.
pub(super) fn trace_from<S: Forced>(
    shooting: &Shooting<S>,
    start: &Node,
    range: [f64; 2],
    goes_on: &dyn Fn() -> bool,
) -> Branch<S> {
    let (after, end) = side(shooting, start, range, goes_on);
    joined(shooting, Vec::new(), start, after, [End::Halved, end])
}

/// A motion, or an event, found on the way.
type Found = (Orbit, Option<Event>);

/// The motions to one side of a start.
fn side(
    shooting: &Shooting<impl Forced>,
    start: &Node,
    [from, to]: [f64; 2],
    goes_on: &dyn Fn() -> bool,
) -> (Vec<Found>, End) {
    let mut found: Vec<Found> = Vec::new();
    let (mut now, mut step) = (start.clone(), FIRST);
    let (mut apart, mut unstable) = (0.0, 0);
    for _ in 0..MOST {
        if !goes_on() {
            return (found, End::Ended);
        }
        let (next, events) = loop {
            let guess = &now.solution.x + &now.direction * step;
            let corrected = shooting.correct(&guess, &now.direction);
            let next = corrected.and_then(|solution| {
                let astray = shooting.norm(&(&solution.x - &guess)) > ASTRAY * step;
                if astray || least_periods(shooting, &solution.x) < shooting.periods {
                    return None;
                }
                let next = Node::new(shooting, solution, &now.direction)
                    .filter(|node| shooting.inner(&node.direction, &now.direction) > TURN)?;
                located(shooting, &now, &next).map(|events| (next, events))
            });
            match next {
                Some(next) => break next,
                None if step < 2.0 * SHORTEST => {
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
        let turned = events.len();
        found.extend(events.into_iter().map(|event| (event.orbit.clone(), Some(event))));
        let value = next.orbit.value;
        if value < from || value > to {
            let end = at_end(shooting, &now, &next, if value < from { from } else { to });
            // Events beyond the range do not count.
            found.retain(|(orbit, _)| orbit.value >= from && orbit.value <= to);
            found.extend(end.map(|orbit| (orbit, None)));
            return (found, End::Range);
        }
        if joins_half(shooting, &now, &next) {
            // It turns back there, along itself.
            for (_, event) in found.iter_mut().rev().take(turned) {
                event.take_if(|event| event.kind == EventKind::Fold);
            }
            return (found, End::Halved);
        }
        // Back at the start: nearer than a step, after it was farther away, and in the same direction. Before the branch has turned all the way
        // round, it is away by more than its last step. A thin isola is not much longer than a step.
        let (shift, _) = shooting.nearest(&start.solution.x, &next.solution.x);
        let moved = |x: &DVector<f64>| shooting.moved_on(x, shift);
        let away = shooting.norm(&(moved(&next.solution.x) - &start.solution.x));
        let came = shooting.norm(&(&next.solution.x - &now.solution.x));
        let alike = shooting.inner(&moved(&next.direction), &start.direction) > TURN;
        if apart > came && away < came && alike {
            // What lies beyond the start has been found before.
            let known = |event: &Event| {
                let same = |(_, other): &&Found| {
                    other.as_ref().is_some_and(|other| {
                        other.kind == event.kind
                            && (other.orbit.value - event.orbit.value).abs() < AGAIN * shooting.span
                    })
                };
                found.iter().filter(same).count() > 1
            };
            if found.last().is_some_and(|(_, event)| event.as_ref().is_some_and(known)) {
                found.pop();
            }
            let mut last = start.orbit.clone();
            last.states.rotate_right(shift);
            found.push((last, None));
            return (found, End::Closed);
        }
        found.push((next.orbit.clone(), None));
        unstable = if next.orbit.is_stable() { 0 } else { unstable + shooting.periods };
        if unstable > UNSTABLE {
            return (found, End::Steps);
        }
        apart = f64::max(apart, away);
        now = next;
    }
    (found, End::Steps)
}

/// The motion at the end of the range.
fn at_end(shooting: &Shooting<impl Forced>, now: &Node, next: &Node, value: f64) -> Option<Orbit> {
    let [a, b] = [now.orbit.value, next.orbit.value];
    let share = (value - a) / (b - a);
    let mut guess = &now.solution.x + (&next.solution.x - &now.solution.x) * share;
    let last = guess.len() - 1;
    guess[last] = value / shooting.span;
    let mut orbit = Orbit::of(shooting, &shooting.correct_at_value(&guess)?).ok()?;
    orbit.value = value;
    Some(orbit)
}

/// The difference of the halves of a motion of an even number of periods.
fn halves(shooting: &Shooting<impl Forced>, x: &DVector<f64>) -> Option<DVector<f64>> {
    let half = 2 * shooting.segments;
    let even = shooting.periods.is_multiple_of(2) && shooting.segments.is_multiple_of(2);
    even.then(|| x.rows(0, half) - x.rows(half, half))
}

/// Whether a branch has passed a motion of half its periods: the difference of its halves changes sign there.
fn joins_half(shooting: &Shooting<impl Forced>, now: &Node, next: &Node) -> bool {
    let [now, next] = [now, next].map(|node| halves(shooting, &node.solution.x));
    now.zip(next).is_some_and(|(now, next)| now.dot(&next) < 0.0)
}

/// Both sides as one branch.
fn joined<S: Forced>(
    shooting: &Shooting<S>,
    before: Vec<Found>,
    start: &Node,
    after: Vec<Found>,
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
