//! Global search on functions with known minima.

use rayon::ThreadPoolBuilder;
use retune_optim::{Global, Point, Scale, Side, Space, basins, explore};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

fn unit(sides: usize) -> Space {
    Space(vec![Side { from: -5.12, to: 5.12, scale: Scale::Linear }; sides])
}

fn rastrigin(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x + 10.0 - 10.0 * (std::f64::consts::TAU * x).cos()).sum()
}

/// Four wells at (±2, ±2), the one at (2, -2) the deepest.
fn wells(x: &[f64]) -> f64 {
    let depth = |a: f64, b: f64, d: f64| -d * (-(x[0] - a).powi(2) - (x[1] - b).powi(2)).exp();
    10.0 + depth(2.0, -2.0, 5.0) + depth(2.0, 2.0, 4.0) + depth(-2.0, 2.0, 4.0) + depth(-2.0, -2.0, 4.0)
}

#[test]
fn exact_the_deepest_of_four_wells_is_found_and_all_are_told_apart() {
    let global = Global { samples: 128, searches: 8, ..Global::default() };
    let found = explore(|x, _| wells(x), &unit(2), &global, || {}).expect("values");
    let ends: Vec<Point> = found.iter().map(|search| search.found.clone()).collect();
    let basins = basins(|x, _| wells(x), &unit(2), &ends, 0.05);
    assert_eq!(basins.len(), 4, "{basins:?}");
    assert_eq!(basins.iter().map(|basin| basin.reached_by.len()).sum::<usize>(), found.len());
    let best = &basins[0].best;
    assert!((best.x[0] - 2.0).abs() < 0.02 && (best.x[1] + 2.0).abs() < 0.02, "{best:?}");
    assert!(basins.windows(2).all(|pair| pair[0].best.value <= pair[1].best.value));
}

/// Ends far apart on one level stretch are one basin; on either side of a ridge they are two.
#[test]
fn contract_a_level_stretch_is_one_basin_and_a_ridge_makes_two() {
    let at = |x: f64, y: f64| Point { x: vec![x, y], value: x * x };
    let ends = [at(0.001, 4.0), at(0.0, -4.0), at(0.002, 1.0)];
    let all = basins(|x, _| x[0] * x[0], &unit(2), &ends, 0.01);
    assert_eq!(all.len(), 1);
    assert_eq!((all[0].best.x[1], &all[0].reached_by), (-4.0, &vec![0, 1, 2]));
    let ridge = |x: &[f64], _: f64| x[0] * x[0] + if x[1].abs() < 0.5 { 1.0 } else { 0.0 };
    assert_eq!(basins(ridge, &unit(2), &ends[..2], 0.01).len(), 2);
    assert_eq!(basins(ridge, &unit(2), &ends[1..], 0.9).len(), 1, "near is one whatever lies between");
}

#[test]
fn contract_the_same_bits_at_any_number_of_threads_and_others_for_another_seed() {
    let global = Global { samples: 64, searches: 4, evaluations: 200, ..Global::default() };
    let on = |threads: usize, global: Global| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| explore(|x, _| rastrigin(x), &unit(3), &global, || {}).expect("values"))
    };
    let one = on(1, global);
    assert_eq!(one.len(), 4);
    assert_eq!([on(2, global), on(3, global)], [one.clone(), one.clone()]);
    assert_ne!(on(1, Global { seed: 2, ..global }), one);
    assert!(one.iter().all(|search| search.found.value < search.start.value));
}

