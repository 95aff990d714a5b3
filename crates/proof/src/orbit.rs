//! A motion that is guessed to repeat, as a ring of events, and its improvement by Newton's iteration.

use crate::elementary::pi;
use crate::equations::Equations;
use crate::event::Event;
use crate::number::{FREE, OMEGA, STATE, State};
use crate::segment::{ALONE, Node, Passage, Plan, follow, plan, rest_of_contact};
use crate::{Failure, Interval};
use nalgebra::{DMatrix, DVector};
use retune_model::Side;
use std::f64::consts::TAU;

/// Most events of a motion.
const EVENTS: usize = 400;
/// Most of Newton's iterations.
const ITERATIONS: usize = 12;
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
    Ok(if end == Event::Crest { crest } else { Node { event: end, state: reached, slope: ALONE } })
}

/// The equations of a repeating motion at a box: unknowns are the free coordinates of all nodes.
#[derive(Clone, Debug)]
pub struct Residual {
    /// What is known of each segment.
    pub passages: Vec<Passage>,
    /// By how much the motions from the centres miss the next nodes.
    pub gaps: Vec<Interval>,
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
        let (r, w, omega) = (x2 - x1, v2 - v1, equations.omega.mid());
        let indented = Side::BOTH.into_iter().find_map(|side| {
            let depth = side.sign() * (r - equations.wall(side)?.mid());
            (depth >= 0.0).then_some((side, depth))
        });
        let first = match indented {
            None => {
                let crest = Node { event: Event::Crest, state: [r, w, x1, v1, 0.0, omega], slope: ALONE };
                if at_crest { crest } else { next_event(equations, crest, turn(periods))? }
            }
            Some((side, depth)) => {
                // The rest of a contact that began before.
                rest_of_contact(equations, side, [depth.sqrt(), side.sign() * w, x1, v1, 0.0, omega])?
            }
        };
        let mut orbit = Self { periods, nodes: vec![first], plans: Vec::new(), turns: Vec::new() };
        while orbit.nodes.len() < EVENTS {
            let k = orbit.plans.len();
            let next = plan(equations, &orbit.nodes[k], orbit.crest(k))?;
            let mut reached = Node { event: next.end, state: next.reached, slope: ALONE };
            orbit.plans.push(next);
            let left = periods - orbit.turns.iter().sum::<usize>();
            let past = reached.state[4] - first.state[4] - turn(left).mid();
            if reached.event == first.event && past > -BACK {
                orbit.turns.push(left);
                return Ok(orbit);
            }
            if past > BACK {
                return Err(Failure::Sequence);
            }
            let turns = ((reached.state[4] / TAU).floor().max(0.0) as usize).min(left);
            reached.state[4] -= turn(turns).mid();
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
                // The family is followed along its slopes; what these leave of a change of ω counts as a gap.
                let drift = (passage.by[i][OMEGA] - Interval::point(next.slope[i])) * away[k][OMEGA];
                gaps.push(passage.centre[i] - (Interval::point(next.state[i]) + shift) + drift);
            }
            passages.push(passage);
        }
        Ok(Residual { passages, gaps })
    }

    /// The derivatives of the equations by the unknowns: rows of blocks, that of each segment and minus one at the next node.
    pub fn jacobian(&self, passages: &[Passage]) -> Vec<Vec<Interval>> {
        let (n, size) = (self.unknowns(), FREE);
        let mut all = vec![vec![Interval::ZERO; n]; n];
        for (k, node) in self.nodes.iter().enumerate() {
            let next = (k + 1) % self.nodes.len();
            for (row, i) in self.nodes[next].event.free().enumerate() {
                let whole = &mut all[size * k + row];
                for (column, j) in node.event.free().enumerate() {
                    whole[size * k + column] = whole[size * k + column] + passages[k].by[i][j];
                }
                let own = size * next + row;
                whole[own] = whole[own] - Interval::ONE;
            }
        }
        all
    }

    /// Moved by changes of the unknowns, with the ways planned anew.
    ///
    /// # Errors
    /// See [`plan`]; or its sequence of events becomes another one.
    fn moved(&self, equations: &Equations, change: &DVector<f64>) -> Result<Self, Failure> {
        let mut nodes = self.nodes.clone();
        for (k, node) in nodes.iter_mut().enumerate() {
            for (place, i) in node.event.free().enumerate() {
                node.state[i] += change[FREE * k + place];
            }
        }
        let plans = nodes.iter().enumerate().map(|(k, node)| plan(equations, node, self.crest(k)));
        let plans = plans.collect::<Result<Vec<_>, _>>()?;
        let same = plans.iter().zip(&self.plans).all(|(new, old)| new.end == old.end);
        if same { Ok(Self { nodes, plans, ..self.clone() }) } else { Err(Failure::Sequence) }
    }

    /// The motion of a family at another frequency, to first order.
    ///
    /// # Errors
    /// Its events are others there.
    pub fn leant(&self, equations: &Equations, omega: f64) -> Result<Self, Failure> {
        let mut change = DVector::zeros(self.unknowns());
        for (k, node) in self.nodes.iter().enumerate() {
            for (place, i) in node.event.free().enumerate() {
                change[FREE * k + place] = node.slope[i] * (omega - node.state[OMEGA]);
            }
        }
        let mut next = self.clone();
        for node in &mut next.nodes {
            (node.state[OMEGA], node.slope) = (omega, ALONE);
        }
        next.moved(equations, &change)
    }

    /// The same with the slopes of its family: the equations hold along it to first order.
    ///
    /// # Errors
    /// A segment cannot be followed.
    pub fn leaning(mut self, equations: &Equations, inverse: &DMatrix<f64>) -> Result<Self, Failure> {
        let none = vec![[Interval::ZERO; STATE]; self.nodes.len()];
        let known = self.residual(equations, &none)?;
        let by_omega = |k: usize| {
            let next = self.nodes[(k + 1) % self.nodes.len()].event;
            next.free().map(|i| known.passages[k].by[i][OMEGA].mid()).collect::<Vec<_>>()
        };
        let by_omega: Vec<f64> = (0..self.nodes.len()).flat_map(by_omega).collect();
        let slopes = -(inverse * DVector::from_vec(by_omega));
        for (k, node) in self.nodes.iter_mut().enumerate() {
            for (place, i) in node.event.free().enumerate() {
                node.slope[i] = slopes[FREE * k + place];
            }
        }
        Ok(self)
    }

    /// The same, improved by Newton's iteration on the middles of all intervals; with the inverse of the derivatives there.
    ///
    /// # Errors
    /// The iteration does not end on a motion that repeats.
    pub fn improved(self, equations: &Equations) -> Result<(Self, DMatrix<f64>), Failure> {
        let mut orbit = self;
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let none = vec![[Interval::ZERO; STATE]; orbit.nodes.len()];
            let Residual { passages, gaps } = orbit.residual(equations, &none)?;
            let jacobian = orbit.jacobian(&passages);
            let n = orbit.unknowns();
            let gap = gaps.iter().map(|gap| gap.mid().abs()).fold(0.0, f64::max);
            let refused = Failure::Guess { periods: orbit.periods, gap };
            let Some(inverse) = DMatrix::from_fn(n, n, |i, j| jacobian[i][j].mid()).try_inverse() else {
                return Err(refused);
            };
            let change = -(&inverse * DVector::from_fn(n, |i, _| gaps[i].mid()));
            let size = change.amax();
            if size <= CLOSED || (size < 1e-9 && size >= 0.5 * last) {
                return Ok((orbit, inverse));
            }
            if size.is_nan() || size >= 2.0 * last {
                return Err(refused);
            }
            last = size;
            orbit = orbit.moved(equations, &change)?;
        }
        Err(Failure::Guess { periods: orbit.periods, gap: last })
    }
}
