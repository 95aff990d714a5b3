//! A motion that is guessed to repeat, as a ring of events, and its improvement by Newton's iteration.

use crate::elementary::pi;
use crate::equations::Equations;
use crate::event::Event;
use crate::inverse::Inverse;
use crate::number::{FREE, STATE, State};
use crate::segment::{Node, Passage, Plan, aimed, follow, plan, rest_of_contact};
use crate::taylor::Taylor;
use crate::{Failure, Interval};
use retune_model::Side;
use std::f64::consts::TAU;

/// Most events of a motion.
const EVENTS: usize = 400;
/// Most of Newton's iterations.
const ITERATIONS: usize = 12;
/// Those for the polynomials of a family, of 8 terms.
const WIDENED: usize = 3;
/// Of a guess, the largest gap that is taken for its rounding, relative to the states.
const CLOSED: f64 = 1e-13;

/// A motion that is as near as this to its first phase, rad, has come back.
const BACK: f64 = 1e-2;

/// A motion that may repeat after so many periods of the force.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// Periods of the force.
    pub periods: usize,
    /// Its events in turn; after the last one the first follows.
    pub nodes: Vec<Node>,
    /// The way from each to the next.
    pub plans: Vec<Plan>,
    /// Whole turns of the force that are taken off the phase at the end of each: phases stay small, and so do their roundings.
    turns: Vec<usize>,
}

/// The event after a crest; the crest itself if none comes before it has come round.
fn next_event(equations: &Equations, crest: Node, full: Interval) -> Result<Node, Failure> {
    let Plan { end, reached, .. } = plan(equations, &crest, Some(full))?;
    Ok(if end == Event::Crest { crest } else { Node { event: end, state: reached } })
}

/// The equations of a repeating motion at a box: unknowns are the free coordinates of all nodes.
#[derive(Clone, Debug)]
pub struct Residual {
    /// What is known of each segment.
    pub passages: Vec<Passage>,
    /// By how much the motions from the centres miss the next nodes.
    pub gaps: Vec<Taylor>,
}

/// `2πn`.
fn turn(turns: usize) -> Interval {
    Interval::point(2.0 * turns as f64) * pi()
}

impl Orbit {
    /// The ring of events of the motion from a state at a crest of the force. It begins at the crest if the damper is in flight there and either `at_crest` is asked for
    /// or no wall is struck; otherwise at the next event.
    ///
    /// # Errors
    /// The motion grazes, or does not come back.
    pub fn guess(
        equations: &Equations,
        [x1, v1, x2, v2]: [f64; 4],
        periods: usize,
        at_crest: bool,
    ) -> Result<Self, Failure> {
        let (r, w) = (x2 - x1, v2 - v1);
        let indented = Side::BOTH.into_iter().find_map(|side| {
            let depth = side.sign() * (r - equations.wall(side)?.mid());
            (depth >= 0.0).then_some((side, depth))
        });
        let first = match indented {
            None => {
                let crest = Node { event: Event::Crest, state: [r, w, x1, v1, 0.0, 0.0].map(Taylor::point) };
                if at_crest { crest } else { next_event(equations, crest, turn(periods))? }
            }
            Some((side, depth)) => {
                // The rest of a contact that began before.
                rest_of_contact(equations, side, [depth.sqrt(), side.sign() * w, x1, v1, 0.0, 0.0])?
            }
        };
        let mut orbit = Self { periods, nodes: vec![first], plans: Vec::new(), turns: Vec::new() };
        while orbit.nodes.len() < EVENTS {
            let k = orbit.plans.len();
            let next = plan(equations, &orbit.nodes[k], orbit.crest(k))?;
            let mut reached = Node { event: next.end, state: next.reached };
            orbit.plans.push(next);
            let left = periods - orbit.turns.iter().sum::<usize>();
            let past = reached.state[4].mid() - first.state[4].mid() - turn(left).mid();
            if reached.event == first.event && past > -BACK {
                orbit.turns.push(left);
                return Ok(orbit);
            }
            if past > BACK {
                return Err(Failure::Sequence);
            }
            let turns = ((reached.state[4].mid() / TAU).floor().max(0.0) as usize).min(left);
            reached.state[4] = (reached.state[4] - Taylor::from(turn(turns))).polynomial();
            orbit.turns.push(turns);
            orbit.nodes.push(reached);
        }
        Err(Failure::Endless { steps: EVENTS })
    }

    /// The number of unknowns.
    pub fn unknowns(&self) -> usize {
        FREE * self.nodes.len()
    }

    /// The phase of the crest where it ends, as it is counted in a segment, if it begins at one.
    fn crest(&self, k: usize) -> Option<Interval> {
        let taken: usize = self.turns.iter().take(k).sum();
        (self.nodes[0].event == Event::Crest).then(|| turn(self.periods - taken))
    }

    /// The node after one, and by how much larger the phase is that the segment comes to.
    fn next(&self, k: usize) -> (&Node, Interval) {
        (&self.nodes[(k + 1) % self.nodes.len()], turn(self.turns[k]))
    }

