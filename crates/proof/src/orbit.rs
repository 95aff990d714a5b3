//! A guess of a periodic motion, as a cycle of events, and its improvement by Newton's iteration.

use crate::crossing::Section;
use crate::elementary::pi;
use crate::number::{FREE, Rows, applied, inverse};
use crate::segment::{Node, Passage, Plan, aimed, follow, plan, rest_of_contact};
use crate::{Equations, Event, Failure, Interval, Taylor};
use retune_model::Side;
use std::f64::consts::TAU;

/// Most events of a motion.
const EVENTS: usize = 400;
/// Most Newton iterations.
const ITERATIONS: usize = 12;
/// Newton iterations for the polynomials of a family, of 8 terms.
const WIDENED: usize = 3;
/// Largest Newton change of a guess that counts as rounding.
const CLOSED: f64 = 1e-13;

/// A motion nearer than this to its first phase, rad, has returned.
const BACK: f64 = 1e-2;

/// A state `[x1, v1, x2, v2]` at a crest of the force, and the number of periods after which it may repeat.
pub type Guess = ([f64; 4], usize);

/// A motion that may repeat after `periods` periods of the force.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// Periods of the force.
    pub periods: usize,
    /// Its events in order; the first follows the last.
    pub nodes: Vec<Node>,
    /// The plan from each event to the next.
    pub plans: Vec<Plan>,
    /// Whole turns of the force that are subtracted from the phase at the end of each segment: phases stay small, and so do their
    /// roundings.
    turns: Vec<usize>,
}

/// The equations of a periodic motion over a box: the unknowns are the free coordinates of all nodes.
#[derive(Clone, Debug)]
pub struct Residual {
    /// The enclosures of the segments.
    pub passages: Vec<Passage>,
    /// The gaps between the ends of the motions from the centres and the next nodes.
    pub gaps: Vec<Taylor>,
}

/// A motion that repeats to rounding, or a family of such.
#[derive(Clone, Debug)]
pub struct Closed {
    /// The motion.
    pub orbit: Orbit,
    /// The residual of its equations at the nodes themselves.
    pub known: Residual,
    /// An approximate inverse of their derivatives there.
    pub inverse: Rows,
}

/// `2πn`.
fn turn(turns: usize) -> Interval {
    Interval::point(2.0 * turns as f64) * pi()
}

impl Orbit {
    /// The cycle of events of the motion from a state at a crest of the force. It begins at the crest if the damper is in flight there and
    /// either `at_crest` is set or no wall is struck; otherwise at the next event.
    ///
    /// # Errors
    /// The motion grazes, or does not return.
    pub fn guess(equations: &Equations, (start, periods): Guess, at_crest: bool) -> Result<Self, Failure> {
        let [x1, v1, x2, v2] = start;
        let (r, w) = (x2 - x1, v2 - v1);
        let crest = Node { event: Event::Crest, state: [r, w, x1, v1, 0.0, 0.0].map(Taylor::point) };
        let depth = |side: Side| side.sign() * (r - equations.walls[side as usize].mid());
        let first = match Side::BOTH.into_iter().find(|side| depth(*side) >= 0.0) {
            // The rest of a contact that began before.
            Some(side) => {
                let state = [depth(side).sqrt(), side.sign() * w, x1, v1, 0.0, 0.0];
                rest_of_contact(equations, side, state)?
            }
            None if at_crest => crest,
            None => match plan(equations, &crest, Some(turn(periods)))? {
                Plan { end: Section { event: Event::Crest, .. }, .. } => crest,
                Plan { end, reached, .. } => Node { event: end.event, state: reached },
            },
        };
        let mut orbit = Self { periods, nodes: vec![first], plans: Vec::new(), turns: Vec::new() };
        loop {
            let k = orbit.plans.len();
            let next = plan(equations, &orbit.nodes[k], orbit.crest(k))?;
            let mut reached = Node { event: next.end.event, state: next.reached };
            orbit.plans.push(next);
            let left = periods - orbit.turns.iter().sum::<usize>();
            let past = reached.state[4].mid() - first.state[4].mid() - turn(left).mid();
            if reached.event == first.event && past > -BACK {
                orbit.turns.push(left);
                return Ok(orbit);
            }
            if past > BACK || orbit.nodes.len() == EVENTS {
                return Err(Failure::Guess(periods, past.abs()));
            }
            let turns = ((reached.state[4].mid() / TAU).floor().max(0.0) as usize).min(left);
            reached.state[4] = (reached.state[4] - Taylor::from(turn(turns))).polynomial();
            orbit.turns.push(turns);
            orbit.nodes.push(reached);
        }
    }

    /// The unknowns.
    pub fn unknowns(&self) -> impl Iterator<Item = Taylor> {
        self.nodes.iter().flat_map(|node| node.event.free().map(|i| node.state[i]))
    }

    /// The phase of the crest where the motion ends, as counted in segment `k`, if it begins at one.
    fn crest(&self, k: usize) -> Option<Interval> {
        let taken: usize = self.turns.iter().take(k).sum();
        (self.nodes[0].event == Event::Crest).then(|| turn(self.periods - taken))
    }

