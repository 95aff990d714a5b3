//! Global search: low-discrepancy samples of the whole box, then CMA-ES from the best of them that lie apart.
//!
//! - The samples: an Owen-scrambled Sobol sequence (`sobol_burley`), evaluated in parallel.
//! - CMA-ES (N. Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772) with Hansen's boundary penalty, from the crate
//!   `basin`, in the coordinates of [`Space`]. Searches run in parallel, each with its own stream of random numbers, so
//!   that the result is the same at any number of threads.
//! - [`basins`]: groups the searches that reached the same basin. An optimum that only one of many searches reached is less
//!   certain.

use crate::search::space::Space;
use crate::search::surf::best_apart_above;
use basin::{
    BoundedCmaEs, BoxBounds, Constrained, ConstraintSet, Constraints, CostFunction, DenseMatrix, Executor,
    NoConstraints, PopulationProgress,
};
use rayon::prelude::*;
use std::cell::{Cell, RefCell};
use std::convert::Infallible;
use std::ops::Range;
use thiserror::Error;

/// The settings of a global search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Global {
    /// Number of samples, at least 1 and at most 65536.
    pub samples: u32,
    /// Number of searches, each from one of the best samples, at least 1.
    pub searches: usize,
    /// Least distance between two starts, in coordinates of [`Space`].
    pub apart: f64,
    /// Standard deviation of the first generation, in coordinates of [`Space`], above 0.
    pub spread: f64,
    /// A search ends once its standard deviation is below this along every axis.
    pub tolerance: f64,
    /// Evaluations after which a search ends, at the end of the generation that reaches them.
    pub evaluations: u64,
    /// Seed of the samples and of the random numbers.
    pub seed: u32,
}

impl Default for Global {
    fn default() -> Self {
        Self {
            samples: 512,
            searches: 8,
            apart: 0.15,
            spread: 0.15,
            tolerance: 2e-3,
            evaluations: 400,
            seed: 1,
        }
    }
}

/// A design and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The parameters, in their own units.
    pub x: Vec<f64>,
    /// The value of the objective there.
    pub value: f64,
}

/// One search.
#[derive(Clone, Debug, PartialEq)]
pub struct Descent {
    /// Where it started.
    pub start: Point,
    /// The best point it evaluated.
    pub found: Point,
    /// Evaluations it made.
    pub evaluations: u64,
}

/// Why a global search failed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GlobalError {
    /// None of the samples has a value.
    #[error("no design could be computed of the {samples} that were spread over the whole box")]
    NoStart {
        /// The number of samples.
        samples: u32,
    },
    /// CMA-ES did not accept its box.
    #[error("CMA-ES: {0}")]
    Cma(String),
}

/// Searches the whole of `space`. `objective(parameters, cutoff)` is as in [`crate::minimize`]: no value is negative, and one above the
/// cutoff need only be known to be above. `progress` is called after each evaluation, from any thread.
///
/// A quarter of the samples is computed in full; of the others only those that may be among the starts, so the starts are the same as if
/// all were. A search caps the value of a design at the larger of one and a half times the least that it has found and the median of its
/// last generation: CMA-ES only ranks designs, and mainly by the better half.
///
/// # Errors
/// [`GlobalError`].
pub fn explore(
    objective: impl Fn(&[f64], f64) -> f64 + Sync,
    space: &Space,
    global: &Global,
    progress: impl Fn() + Sync,
) -> Result<Vec<Descent>, GlobalError> {
    run_searches(&objective, space, global, &progress)
}

/// An objective with a cutoff, for parallel searches.
type Objective<'a> = &'a (dyn Fn(&[f64], f64) -> f64 + Sync);

fn run_searches(
    objective: Objective<'_>,
    space: &Space,
    global: &Global,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<Descent>, GlobalError> {
    let value = |x: &[f64], cutoff: f64| {
        let value = objective(x, cutoff);
        if value.is_nan() { f64::INFINITY } else { value }
    };
    let place = |i: usize| {
        let coordinate = |side| f64::from(sobol_burley::sample(i as u32, side as u32, global.seed));
        space.point(&(0..space.dim()).map(coordinate).collect::<Vec<f64>>())
    };
    let samples = global.samples as usize;
    let in_full = samples / 4;
    let sampled = |range: Range<usize>, cutoff: f64| -> Vec<f64> {
        let evaluate = |i: usize| value(&place(i), cutoff);
        range.into_par_iter().map(evaluate).inspect(|_| progress()).collect()
    };
    let mut values = sampled(0..in_full, f64::INFINITY);
    let mut ranked = values.clone();
    ranked.sort_by(f64::total_cmp);
    let cutoff = ranked.get(global.searches.max(1) - 1).copied().unwrap_or(f64::INFINITY);
    values.extend(sampled(in_full..samples, cutoff));
    let known = (0..samples).map(|i| i < in_full || values[i] <= cutoff).collect();
    let apart = |i: usize, j: usize| space.distance(&place(i), &place(j)) >= global.apart;
    let in_full_value = |i: usize| value(&place(i), f64::INFINITY);
    let starts = best_apart_above(values, known, &in_full_value, global.searches, &apart);
    if starts.is_empty() {
        return Err(GlobalError::NoStart { samples: global.samples });
    }
    let reported = |x: &[f64], cutoff: f64| {
        let value = value(x, cutoff);
        progress();
        value
    };
    let search = |(number, (i, value)): (usize, (usize, f64))| {
        search(&reported, space, global, Point { x: place(i), value }, number)
    };
    starts.into_par_iter().enumerate().map(search).collect()
}

/// Values above this multiple of the least that a search has found may be capped.
const BAD: f64 = 1.5;

/// The median of some values, the lower one of two.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len().saturating_sub(1) / 2).copied().unwrap_or(f64::INFINITY)
}

