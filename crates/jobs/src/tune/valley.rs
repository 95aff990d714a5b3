//! The range of each parameter of a design, the others held, within which the value grows by at most 0.1 %: it tells how many digits
//! matter.

use super::objective::{Task, journaled, searched};
use crate::summary::is_no_gap;
use rayon::prelude::*;
use retune_model::Parameter;
use retune_optim::Bounds;
use retune_study::{rounded, short};
use serde::Serialize;
use std::sync::{Mutex, PoisonError};

/// Allowed relative growth of the value.
const ALLOWED: f64 = 1e-3;
/// Distances at which the value is probed, as shares of the parameter; smaller changes are not resolved.
const STEPS: [f64; 8] = [1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 0.9, 9.0];
/// Bisections between the last step within the allowance and the first beyond it.
const HALVINGS: usize = 5;
/// A range wider than this share of the parameter is reported as flat.
const FLAT: f64 = 0.1;

/// The range of a parameter in which the value of a design is at most 0.1 % larger, as far as it was probed: at every step outwards.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Valley {
    pub variable: Parameter,
    /// Smallest and largest parameter value within the allowance.
    pub from: f64,
    pub to: f64,
    /// Whether even the outermost step upwards, to the bound or to ten times the value, is within the allowance.
    pub open: bool,
    #[serde(skip)]
    own: f64,
}

/// The valleys of a design, and the lowest design probed, if its value is lower by more than [`ALLOWED`].
pub(super) struct Measured {
    pub valleys: Vec<Valley>,
    pub lower: Option<Vec<f64>>,
}

/// Measures the valley of each varied parameter of a design.
pub(super) fn measure(task: &Task, design: &[f64]) -> Measured {
    let Task { study, search, journal, .. } = *task;
    let mut objective = searched(study, search, &search.variables);
    if objective.goal().follows_motions() && objective.learn(design).is_err() {
        return Measured { valleys: Vec::new(), lower: None };
    }
    let value = journaled(&objective, journal, "valley", || ());
    let base = value(design, f64::INFINITY);
    let most = (1.0 + ALLOWED) * base;
    let lowest = Mutex::new(((1.0 - ALLOWED) * base, None));
    let is_within = |i: usize, x: f64| {
        let mut other = design.to_vec();
        other[i] = x;
        let found = value(&other, most);
        let lowest = &mut *lowest.lock().unwrap_or_else(PoisonError::into_inner);
        // Ties go to the smaller design, so that the result does not depend on the order of the threads.
        if found < lowest.0 || found == lowest.0 && lowest.1.as_ref().is_some_and(|known| other < *known) {
            *lowest = (found, Some(other));
        }
        found <= most
    };
    let reach = |(i, outwards): (usize, f64)| {
        let (x, Bounds { lower, upper }) =
            (design[i], search.options.bounds.get(i).copied().unwrap_or_default());
        let at = |share: f64| {
            (x * (1.0 + outwards * share))
                .clamp(lower.unwrap_or(0.0).max(0.0), upper.unwrap_or(f64::INFINITY))
        };
        let (mut good, mut failed) = (0.0, None);
        for share in STEPS {
            if at(share) == at(good) {
                break; // at a bound
            }
            if !is_within(i, at(share)) {
                failed = Some(share);
                break;
            }
            good = share;
        }
        let open = failed.is_none();
        if let Some(mut bad) = failed {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (good + bad);
                if is_within(i, at(middle)) { good = middle } else { bad = middle }
            }
        }
        (at(good), open)
    };
    let sides: Vec<(usize, f64)> = (0..design.len()).flat_map(|i| [(i, -1.0), (i, 1.0)]).collect();
    let found: Vec<(f64, bool)> = sides.into_par_iter().map(reach).collect();
    let valley = |(i, variable): (usize, &Parameter)| {
        let [(from, _), (to, open)] = [found[2 * i], found[2 * i + 1]];
        Valley { variable: *variable, from, to, open, own: design[i] }
    };
    let valleys = search.variables.iter().enumerate().map(valley).collect();
    Measured { valleys, lower: lowest.into_inner().unwrap_or_else(PoisonError::into_inner).1 }
}

impl Valley {
    /// The significant digits, two to six, that keep the rounded parameter in its range; six where the range is empty.
    pub(crate) fn digits(&self) -> usize {
        let share = (self.own - self.from).min(self.to - self.own) / self.own.abs();
        // At an end of its range it may move one way only.
        let share = if share > 0.0 { share } else { (self.to - self.from) / self.own.abs() };
        if share > 0.0 && share.is_finite() {
            ((1.0 - (2.0 * share).log10()).ceil() as usize).clamp(2, 6)
        } else {
            6
        }
    }

    /// Whether the range is wide.
    pub(crate) fn is_flat(&self) -> bool {
        self.to - self.from > FLAT * self.own.abs() && !is_no_gap(self.variable, self.to)
    }

    /// A flat direction in words, its ends rounded inwards; none if the range is narrow.
    pub(crate) fn words(&self) -> Option<String> {
        if !self.is_flat() {
            return None;
        }
        let Self { variable, from, to, open, .. } = self;
        let (name, unit) = (variable.symbol(), variable.unit());
        let [low, high] = [inward(*from, f64::ceil), inward(*to, f64::floor)].map(short);
        // Beyond the last step nothing was probed.
        let least = if *open { "at least " } else { "" };
        Some(format!("{name} from {low} to {least}{high} {unit}"))
    }
}

/// A number to two digits, rounded by `round`, a ceiling or a floor.
fn inward(value: f64, round: impl Fn(f64) -> f64) -> f64 {
    let nearest: f64 = rounded(value, 2).parse().unwrap_or(value);
    if nearest == value || value <= 0.0 {
        return nearest;
    }
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    let inside = round(value / unit) * unit;
    rounded(inside, 2).parse().unwrap_or(inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_ends_are_rounded_to_the_inside() {
        for (value, up, down) in
            [(0.011_515, 0.012, 0.011), (579.2, 580.0, 570.0), (0.5, 0.5, 0.5), (0.0, 0.0, 0.0)]
        {
            assert_eq!([inward(value, f64::ceil), inward(value, f64::floor)], [up, down], "{value}");
        }
    }
}
