//! The best TMD: the minimum of a closed form over spring and dashpot, by descents from the best points of a small grid and from textbook
//! formulas. It takes milliseconds; under a shock or a record, with runs in time, seconds.

use super::candidate::at_few_stiffnesses;
use super::requirements::Requirements;
use crate::Error;
use crate::tune::objective::searched;
use rayon::prelude::*;
use retune_model::{Amplitude, Measure, Primary, den_hartog, nishihara_asami, warburton};
use retune_optim::{INFEASIBLE, Point, minimize};
use retune_study::{Search, Study};
use std::ops::ControlFlow;

/// Ranges of the spring and the dashpot of the grid, as multiples of Den Hartog's; under a shock or a record a much stiffer spring may be
/// best.
const TUNINGS: [[f64; 2]; 2] = [[0.05, 5.0], [0.05, 1e4]];
const TUNINGS_IN_TIME: [[f64; 2]; 2] = [[0.05, 20.0], [0.05, 1e4]];
/// A dashpot below this share of Den Hartog's counts as none.
const RESIDUE: f64 = 1e-6;
/// Number of valleys of the grid in which descents begin.
const VALLEYS: usize = 3;

/// A formula for an undamped structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula {
    /// The author of the formula.
    pub name: &'static str,
    /// Its spring (N/m) and dashpot (N·s/m).
    pub k2: f64,
    pub c2: f64,
}

impl Formula {
    /// The formulas for the goal, the best first. Nishihara and Asami's, which is exact for an undamped structure, and Den Hartog's for the
    /// displacement under a constant force or on a moving base, the force on the ground under a constant force, or the acceleration on a
    /// base of constant acceleration. Warburton's for the displacement under an imbalance, or the acceleration under a constant force. Else
    /// Den Hartog's.
    pub fn all(requirements: &Requirements, primary: &Primary) -> Vec<Self> {
        let driving = requirements.driving.amplitude();
        let imbalance = driving == Some(Amplitude::Imbalance);
        let accelerated = driving == Some(Amplitude::BaseAcceleration);
        let of_acceleration = requirements.goal == Measure::Acceleration;
        let squared = !accelerated && imbalance != of_acceleration;
        let exact = match requirements.goal {
            Measure::Displacement => !imbalance && !accelerated,
            Measure::GroundForce => driving == Some(Amplitude::Force),
            _ => accelerated && of_acceleration,
        };
        let of = |name, formula: fn(&Primary, f64) -> [f64; 2]| {
            let [k2, c2] = formula(primary, requirements.mass);
            Self { name, k2, c2 }
        };
        let den_hartog = || of("Den Hartog's formula", den_hartog);
        match (squared, exact) {
            // No formula is for a shock or a record: the best known one is shown for comparison.
            _ if driving.is_none() => vec![den_hartog()],
            (true, _) => vec![of("Warburton's formula", warburton)],
            (_, true) => vec![of("Nishihara and Asami's formula", nishihara_asami), den_hartog()],
            _ => vec![den_hartog()],
        }
    }
}

/// The best `[k2, c2]` of a TMD study under its limits, or the one that violates them least. Under a shock or a record, where there are no
/// derivatives, simplex searches replace descents.
pub(super) fn best(study: &Study, formulas: &[Formula]) -> Result<[f64; 2], Error> {
    let search = study.search().map_err(Error::rule(study))?;
    let is_transient = study.scene.forcing.is_transient();
    let searched_study = if is_transient { &at_few_stiffnesses(study) } else { study };
    let objective = searched(searched_study, &search, &search.variables);
    let bounds = &search.options.bounds;
    let scales = den_hartog(&study.scene.primary, search.damper.mass.get());
    let within = |x: [f64; 2]| {
        let one =
            |i: usize| x[i].clamp(bounds[i].lower.unwrap_or(0.0), bounds[i].upper.unwrap_or(f64::INFINITY));
        vec![one(0), one(1)]
    };
    let valleys = objective.valleys(if is_transient { TUNINGS_IN_TIME } else { TUNINGS }, bounds);
    let starts: Vec<Vec<f64>> = std::iter::once(within(scales))
        .chain(formulas.iter().map(|formula| within([formula.k2, formula.c2])))
        .chain(valleys.into_iter().take(VALLEYS).map(|(_, x)| x))
        .collect();
    let down = |start: &Vec<f64>| {
        if is_transient {
            return simplex(|x, cutoff| objective.value(x, cutoff), &search, start);
        }
        objective.descend(bounds, start).end
    };
    let ends: Vec<Point> = starts.par_iter().map(down).collect();
    let mut best = ends.into_iter().min_by(|a, b| a.value.total_cmp(&b.value));
    // A design that keeps the limits at few stiffnesses may just break them at one in between.
    if is_transient && study.objective().k1.is_some() {
        let whole = searched(study, &search, &search.variables);
        let breaks = |end: &Point| end.value < INFEASIBLE && whole.value(&end.x, f64::INFINITY) >= INFEASIBLE;
        if let Some(end) = best.take_if(|end| breaks(end)) {
            best = Some(simplex(|x, cutoff| whole.value(x, cutoff), &search, &end.x));
        }
    }
    let [k2, c2] = best.and_then(|end| <[f64; 2]>::try_from(end.x).ok()).unwrap_or(scales);
    // What a search towards zero leaves is no dashpot to build.
    Ok([k2, if c2 < RESIDUE * scales[1] { bounds[1].lower.unwrap_or(0.0) } else { c2 }])
}

/// The end of a simplex search from a start, for shocks and records, where there are no derivatives; the start itself if the search cannot
/// begin there.
pub(super) fn simplex(value: impl Fn(&[f64], f64) -> f64, search: &Search, start: &[f64]) -> Point {
    let found = minimize(value, start, search.options.clone(), |_| ControlFlow::Continue(()));
    found.map_or_else(
        |_| Point { x: start.to_vec(), value: INFEASIBLE },
        |minimum| Point { x: minimum.x, value: minimum.value },
    )
}
