//! Events along a branch: folds, crossings, period doublings, Neimark–Sacker bifurcations, grazings; each located between two motions.

use super::forced::Forced;
use super::node::{Node, between, pairs};
use super::orbit::Orbit;
use super::shooting::{Linearised, Shooting};
use nalgebra::Complex;

/// Most evaluations to locate one event.
const EVALUATIONS: usize = 80;
/// An event is located to this share of the parameter's value, and of the step in which it lies.
const PLACED: f64 = 1e-10;
/// Most grazings in one step.
const GRAZINGS: usize = 6;
/// Bound on the remaining difference, as a share of that over the step, of a quantity that is continuous. Where more is left, it jumps.
const CONTINUOUS: f64 = 1e-3;
/// A difference of motions below this is that of their solutions.
const ROUNDED: f64 = 1e-10;

/// Why the tracing of a branch ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The parameter left its range.
    Range,
    /// It is closed: it came back to where it began.
    Closed,
    /// It has joined the branch of half its period, at a period doubling.
    Halved,
    /// After the most steps, or the most consecutive unstable motions.
    Steps,
    /// No solution was found a shortest step ahead.
    Lost,
    /// The caller ended the search.
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

/// A kind of event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// The branch turns back: a multiplier is 1.
    Fold,
    /// Another branch of motions of as many periods crosses, such as one of motions without symmetry: a multiplier is 1, and the branch
    /// continues.
    BranchPoint,
    /// A branch of twice the period begins: a multiplier is -1.
    PeriodDoubling,
    /// A pair of complex multipliers is on the unit circle: amplitude-modulated motions branch off.
    NeimarkSacker,
    /// An impact begins or ends: the damper touches a wall at no speed.
    Grazing,
}

impl EventKind {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Fold, Self::BranchPoint, Self::PeriodDoubling, Self::NeimarkSacker, Self::Grazing];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::BranchPoint => "branch point",
            Self::PeriodDoubling => "period doubling",
            Self::NeimarkSacker => "Neimark-Sacker",
            Self::Grazing => "grazing",
        }
    }

    /// How many multipliers are on the unit circle.
    pub const fn multipliers(self) -> usize {
        match self {
            Self::Fold | Self::BranchPoint | Self::PeriodDoubling => 1,
            Self::NeimarkSacker => 2,
            Self::Grazing => 0,
        }
    }
}

/// An event.
#[derive(Clone, Debug)]
pub struct Event {
    /// Its kind.
    pub kind: EventKind,
    /// The motion there.
    pub orbit: Orbit,
    /// The equations there.
    pub at: Linearised,
    /// The index of that motion among the branch's points.
    pub place: usize,
}

/// The events between two motions, in order; none if the motions between them are not one branch, or if multipliers cross the unit circle
/// without an event. At a nearly hard wall many branches come close together at a grazing, and turn back within a part of a step.
pub(super) fn located(shooting: &Shooting<impl Forced>, now: &Node, next: &Node) -> Option<Vec<Event>> {
    let mut found: Vec<(f64, Event)> = Vec::new();
    // A grazing has no test function: the impacts change.
    for (number, kind) in EventKind::ALL.into_iter().enumerate().take(now.tests.len()) {
        let ends = [now.tests[number], next.tests[number]];
        if ends[0] * ends[1] < 0.0 {
            let (share, node) = root(shooting, [now, next], |node| node.tests[number], ends)?;
            if kind != EventKind::NeimarkSacker || is_complex(&node.orbit) {
                found.push((share, event(kind, node)));
            }
        }
    }
    if !now.crossings_match(next, found.iter().map(|(_, event)| event.kind.multipliers())) {
        return None;
    }
    let mut last = (0.0, now.clone());
    for _ in 0..GRAZINGS {
        if last.1.orbit.seen.impacts == next.orbit.seen.impacts {
            break;
        }
        last = change(shooting, [now, next], last)?;
        found.push((last.0, event(EventKind::Grazing, last.1.clone())));
    }
    if last.1.orbit.seen.impacts != next.orbit.seen.impacts {
        return None;
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(found.into_iter().map(|(_, event)| event).collect())
}

fn event(kind: EventKind, node: Node) -> Event {
    Event { kind, orbit: node.orbit, at: node.solution.at, place: 0 }
}

/// Whether the pair of multipliers whose product is nearest to 1 is complex; two real ones are no bifurcation.
fn is_complex(orbit: &Orbit) -> bool {
    let off = |[a, b]: &[Complex<f64>; 2]| (a * b - 1.0).norm();
    pairs(orbit).min_by(|a, b| off(a).total_cmp(&off(b))).is_some_and(|[a, b]| a.im != 0.0 && b == a.conj())
}

/// Where a test function changes sign, and the motion there (Illinois: regula falsi that halves the value of an end that
/// stays); none if it jumps.
fn root(
    shooting: &Shooting<impl Forced>,
    ends: [&Node; 2],
    test: impl Fn(&Node) -> f64,
    mut values: [f64; 2],
) -> Option<(f64, Node)> {
    let (mut shares, mut best, mut stayed) = ([0.0, 1.0], None, 2);
    let most = CONTINUOUS * values[0].abs().max(values[1].abs());
    for _ in 0..EVALUATIONS {
        let share = (shares[0] * values[1] - shares[1] * values[0]) / (values[1] - values[0]);
        let node = between(shooting, ends, share)?;
        let value = test(&node);
        let end = usize::from(value * values[0] < 0.0);
        if stayed == end {
            values[1 - end] *= 0.5;
        }
        stayed = end;
        let moved = (shares[end] - share).abs();
        (shares[end], values[end]) = (share, value);
        best = (value.abs() <= most).then_some((share, node));
        if value == 0.0 || moved < PLACED || shares[1] - shares[0] < PLACED {
            break;
        }
    }
    best
}

/// The first change of the impacts after `low`, and the motion beyond it; none if the motion jumps there.
fn change(shooting: &Shooting<impl Forced>, ends: [&Node; 2], mut low: (f64, Node)) -> Option<(f64, Node)> {
    let label = low.1.orbit.seen.impacts.clone();
    let mut high = (1.0, ends[1].clone());
    while high.0 - low.0 >= PLACED {
        let share = f64::midpoint(low.0, high.0);
        let node = between(shooting, ends, share)?;
        let side = if node.orbit.seen.impacts == label { &mut low } else { &mut high };
        *side = (share, node);
    }
    let distance = |a: &Node, b: &Node| shooting.norm(&(&a.solution.x - &b.solution.x));
    (distance(&low.1, &high.1) <= f64::max(CONTINUOUS * distance(ends[0], ends[1]), ROUNDED)).then_some(high)
}
