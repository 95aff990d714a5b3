//! The descent of a design by the derivatives of its peaks, within the bounds and limits of a search.

use super::design_objective::{Counts, DesignObjective};
use super::limits::ranked;
use crate::search::fminsearch::Bounds;
use crate::search::global::Point;
use crate::search::minimax::{Height, minimax};
use crate::search::space::{Side, Space};
use retune_model::Parameter;
use std::cell::Cell;

/// Relative gain below which a step is not worth its runs; for a steady response, which is in closed form, below which it is rounding.
const GAIN: f64 = 1e-5;
const STEADY_GAIN: f64 = 1e-10;
/// The box of a descent reaches to `WIDE` times the start, within the bounds, so that steps scale with a parameter and not with a bound
/// that may be far away. A descent that ends on this side of its box continues in another one, in at most `BOXES` boxes.
const WIDE: f64 = 4.0;
const BOXES: usize = 8;
/// Upper bounds of an unbounded spring and dashpot, in multiples of Den Hartog's: the damper is all but locked to the structure there, and
/// runs take ever more steps.
const LOCKED: [f64; 2] = [1e3, 3e2];

/// The height of a design that was not evaluated.
const UNKNOWN: Height = Height { worst: f64::INFINITY, violation: f64::INFINITY };

/// The result of a descent.
#[derive(Clone, Debug, PartialEq)]
pub struct Foot {
    /// The value at the start, as of [`DesignObjective::value`].
    pub from: f64,
    /// The design, and its value.
    pub end: Point,
    /// The designs that were evaluated on the way.
    pub counts: Counts,
}

impl DesignObjective {
    /// Descends from `start` and returns the best design on the way, `start` included; only `start` if its value has no pieces.
    pub fn descend(&self, bounds: &[Bounds], start: &[f64]) -> Foot {
        let counts = [const { Cell::new(0) }; 2];
        let from = Cell::new(f64::NAN);
        let evaluate = |x: &[f64], cutoff: f64| {
            if counts[0].get() >= self.patience {
                return (UNKNOWN, Vec::new()); // the step is rejected, and the descent ends
            }
            let found = self.height_and_runs(x, cutoff);
            counts[0].set(counts[0].get() + 1);
            counts[1].set(counts[1].get() + u64::from(found.0.violation > 0.0));
            if from.get().is_nan() {
                from.set(ranked(found.0.worst, found.0.violation));
            }
            found
        };
        let gain = if self.goal().objective.is_steady() { STEADY_GAIN } else { GAIN };
        let (mut at, mut height) = (start.to_vec(), UNKNOWN);
        for _ in 0..BOXES {
            let space = Space((0..at.len()).map(|i| self.side(i, bounds[i], at[i])).collect());
            let (end, found) = if self.goal().has_pieces() {
                minimax(evaluate, |x, runs| self.pieces(x, runs), &space, &at, gain)
            } else {
                (at.clone(), evaluate(&at, f64::INFINITY).0)
            };
            let is_inside = |(i, (side, end)): (usize, (&Side, &f64))| {
                *end < side.to || *end >= bounds[i].upper.unwrap_or(self.locked(i))
            };
            let is_done = !found.is_below(&height) || space.0.iter().zip(&end).enumerate().all(is_inside);
            if found.is_below(&height) {
                (at, height) = (end, found);
            }
            if is_done {
                break;
            }
        }
        let [evaluations, infeasible] = counts.map(Cell::into_inner);
        let value = ranked(height.worst, height.violation);
        Foot { from: from.get(), end: Point { x: at, value }, counts: Counts { evaluations, infeasible } }
    }

    /// The value of a parameter from which it all but locks the damper, in its unit; infinite for one that does not lock it.
    fn locked(&self, i: usize) -> f64 {
        let [k2, c2] = self.den_hartog();
        let locked = match self.variables()[i] {
            Parameter::K2 => LOCKED[0] * k2 * self.driven()[1].powi(2).max(1.0),
            Parameter::C2 => LOCKED[1] * c2,
            _ => f64::INFINITY,
        };
        if locked > 0.0 { locked } else { f64::INFINITY }
    }

    /// A side of the box: the whole range of a gap, which may be zero.
    fn side(&self, i: usize, Bounds { lower, upper }: Bounds, at: f64) -> Side {
        let (low, high) = (lower.unwrap_or(0.0), upper.unwrap_or(self.locked(i).max(at)));
        let is_gap = self.variables()[i].is_gap();
        let wide = if at > low && !(is_gap && high.is_finite()) { WIDE * at } else { high };
        let most = if wide.is_finite() { wide.min(high) } else { 1.0_f64.max(2.0 * low) };
        Side::natural(low, most)
    }
}