/// Every evaluation lies in the box, and their number is bounded: the samples, and whole generations of the searches.
#[test]
fn contract_searches_stay_in_the_box_and_within_their_evaluations() {
    let space = Space(vec![Side::natural(10.0, 5000.0), Side::natural(0.0, 2.0)]);
    assert_eq!([space.0[0].scale, space.0[1].scale], [Scale::Log, Scale::Linear]);
    let count = AtomicU64::new(0);
    // The minimum lies on a corner.
    let corner = |x: &[f64], cutoff: f64| {
        count.fetch_add(1, Relaxed);
        assert!((10.0..=5000.0).contains(&x[0]) && (0.0..=2.0).contains(&x[1]) && cutoff > 0.0);
        x[0] / 1000.0 + x[1]
    };
    let global = Global { samples: 32, searches: 2, evaluations: 300, ..Global::default() };
    let found = explore(corner, &space, &global, || {}).expect("values");
    assert!(found[0].found.value < 0.02, "{:?}", found[0]);
    let made: u64 = found.iter().map(|search| search.evaluations).sum();
    let samples = count.load(Relaxed) - made;
    assert!((32..=36).contains(&samples), "{samples} evaluations of samples, few of them made again");
    assert!(found.iter().all(|search| search.evaluations <= 300 + 8));
}

/// Whatever number above its cutoff an evaluation gives, starts and ends are the same bits, and many evaluations may end early.
#[test]
fn contract_a_value_above_its_cutoff_may_be_any_number_above() {
    for seed in 1..9 {
        let global = Global { samples: 96, searches: 6, evaluations: 200, seed, ..Global::default() };
        let whole = explore(|x, _| rastrigin(x), &unit(3), &global, || {}).expect("values");
        let early = AtomicU64::new(0);
        let told = |x: &[f64], cutoff: f64| match rastrigin(x) {
            value if value > cutoff => {
                early.fetch_add(1, Relaxed);
                cutoff.next_up()
            }
            value => value,
        };
        assert_eq!(explore(told, &unit(3), &global, || {}).expect("values"), whole);
        let all = 96 + whole.iter().map(|search| search.evaluations).sum::<u64>();
        assert!(4 * early.load(Relaxed) > all, "{} of {all} ended early", early.load(Relaxed));
    }
}

#[test]
fn exact_coordinates_are_the_inverse_of_values() {
    let space = Space(vec![Side::natural(10.0, 5000.0), Side::natural(-1.0, 2.0)]);
    for u in [[0.0, 0.0], [0.25, 0.5], [1.0, 1.0]] {
        let back = space.coordinates(&space.point(&u));
        assert!(back.iter().zip(u).all(|(a, b)| (a - b).abs() < 1e-14), "{back:?} {u:?}");
    }
    assert_eq!(space.point(&[0.0, 1.0]), [10.0, 2.0]);
    assert!((space.distance(&[10.0, 0.0], &[100.0, 0.3]) - 10_f64.ln() / 500_f64.ln()).abs() < 1e-14);
}

/// Logarithmic if a side spans a decade above zero, at any magnitude.
#[test]
fn contract_a_side_is_logarithmic_from_a_decade_on() {
    for from in [1e-3, 0.1, 1.0, 250.0] {
        assert_eq!(Side::natural(from, 10.0 * from).scale, Scale::Log, "{from}");
        assert_eq!(Side::natural(from, 9.99 * from).scale, Scale::Linear, "{from}");
    }
    for (from, to) in [(0.0, 1e6), (-1.0, 1e6), (-100.0, -1.0)] {
        assert_eq!(Side::natural(from, to).scale, Scale::Linear, "{from}");
    }
}

#[test]
fn contract_designs_without_a_value_start_no_search() {
    let nothing = explore(|_, _| f64::NAN, &unit(2), &Global { samples: 8, ..Global::default() }, || {});
    assert!(nothing.expect_err("no start").to_string().contains("of the 8 that were spread"));
    let half = |x: &[f64], _: f64| if x[0] < 0.0 { f64::INFINITY } else { x[0] + x[1].abs() };
    let found = explore(half, &unit(2), &Global { samples: 64, ..Global::default() }, || {}).expect("values");
    assert!(found.iter().all(|search| search.found.x[0] >= 0.0) && found[0].found.value < 0.1);
}