    /// Its equations at all unknowns that are `away` from those of its nodes.
    ///
    /// # Errors
    /// A segment cannot be proven.
    pub fn residual(&self, equations: &Equations, away: &[Interval]) -> Result<Residual, Failure> {
        let (mut passages, mut gaps) = (Vec::new(), Vec::new());
        for (k, (node, away)) in self.nodes.iter().zip(away.chunks(FREE)).enumerate() {
            let passage = follow(equations, node, away, &self.plans[k])?;
            let next = &self.nodes[(k + 1) % self.nodes.len()];
            for i in next.event.free() {
                let shift = if i == 4 { turn(self.turns[k]) } else { Interval::ZERO };
                gaps.push(passage.centre[i] - next.state[i] - Taylor::from(shift));
            }
            passages.push(passage);
        }
        Ok(Residual { passages, gaps })
    }

    /// The derivatives of the equations by the unknowns: in each row of blocks that of the segment, and minus the identity at the next
    /// node.
    pub fn jacobian(&self, passages: &[Passage]) -> Rows {
        let n = FREE * self.nodes.len();
        let mut all = vec![vec![Taylor::ZERO; n]; n];
        for (k, passage) in passages.iter().enumerate() {
            for (i, row) in passage.by.iter().enumerate() {
                let (whole, next) = (&mut all[FREE * k + i], FREE * ((k + 1) % self.nodes.len()) + i);
                whole[FREE * k..][..FREE].copy_from_slice(row);
                whole[next] = whole[next] - Taylor::point(1.0);
            }
        }
        all
    }

    /// Adds the residual of the equations at the nodes themselves, and the inverse of their derivatives there.
    fn closed(self, equations: &Equations) -> Result<Closed, Failure> {
        let known = self.residual(equations, &vec![Interval::ZERO; FREE * self.nodes.len()])?;
        let inverse = inverse(&self.jacobian(&known.passages));
        let refused = Failure::Guess(self.periods, largest(&known.gaps));
        Ok(Closed { orbit: self, known, inverse: inverse.ok_or(refused)? })
    }

    /// With other unknowns.
    fn with_unknowns(&self, unknowns: impl IntoIterator<Item = Taylor>) -> Self {
        let (mut next, mut unknowns) = (self.clone(), unknowns.into_iter());
        for node in &mut next.nodes {
            for (i, x) in node.event.free().into_iter().zip(&mut unknowns) {
                node.state[i] = x.polynomial();
            }
        }
        next
    }

    /// With a change subtracted from the unknowns.
    fn minus(&self, change: &[Taylor]) -> Self {
        self.with_unknowns(self.unknowns().zip(change).map(|(x, change)| x - *change))
    }

    /// Plans the segments anew, after the unknowns have changed by `change`.
    ///
    /// # Errors
    /// See [`plan`]; or the sequence of events changes.
    fn replanned(self, equations: &Equations, change: f64) -> Result<Self, Failure> {
        let plans = self.nodes.iter().enumerate().map(|(k, node)| plan(equations, node, self.crest(k)));
        let plans = plans.collect::<Result<Vec<_>, _>>()?;
        let same = plans.iter().zip(&self.plans).all(|(new, old)| new.end.event == old.end.event);
        if same { Ok(Self { plans, ..self }) } else { Err(Failure::Sequence(change)) }
    }

    /// The motion of a family at a value of its parameter, to rounding.
    ///
    /// # Errors
    /// Its sequence of events is another one there.
    pub fn member(&self, equations: &Equations, s: f64) -> Result<Self, Failure> {
        let change = self.unknowns().map(|x| x.near(s) - x.mid()).fold(0.0, |most, x| x.abs().max(most));
        self.with_unknowns(self.unknowns().map(|x| Taylor::point(x.near(s)))).replanned(equations, change)
    }

    /// The family of motions through this one for the frequencies of the equations, by Newton's iteration on polynomials, each of which
    /// doubles the order.
    ///
    /// # Errors
    /// A segment cannot be followed.
    pub fn widened(self, equations: &Equations) -> Result<Closed, Failure> {
        let closed = |mut orbit: Self| {
            let aim = |(node, plan): (&Node, &Plan)| aimed(equations, node, plan);
            orbit.plans = orbit.nodes.iter().zip(&orbit.plans).map(aim).collect();
            orbit.closed(equations)
        };
        (0..WIDENED)
            .try_fold(closed(self)?, |at, _| closed(at.orbit.minus(&applied(&at.inverse, &at.known.gaps))))
    }

    /// Improves the motion by Newton's iteration on the middles of all intervals.
    ///
    /// # Errors
    /// The iteration does not converge to a periodic motion.
    pub fn improved(self, equations: &Equations) -> Result<Closed, Failure> {
        let (mut current, mut last) = (self.closed(equations)?, f64::INFINITY);
        for _ in 0..ITERATIONS {
            let change = applied(&current.inverse, &current.known.gaps);
            let size = largest(&change);
            if size <= CLOSED || (size < 1e-9 && size >= 0.5 * last) {
                return Ok(current);
            }
            if size.is_nan() || size >= 2.0 * last {
                break;
            }
            last = size;
            current = current.orbit.minus(&change).replanned(equations, size)?.closed(equations)?;
        }
        Err(Failure::Guess(current.orbit.periods, largest(&current.known.gaps)))
    }
}

/// The largest absolute value at the middles; NaN if one is NaN.
fn largest(all: &[Taylor]) -> f64 {
    all.iter().map(|x| x.mid().abs()).fold(0.0, |most, x| if x.is_nan() { x } else { x.max(most) })
}
