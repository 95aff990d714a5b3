//! The surf stage: the same bytes at any number of threads, and the choice of the best points.

use retune_optim::{Axis, Grid, Scale, best_separated, best_separated_above, surf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

fn grid(points: &[usize]) -> Grid {
    let axis = |points: &usize| Axis::new(-1.0, 1.0, *points, Scale::Linear).expect("a valid axis");
    Grid::new(points.iter().map(axis).collect(), 1_000_000).expect("a small grid")
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool").install(work)
}

/// A deterministic number in [0, 1) for each point.
fn scattered(i: usize) -> f64 {
    ((i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn invariant_same_bytes_with_one_and_two_threads() {
    let grid = grid(&[37, 11, 13]);
    // Costs vary over the grid, so that threads finish out of order; the last column is NaN and ±∞.
    let objective = |x: &[f64]| match x[2] {
        1.0 if x[1] > 0.5 => f64::NAN,
        1.0 => x[0] / 0.0,
        _ => (0..(500.0 * (1.0 + x[0])) as u32).fold(x[1], |s, k| (s + x[2] * f64::from(k)).sin()),
    };
    let bits = |threads| {
        let values = on_threads(threads, || surf(&grid, objective, |_| ()));
        values.into_iter().map(f64::to_bits).collect::<Vec<u64>>()
    };
    let one = bits(1);
    assert_eq!(one, bits(2));
    let mut point = [0.0; 3];
    for (i, &value) in one.iter().enumerate() {
        grid.point(i, &mut point);
        assert_eq!(value, objective(&point).to_bits(), "point {i} is in its place");
    }
}

#[test]
fn contract_progress_counts_every_point_once() {
    let seen = Mutex::new(Vec::new());
    let grid = grid(&[10, 10]);
    on_threads(2, || surf(&grid, |x| x[0], |done| seen.lock().expect("no panic").push(done)));
    let mut seen = seen.into_inner().expect("no panic");
    seen.sort_unstable();
    assert_eq!(seen, (1..=100).collect::<Vec<u64>>());
}

#[test]
fn contract_best_points_of_a_line() {
    let grid = grid(&[8]);
    let values = [5.0, 1.0, 2.0, 3.0, f64::NEG_INFINITY, 4.0, f64::NAN, 6.0];
    assert_eq!(best_separated(&grid, &values, 1, 3), [1]);
    assert_eq!(best_separated(&grid, &values, 3, 0), [1, 2, 3]);
    assert_eq!(best_separated(&grid, &values, 3, 2), [1, 3, 5]);
    assert_eq!(best_separated(&grid, &values, 3, 3), [1, 5], "no third point is far enough");
    assert_eq!(
        best_separated(&grid, &values, 99, 0),
        [1, 2, 3, 5, 0, 7],
        "NaN and infinities are never taken"
    );
    assert_eq!(best_separated(&grid, &values, 0, 0), [0_usize; 0]);
    assert_eq!(best_separated(&grid, &[f64::NAN; 8], 3, 0), [0_usize; 0]);
}

#[test]
fn contract_ties_go_to_the_lowest_number() {
    assert_eq!(best_separated(&grid(&[5]), &[1.0, 0.0, -0.0, 0.0, -0.0], 4, 1), [1, 2, 3, 4]);
}

#[test]
fn contract_distance_is_along_the_farthest_axis() {
    let grid = grid(&[3, 3]); // numbers 0 1 2 / 3 4 5 / 6 7 8
    let values = [0.0, 9.0, 9.0, 9.0, 1.0, 9.0, 9.0, 2.0, 9.0];
    assert_eq!(best_separated(&grid, &values, 2, 1), [0, 4], "diagonal neighbours are 1 apart");
    assert_eq!(best_separated(&grid, &values, 2, 2), [0, 7], "(0,0) and (2,1) are 2 apart");
}

#[test]
fn invariant_best_points_meet_their_definition() {
    let grid = grid(&[9, 7, 8]);
    let values: Vec<f64> = (0..grid.len()).map(scattered).collect();
    let apart = |a: usize, b: usize| {
        let (mut p, mut q) = ([0; 3], [0; 3]);
        grid.steps(a, &mut p);
        grid.steps(b, &mut q);
        p.iter().zip(&q).map(|(p, q)| p.abs_diff(*q)).max().expect("three axes")
    };
    for min_steps in [1, 2, 3, 6] {
        let taken = best_separated(&grid, &values, 12, min_steps);
        assert!(taken.len() > 1);
        for (k, &i) in taken.iter().enumerate() {
            let allowed = |j: &usize| taken[..k].iter().all(|&t| apart(t, *j) >= min_steps);
            let best = (0..grid.len()).filter(allowed).min_by(|&a, &b| values[a].total_cmp(&values[b]));
            assert_eq!(Some(i), best, "choice {k} at {min_steps} steps");
        }
    }
}

/// Values that are up to a half above their bounds: the choice is that by the values, though a few of them are computed.
#[test]
fn exact_best_points_by_lower_bounds_are_those_by_values() {
    let grid = grid(&[9, 8, 7]);
    for case in 0..200 {
        let lower: Vec<f64> = (0..grid.len()).map(|i| 1.0 + scattered(case * 1000 + i)).collect();
        let value = |i: usize| match scattered(case * 777 + 3 * i) {
            share if share > 0.98 => f64::INFINITY,
            share => lower[i] * (1.0 + 0.5 * (2.0 * share - 1.0).max(0.0)),
        };
        let values: Vec<f64> = (0..grid.len()).map(value).collect();
        for (count, min_steps) in [(1, 0), (3, 2), (12, 3)] {
            let computed = AtomicUsize::new(0);
            let of = |i: usize| {
                computed.fetch_add(1, Relaxed);
                values[i]
            };
            let found = best_separated_above(&grid, &lower, of, count, min_steps);
            let expected: Vec<(usize, f64)> = best_separated(&grid, &values, count, min_steps)
                .into_iter()
                .map(|i| (i, values[i]))
                .collect();
            assert_eq!(found, expected, "case {case}: {count} at least {min_steps} apart");
            assert!(computed.into_inner() < grid.len() / 2);
        }
    }
}