    /// Its equations at all states that are in boxes `away` about its nodes.
    ///
    /// # Errors
    /// A segment cannot be proven.
    pub fn residual(&self, equations: &Equations, away: &[State]) -> Result<Residual, Failure> {
        let (mut passages, mut gaps) = (Vec::new(), Vec::new());
        for (k, node) in self.nodes.iter().enumerate() {
            let passage = follow(equations, node, &away[k], &self.plans[k], self.crest(k))?;
            let (next, shift) = self.next(k);
            for i in next.event.free() {
                let shift = if i == 4 { shift } else { Interval::ZERO };
                gaps.push(passage.centre[i] - next.state[i] - Taylor::from(shift));
            }
            passages.push(passage);
        }
        Ok(Residual { passages, gaps })
    }

    /// The derivatives of the equations by the unknowns: rows of blocks, that of each segment and minus one at the next node.
    pub fn jacobian(&self, passages: &[Passage]) -> Vec<Vec<Taylor>> {
        let (n, size) = (self.unknowns(), FREE);
        let mut all = vec![vec![Taylor::ZERO; n]; n];
        for (k, node) in self.nodes.iter().enumerate() {
            let next = (k + 1) % self.nodes.len();
            for (row, i) in self.nodes[next].event.free().enumerate() {
                let whole = &mut all[size * k + row];
                for (column, j) in node.event.free().enumerate() {
                    whole[size * k + column] = whole[size * k + column] + passages[k].by[i][j];
                }
                let own = size * next + row;
                whole[own] = whole[own] - Taylor::point(1.0);
            }
        }
        all
    }

    /// What the equations leave at the nodes themselves, and the inverse of their derivatives there.
    fn at_nodes(&self, equations: &Equations) -> Result<(Residual, Option<Inverse>), Failure> {
        let known = self.residual(equations, &vec![[Interval::ZERO; STATE]; self.nodes.len()])?;
        let inverse = Inverse::of(&self.jacobian(&known.passages));
        Ok((known, inverse))
    }

    /// With nodes of other states.
    fn with(&self, state: impl Fn(usize, Taylor) -> Taylor) -> Self {
        let mut next = self.clone();
        for (k, node) in next.nodes.iter_mut().enumerate() {
            for (place, i) in node.event.free().enumerate() {
                node.state[i] = state(FREE * k + place, node.state[i]).polynomial();
            }
        }
        next
    }

    /// With the ways planned anew.
    ///
    /// # Errors
    /// See [`plan`]; or its sequence of events becomes another one.
    fn planned(self, equations: &Equations) -> Result<Self, Failure> {
        let plans = self.nodes.iter().enumerate().map(|(k, node)| plan(equations, node, self.crest(k)));
        let plans = plans.collect::<Result<Vec<_>, _>>()?;
        let same = plans.iter().zip(&self.plans).all(|(new, old)| new.end == old.end);
        if same { Ok(Self { plans, ..self }) } else { Err(Failure::Sequence) }
    }

    /// The motion of a family at a value of its parameter, to rounding.
    ///
    /// # Errors
    /// Its events are others there.
    pub fn member(&self, equations: &Equations, s: f64) -> Result<Self, Failure> {
        self.with(|_, state| Taylor::point(state.near(s))).planned(equations)
    }

    /// The family of motions through this one for the frequencies of the equations, by Newton's iteration on polynomials, each of which
    /// doubles the order; with the inverse of the derivatives, and what the equations leave.
    ///
    /// # Errors
    /// A segment cannot be followed.
    pub fn widened(mut self, equations: &Equations) -> Result<(Self, Inverse, Residual), Failure> {
        for n in 0.. {
            let aim = |(k, node): (usize, &Node)| aimed(equations, node, &self.plans[k], self.crest(k));
            self.plans = self.nodes.iter().enumerate().map(aim).collect::<Result<_, _>>()?;
            let (known, inverse) = self.at_nodes(equations)?;
            let inverse = inverse.ok_or(Failure::Sequence)?;
            if n == WIDENED {
                return Ok((self, inverse, known));
            }
            let change = inverse.times(&known.gaps);
            self = self.with(|place, state| state - change[place]);
        }
        Err(Failure::Sequence)
    }

    /// The same, improved by Newton's iteration on the middles of all intervals; with the inverse of the derivatives there.
    ///
    /// # Errors
    /// The iteration does not end on a motion that repeats.
    pub fn improved(self, equations: &Equations) -> Result<(Self, Inverse), Failure> {
        let mut orbit = self;
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let (known, inverse) = orbit.at_nodes(equations)?;
            let gap = known.gaps.iter().map(|gap| gap.mid().abs()).fold(0.0, f64::max);
            let refused = Failure::Guess { periods: orbit.periods, gap };
            let inverse = inverse.ok_or(refused.clone())?;
            let change = inverse.times(&known.gaps);
            let size = change.iter().map(|x| x.mid().abs()).fold(0.0, f64::max);
            if size <= CLOSED || (size < 1e-9 && size >= 0.5 * last) {
                return Ok((orbit, inverse));
            }
            if size.is_nan() || size >= 2.0 * last {
                return Err(refused);
            }
            last = size;
            orbit = orbit.with(|place, state| state - change[place]).planned(equations)?;
        }
        Err(Failure::Guess { periods: orbit.periods, gap: last })
    }
}
