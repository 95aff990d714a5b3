//! The best TMD: the least of a closed form over spring and dashpot, by the descents of its peaks from the best of a small grid and from
//! the formulas of textbooks. It takes milliseconds.

use super::requirements::{Driving, Requirements};
use crate::Error;
use crate::tune::objective::searched;
use rayon::prelude::*;
use retune_model::{Measure, Scene, den_hartog, warburton};
use retune_study::Study;

/// Points of the grid along k2 and c2, from and to these multiples of Den Hartog's.
const POINTS: usize = 16;
const RANGE: [[f64; 2]; 2] = [[0.05, 5.0], [0.05, 100.0]];
/// Points of the grid from which descents begin.
const BEST: usize = 3;

/// The formula of a textbook for an undamped structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula {
    /// Whose it is, and for what.
    pub name: &'static str,
    /// Its spring (N/m) and dashpot (N·s/m).
    pub k2: f64,
    /// As `k2`.
    pub c2: f64,
}

impl Formula {
    /// The formula that fits what is asked: Den Hartog's where the displacement under a constant force or on a moving base counts,
    /// Warburton's where it is the displacement under an imbalance, or the acceleration under a constant force.
    pub fn of(requirements: &Requirements, scene: &Scene) -> Self {
        let squared = matches!(requirements.source, Driving::Imbalance(_))
            != (requirements.goal == Measure::Acceleration);
        let (name, formula): (_, fn(&_, f64) -> [f64; 2]) =
            if squared { ("Warburton's formula", warburton) } else { ("Den Hartog's formula", den_hartog) };
        let [k2, c2] = formula(&scene.primary, requirements.mass);
        Self { name, k2, c2 }
    }
}

/// The best `[k2, c2]` of a TMD study under its limits: of designs that break some, the one that breaks them by the least.
///
/// # Errors
/// The study has nothing to tune.
pub(super) fn best(study: &Study, formula: Formula) -> Result<[f64; 2], Error> {
    let search = study.search().map_err(Error::rule(study))?;
    let objective = searched(study, &search, &search.variables);
    let bounds = &search.options.bounds;
    let scales = den_hartog(&study.scene.primary, search.damper.mass.get());
    let within = |x: [f64; 2]| {
        let one =
            |i: usize| x[i].clamp(bounds[i].lower.unwrap_or(0.0), bounds[i].upper.unwrap_or(f64::INFINITY));
        [one(0), one(1)]
    };
    let at = |number: usize| {
        let one = |axis: usize, step: usize| {
            let [from, to] = RANGE[axis];
            scales[axis] * from * (to / from).powf(step as f64 / (POINTS - 1) as f64)
        };
        let x = within([one(0, number % POINTS), one(1, number / POINTS)]);
        (objective.value(&x, f64::INFINITY), x)
    };
    let mut grid: Vec<(f64, [f64; 2])> = (0..POINTS * POINTS).into_par_iter().map(at).collect();
    grid.sort_by(|a, b| a.0.total_cmp(&b.0));
    let starts: Vec<[f64; 2]> = [within(scales), within([formula.k2, formula.c2])]
        .into_iter()
        .chain(grid.iter().take(BEST).map(|(_, x)| *x))
        .collect();
    let ends: Vec<_> = starts.par_iter().map(|start| objective.descend(bounds, start).end).collect();
    let best = ends.into_iter().min_by(|a, b| a.value.total_cmp(&b.value));
    Ok(best.and_then(|end| <[f64; 2]>::try_from(end.x).ok()).unwrap_or(scales))
}