/// One CMA-ES search.
fn search(
    value: Objective<'_>,
    space: &Space,
    global: &Global,
    start: Point,
    number: usize,
) -> Result<Descent, GlobalError> {
    let count = space.dim();
    let members = BoundedCmaEs::<Vec<f64>, DenseMatrix, f64>::default_lambda(count);
    let seen = RefCell::new(vec![start.value]);
    let least = Cell::new(start.value);
    let cost = |u: &[f64]| {
        let mut seen = seen.borrow_mut();
        let last = &seen[seen.len().saturating_sub(members)..];
        let most = median(last).max(BAD * least.get());
        let value = value(&space.point(u), most).min(most);
        seen.push(value);
        least.set(least.get().min(value));
        value
    };
    let bounds = BoxBounds::new(Some(vec![0.0; count]), Some(vec![1.0; count]));
    let problem = Constrained::new(Cost(cost), ConstraintSet::new().with_bounds(bounds));
    let seed = u64::from(global.seed) << 32 | number as u64;
    let solver = BoundedCmaEs::<Vec<f64>, DenseMatrix, f64>::new(seed, global.spread)
        .with_absolute_distribution_size_tolerance(global.tolerance);
    // A generation evaluates its members and the mean.
    let generation = members as u64 + 1;
    let progress = PopulationProgress::from_point(space.coordinates(&start.x));
    let result = Executor::new(problem, solver, progress)
        .max_iter((global.evaluations / generation).max(1))
        .run()
        .map_err(|error| GlobalError::Cma(error.to_string()))?;
    let found = Point { x: space.point(result.best_param()), value: result.best_cost() };
    let found = if found.value < start.value { found } else { start.clone() };
    Ok(Descent { start, found, evaluations: seen.borrow().len() as u64 - 1 })
}

/// Adapts a closure to the crate `basin`.
struct Cost<F>(F);

impl<F> Constraints for Cost<F> {
    type Set = NoConstraints;
    fn constraints(&self) -> NoConstraints {
        ConstraintSet::new()
    }
}

impl<F: Fn(&[f64]) -> f64> CostFunction for Cost<F> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;
    fn cost(&self, x: &Vec<f64>) -> Result<f64, Infallible> {
        Ok((self.0)(x))
    }
}

/// A basin of the objective that searches reached.
#[derive(Clone, Debug, PartialEq)]
pub struct Basin {
    /// The best design in it.
    pub best: Point,
    /// The indices of the searches that ended in it, ascending.
    pub reached_by: Vec<usize>,
}

/// Groups the ends of searches by basin: each joins the best end that is less than `apart` away in the coordinates of `space`, or
/// from which no ridge separates it. There is no ridge if the objective, at `ON_THE_WAY` points evenly spaced between the two, is
/// nowhere above the worse of both by more than a share `RIDGE` (the hill-valley test of R. K. Ursem, Multinational evolutionary
/// algorithms, CEC 1999). So a level stretch is one basin, whatever its length. The basins are sorted, best first.
pub fn basins(
    objective: impl Fn(&[f64], f64) -> f64,
    space: &Space,
    found: &[Point],
    apart: f64,
) -> Vec<Basin> {
    let same = |a: &Point, b: &Point| {
        let most = a.value.max(b.value) * (1.0 + RIDGE);
        let (u, v) = (space.coordinates(&a.x), space.coordinates(&b.x));
        let on_the_way = |i: usize| {
            let share = i as f64 / (ON_THE_WAY + 1) as f64;
            let w: Vec<f64> = u.iter().zip(&v).map(|(u, v)| u + share * (v - u)).collect();
            space.point(&w)
        };
        space.distance(&a.x, &b.x) < apart
            || (1..=ON_THE_WAY).map(on_the_way).all(|x| objective(&x, most) <= most)
    };
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by(|&a, &b| found[a].value.total_cmp(&found[b].value));
    let mut basins: Vec<Basin> = Vec::new();
    for i in order {
        match basins.iter_mut().find(|basin| same(&basin.best, &found[i])) {
            Some(basin) => basin.reached_by.push(i),
            None => basins.push(Basin { best: found[i].clone(), reached_by: vec![i] }),
        }
    }
    for basin in &mut basins {
        basin.reached_by.sort_unstable();
    }
    basins
}

/// Number of points between two designs at which the objective is evaluated to find a ridge.
pub const ON_THE_WAY: usize = 3;
/// Share by which a ridge exceeds the worse of the two designs that it separates.
pub const RIDGE: f64 = 1e-3;
