//! Global search: low-discrepancy samples of the whole box, then CMA-ES from the best of them that lie apart.
//!
//! - The samples: an Owen-scrambled Sobol sequence (`sobol_burley`), evaluated in parallel.
//! - CMA-ES (N. Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772) with Hansen's boundary penalty, from the crate
//!   `basin`, in the coordinates of [`Space`]. Searches run in parallel, each with its own stream of random numbers, so
//!   that the result is the same at any number of threads.
//! - [`basins`]: groups the searches that reached the same basin. An optimum that only one of many searches reached is less
//!   certain.

use crate::search::space::Space;
use basin::{
    BoundedCmaEs, BoxBounds, Constrained, ConstraintSet, Constraints, CostFunction, DenseMatrix, Executor,
    NoConstraints, PopulationProgress,
};
use rayon::prelude::*;
use std::convert::Infallible;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
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

/// Searches the whole of `space`. `objective(parameters, cutoff)` is as in [`crate::minimize`]; CMA-ES ranks all designs of a
/// generation, so the cutoff is always +∞. `progress` is called after each evaluation, from any thread.
///
/// # Errors
/// [`GlobalError`].
pub fn explore(
    objective: impl Fn(&[f64], f64) -> f64 + Sync,
    space: &Space,
    global: &Global,
    progress: impl Fn() + Sync,
) -> Result<Vec<Descent>, GlobalError> {
    let value = |x: &[f64]| {
        let value = objective(x, f64::INFINITY);
        progress();
        if value.is_nan() { f64::INFINITY } else { value }
    };
    let look = |i: u32| {
        let coordinate = |side| f64::from(sobol_burley::sample(i, side as u32, global.seed));
        let x = space.point(&(0..space.dim()).map(coordinate).collect::<Vec<f64>>());
        Point { value: value(&x), x }
    };
    let mut points: Vec<Point> = (0..global.samples).into_par_iter().map(look).collect();
    points.retain(|point| point.value < f64::INFINITY);
    points.sort_by(|a, b| a.value.total_cmp(&b.value));
    let mut starts: Vec<Point> = Vec::new();
    for point in points {
        if starts.len() < global.searches
            && starts.iter().all(|other| space.distance(&other.x, &point.x) >= global.apart)
        {
            starts.push(point);
        }
    }
    if starts.is_empty() {
        return Err(GlobalError::NoStart { samples: global.samples });
    }
    let search = |(number, start): (usize, Point)| search(&value, space, global, start, number);
    starts.into_par_iter().enumerate().map(search).collect()
}

/// One CMA-ES search.
fn search(
    value: &(impl Fn(&[f64]) -> f64 + Sync),
    space: &Space,
    global: &Global,
    start: Point,
    number: usize,
) -> Result<Descent, GlobalError> {
    let (counted, count) = (AtomicU64::new(0), space.dim());
    let cost = |u: &[f64]| {
        counted.fetch_add(1, Relaxed);
        value(&space.point(u))
    };
    let bounds = BoxBounds::new(Some(vec![0.0; count]), Some(vec![1.0; count]));
    let problem = Constrained::new(Cost(cost), ConstraintSet::new().with_bounds(bounds));
    let seed = u64::from(global.seed) << 32 | number as u64;
    let solver = BoundedCmaEs::<Vec<f64>, DenseMatrix, f64>::new(seed, global.spread)
        .with_absolute_distribution_size_tolerance(global.tolerance);
    // A generation costs its members and the mean.
    let generation = BoundedCmaEs::<Vec<f64>, DenseMatrix, f64>::default_lambda(count) as u64 + 1;
    let progress = PopulationProgress::from_point(space.coordinates(&start.x));
    let result = Executor::new(problem, solver, progress)
        .max_iter((global.evaluations / generation).max(1))
        .run()
        .map_err(|error| GlobalError::Cma(error.to_string()))?;
    let found = Point { x: space.point(result.best_param()), value: result.best_cost() };
    let found = if found.value < start.value { found } else { start.clone() };
    Ok(Descent { start, found, evaluations: counted.load(Relaxed) })
}

/// A closure as basin's problem.
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
/// from which no ridge separates it. There is no ridge if the objective, at [`ON_THE_WAY`] points evenly spaced between the two, is
/// nowhere above the worse of both by more than a share [`RIDGE`] (the hill-valley test of R. K. Ursem, Multinational evolutionary
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
