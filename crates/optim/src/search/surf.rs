//! The `surf` stage: an objective at every point of a grid, and its best points.

use crate::search::grid::Grid;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// The objective at every point of `grid`, in the grid's order.
///
/// Points are shared among the threads of the current rayon pool. Each value depends on its point alone and is written
/// to its own element, so the result is the same to the last bit at any number of threads. NaN and infinite values
/// are kept as they are.
///
/// `progress` is called with the number of points done, once for each point and from any thread, so numbers may arrive
/// out of order; each of `1..=grid.len()` arrives once.
pub fn surf(
    grid: &Grid,
    objective: impl Fn(&[f64]) -> f64 + Sync,
    progress: impl Fn(u64) + Sync,
) -> Vec<f64> {
    surf_part(grid, 0..grid.len(), |_, point| objective(point), progress)
}

/// As [`surf`] for a range of the points; the objective also receives the index of the point.
///
/// # Panics
/// If the grid has no such points.
pub fn surf_part(
    grid: &Grid,
    points: Range<usize>,
    objective: impl Fn(usize, &[f64]) -> f64 + Sync,
    progress: impl Fn(u64) + Sync,
) -> Vec<f64> {
    each_point(grid, points, &objective, &progress)
}

fn each_point(
    grid: &Grid,
    points: Range<usize>,
    objective: &(dyn Fn(usize, &[f64]) -> f64 + Sync),
    progress: &(dyn Fn(u64) + Sync),
) -> Vec<f64> {
    assert!(points.end <= grid.len(), "points {points:?} of a grid of {}", grid.len());
    let done = AtomicU64::new(0);
    points
        .into_par_iter()
        .map_init(
            || vec![0.0; grid.dim()], // once for a range of points, not for each point
            |point, i| {
                grid.point(i, point);
                let value = objective(i, point);
                progress(done.fetch_add(1, Relaxed) + 1);
                value
            },
        )
        .collect()
}

/// Numbers of the `count` best (smallest) points, best first, any two at least `min_steps` grid steps apart along
/// some axis (the Chebyshev distance).
///
/// Each next point is the smallest finite value far enough from those already taken; of equal values the one with
/// the lowest number. Points that are not finite are never taken. The list is shorter than `count` if the grid
/// has no more such points.
///
/// # Panics
/// If `values` is not one value for each point of `grid`.
pub fn best_separated(grid: &Grid, values: &[f64], count: usize, min_steps: usize) -> Vec<usize> {
    assert_eq!(values.len(), grid.len(), "one value for each point of the grid");
    best_apart(values, count, &steps_apart(grid, min_steps))
}

/// Whether two points of a grid are at least `min_steps` steps apart along some axis.
fn steps_apart(grid: &Grid, min_steps: usize) -> impl Fn(usize, usize) -> bool {
    let steps = move |i: usize| {
        let mut steps = vec![0; grid.dim()];
        grid.steps(i, &mut steps);
        steps
    };
    move |i, j| chebyshev(&steps(i), &steps(j)) >= min_steps
}

/// The numbers of the `count` smallest finite `values`, best first, any two of them `apart`; of equal values those with the lower numbers.
fn best_apart(values: &[f64], count: usize, apart: &dyn Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut ranked: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_finite()).collect();
    // The sort is stable, so equal values (−0 and 0 among them) stay in the order of their numbers.
    ranked.sort_by(|&a, &b| values[a].partial_cmp(&values[b]).unwrap_or(Ordering::Equal));
    let mut taken: Vec<usize> = Vec::new();
    for i in ranked {
        if taken.len() == count {
            break;
        }
        if taken.iter().all(|&other| apart(other, i)) {
            taken.push(i);
        }
    }
    taken
}

/// As [`best_separated`], with `lower` bounds on the values: only the points that may be among the best are evaluated, in batches. Returns
/// the numbers of the best, best first, and their values.
///
/// A point that is not evaluated has a larger lower bound than those chosen, or is too near to one that is better.
///
/// # Panics
/// If `lower` is not one value for each point of `grid`.
pub fn best_separated_above(
    grid: &Grid,
    lower: &[f64],
    value: impl Fn(usize) -> f64 + Sync,
    count: usize,
    min_steps: usize,
) -> Vec<(usize, f64)> {
    assert_eq!(lower.len(), grid.len(), "one value for each point of the grid");
    let none_known = vec![false; lower.len()];
    best_apart_above(lower.to_vec(), none_known, &value, count, &steps_apart(grid, min_steps))
}

/// [`best_apart`] where `values` that are not `known` are lower bounds: of these only those that may be among the best are evaluated, in
/// batches. Returns the numbers of the best, best first, and their values.
pub(crate) fn best_apart_above(
    mut values: Vec<f64>,
    mut known: Vec<bool>,
    value: &(dyn Fn(usize) -> f64 + Sync),
    count: usize,
    apart: &dyn Fn(usize, usize) -> bool,
) -> Vec<(usize, f64)> {
    loop {
        let best = best_apart(&values, count, apart);
        let open: Vec<usize> = best.iter().copied().filter(|&i| !known[i]).collect();
        if open.is_empty() {
            return best.into_iter().map(|i| (i, values[i])).collect();
        }
        let found: Vec<f64> = open.par_iter().map(|&i| value(i)).collect();
        for (i, found) in open.into_iter().zip(found) {
            (values[i], known[i]) = (found, true);
        }
    }
}

/// Largest number of steps between two grid points along any axis.
fn chebyshev(a: &[usize], b: &[usize]) -> usize {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}
