//! The best TMD: the least of a closed form over spring and dashpot, by the descents of its peaks from the best of a small grid and from
//! the formulas of textbooks. It takes milliseconds; under a shock or a record, whose runs are followed in time, seconds.

use super::candidate::at_few_stiffnesses;
use super::requirements::Requirements;
use crate::Error;
use crate::tune::objective::searched;
use rayon::prelude::*;
use retune_model::{Amplitude, Measure, Primary, den_hartog, nishihara_asami, warburton};
use retune_optim::{INFEASIBLE, Point, minimize};
use retune_study::{Search, Study};
use std::ops::ControlFlow;

/// Points of the grid along k2 and c2, from and to these multiples of Den Hartog's.
const POINTS: usize = 16;
const RANGE: [[f64; 2]; 2] = [[0.05, 5.0], [0.05, 1e4]];
/// That of k2 under a shock or a record, which a spring much stiffer may suit.
const RANGE_IN_TIME: [f64; 2] = [0.05, 20.0];
/// Points of the grid from which descents begin.
const BEST: usize = 3;

/// A formula for an undamped structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula {
    /// Whose it is, and for what.
    pub name: &'static str,
    /// Its spring (N/m) and dashpot (N·s/m).
    pub k2: f64,
    pub c2: f64,
}

impl Formula {
    /// The formulas that fit what is asked, the best first. Where it is the displacement under a constant force or on a moving base, the force
    /// on the ground under a constant force, or the acceleration on a base of constant acceleration: Nishihara and Asami's, which is exact
    /// without damping of the structure, and Den Hartog's. Warburton's where it is the displacement under an imbalance, or the
    /// acceleration under a constant force. Else Den Hartog's.
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
            // Under a shock or a record none is for the goal: the best known one stands beside.
            _ if driving.is_none() => vec![den_hartog()],
            (true, _) => vec![of("Warburton's formula", warburton)],
            (_, true) => vec![of("Nishihara and Asami's formula", nishihara_asami), den_hartog()],
            _ => vec![den_hartog()],
        }
    }
}

/// The best `[k2, c2]` of a TMD study under its limits: of designs that break some, the one that breaks them by the least. Under a shock or
/// a record, of which there are no derivatives, a simplex takes the place of descents.
pub(super) fn best(study: &Study, formulas: &[Formula]) -> Result<[f64; 2], Error> {
    let search = study.search().map_err(Error::rule(study))?;
    let is_transient = study.scene.forcing.is_transient();
    let sought = if is_transient { &at_few_stiffnesses(study) } else { study };
    let objective = searched(sought, &search, &search.variables);
    let bounds = &search.options.bounds;
    let scales = den_hartog(&study.scene.primary, search.damper.mass.get());
    let within = |x: [f64; 2]| {
        let one =
            |i: usize| x[i].clamp(bounds[i].lower.unwrap_or(0.0), bounds[i].upper.unwrap_or(f64::INFINITY));
        [one(0), one(1)]
    };
    let at = |number: usize| {
        let one = |axis: usize, step: usize| {
            let [from, to] = if is_transient && axis == 0 { RANGE_IN_TIME } else { RANGE[axis] };
            scales[axis] * from * (to / from).powf(step as f64 / (POINTS - 1) as f64)
        };
        let x = within([one(0, number % POINTS), one(1, number / POINTS)]);
        (objective.value(&x, f64::INFINITY), x)
    };
    let mut grid: Vec<(f64, [f64; 2])> = (0..POINTS * POINTS).into_par_iter().map(at).collect();
    if is_transient {
        grid = valleys(&grid);
    }
    grid.sort_by(|a, b| a.0.total_cmp(&b.0));
    let starts: Vec<[f64; 2]> = std::iter::once(within(scales))
        .chain(formulas.iter().map(|formula| within([formula.k2, formula.c2])))
        .chain(grid.iter().take(BEST).map(|(_, x)| *x))
        .collect();
    let down = |start: &[f64; 2]| {
        if is_transient {
            return simplex(|x, cutoff| objective.value(x, cutoff), &search, start);
        }
        objective.descend(bounds, start).end
    };
    let ends: Vec<Point> = starts.par_iter().map(down).collect();
    let mut best = ends.into_iter().min_by(|a, b| a.value.total_cmp(&b.value));
    // What keeps the limits at few stiffnesses may just break them at one between.
    if is_transient && study.objective().k1.is_some() {
        let whole = searched(study, &search, &search.variables);
        let breaks = |end: &Point| end.value < INFEASIBLE && whole.value(&end.x, f64::INFINITY) >= INFEASIBLE;
        if let Some(end) = best.take_if(|end| breaks(end)) {
            best = Some(simplex(|x, cutoff| whole.value(x, cutoff), &search, &end.x));
        }
    }
    Ok(best.and_then(|end| <[f64; 2]>::try_from(end.x).ok()).unwrap_or(scales))
}

/// The points of the grid that are no worse than those around them.
fn valleys(grid: &[(f64, [f64; 2])]) -> Vec<(f64, [f64; 2])> {
    let beside = |number: usize| {
        let (i, j) = (number % POINTS, number / POINTS);
        let around = |at: usize| at.saturating_sub(1)..=(at + 1).min(POINTS - 1);
        around(j).flat_map(move |j| around(i).map(move |i| j * POINTS + i))
    };
    let is_least = |number: &usize| beside(*number).all(|other| grid[*number].0 <= grid[other].0);
    (0..grid.len()).filter(is_least).map(|number| grid[number]).collect()
}

/// What goes down where there are no derivatives, under a shock and a record: the end of the refinement of a search from a start; the start itself
/// where none can begin there.
pub(super) fn simplex(value: impl Fn(&[f64], f64) -> f64, search: &Search, start: &[f64]) -> Point {
    let found = minimize(value, start, search.options.clone(), |_| ControlFlow::Continue(()));
    found.map_or_else(
        |_| Point { x: start.to_vec(), value: INFEASIBLE },
        |minimum| Point { x: minimum.x, value: minimum.value },
    )
}
