//! Axes and grids: their values, their numbering, and the inputs they refuse.

use retune_optim::{Axis, AxisError, Grid, GridError, Scale};

fn linear(from: f64, to: f64, points: usize) -> Axis {
    Axis::new(from, to, points, Scale::Linear).expect("a valid axis")
}

fn values(axis: &Axis) -> Vec<f64> {
    (0..axis.points()).map(|i| axis.value(i)).collect()
}

#[test]
fn exact_linear_axis_keeps_round_steps_round() {
    assert_eq!(values(&linear(200.0, 260.0, 7)), [200.0, 210.0, 220.0, 230.0, 240.0, 250.0, 260.0]);
    assert_eq!(values(&linear(-1.0, 1.0, 5)), [-1.0, -0.5, 0.0, 0.5, 1.0]);
    let tenths = values(&linear(0.0, 10.0, 101));
    assert!(tenths.iter().enumerate().all(|(i, value)| *value == i as f64 / 10.0), "{tenths:?}");
}

#[test]
fn invariant_axes_hit_their_ends_and_increase() {
    for scale in [Scale::Linear, Scale::Log] {
        for points in [2, 3, 7, 20, 1001] {
            for (from, to) in [(0.1, 0.7), (1.0 / 3.0, 3e5), (1e-280, 1e280)] {
                let axis = Axis::new(from, to, points, scale).expect("a valid axis");
                let values = values(&axis);
                assert_eq!((values[0], values[points - 1]), (from, to), "{axis:?}");
                assert!(values.is_sorted_by(|a, b| a < b), "{axis:?}");
            }
        }
    }
}

#[test]
fn exact_log_axis_has_equal_ratios() {
    let axis = Axis::new(1e-3, 1e3, 7, Scale::Log).expect("a valid axis");
    for (i, decade) in [1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0, 1e3].into_iter().enumerate() {
        assert!((axis.value(i) / decade - 1.0).abs() < 1e-14, "{i}: {}", axis.value(i));
    }
}

#[test]
fn contract_single_point_axis() {
    assert_eq!(values(&linear(0.36, 0.36, 1)), [0.36]);
    assert_eq!(Axis::new(5.0, 5.0, 1, Scale::Log).map(|axis| axis.value(0)), Ok(5.0));
}

#[test]
fn contract_bad_axes_are_refused_by_name_and_value() {
    let refused = |from, to, points, scale| Axis::new(from, to, points, scale).expect_err("a bad axis");
    let (inf, linear, log) = (f64::INFINITY, Scale::Linear, Scale::Log);
    assert!(matches!(refused(f64::NAN, 1.0, 2, linear), AxisError::NotANumber { name: "from", .. }));
    assert_eq!(refused(0.0, inf, 2, linear), AxisError::NotANumber { name: "to", value: inf });
    assert_eq!(refused(-1e281, 0.0, 2, linear), AxisError::NotANumber { name: "from", value: -1e281 });
    assert_eq!(refused(0.0, 1.0, 2, log), AxisError::NotPositive { name: "from", value: 0.0 });
    assert_eq!(refused(2.0, -1.0, 2, log), AxisError::NotPositive { name: "to", value: -1.0 });
    assert_eq!(refused(2.0, 1.0, 2, linear), AxisError::Reversed { from: 2.0, to: 1.0 });
    assert_eq!(refused(1.0, 2.0, 0, linear), AxisError::Points { points: 0, from: 1.0, to: 2.0 });
    assert_eq!(refused(1.0, 2.0, 1, linear), AxisError::Points { points: 1, from: 1.0, to: 2.0 });
    assert_eq!(refused(1.0, 1.0, 2, linear), AxisError::Points { points: 2, from: 1.0, to: 1.0 });
    assert_eq!(refused(1.0, 1.0, 0, linear), AxisError::Points { points: 0, from: 1.0, to: 1.0 });
    let message = refused(0.0, 1.0, 2, log).to_string();
    assert_eq!(message, "`from` is 0: both ends of a logarithmic axis must be above zero");
}

#[test]
fn contract_points_are_numbered_with_the_last_axis_fastest() {
    let grid = Grid::new(vec![linear(1.0, 2.0, 2), linear(7.0, 7.0, 1), linear(10.0, 30.0, 3)], 6)
        .expect("6 points");
    let expected = [[1.0, 7.0, 10.0], [1.0, 7.0, 20.0], [1.0, 7.0, 30.0], [2.0, 7.0, 10.0], [2.0, 7.0, 20.0]];
    assert_eq!((grid.len(), grid.dim()), (6, 3));
    let (mut point, mut steps) = ([0.0; 3], [9; 3]);
    for (i, expected) in expected.iter().enumerate() {
        grid.point(i, &mut point);
        assert_eq!(&point, expected, "point {i}");
    }
    grid.steps(5, &mut steps);
    assert_eq!(steps, [1, 0, 2]);
}

#[test]
fn contract_grids_above_the_limit_are_refused_before_anything_is_made() {
    let axes = |n: usize, points: usize| vec![linear(0.0, 1.0, points); n];
    assert!(Grid::new(axes(2, 10), 100).is_ok());
    assert_eq!(Grid::new(axes(2, 10), 99), Err(GridError::TooLarge { points: 100, limit: 99 }));
    let million_million = Grid::new(axes(2, 1_000_000), 10_000_000).expect_err("too large");
    assert_eq!(million_million.to_string(), "the grid has 1e12 points: at most 10000000 are allowed");
    // 10¹⁹⁰ points overflow any integer; a wrapped product would be 0.
    let overflow = Grid::new(axes(10, usize::MAX), usize::MAX);
    assert_eq!(overflow, Err(GridError::TooLarge { points: u128::MAX, limit: usize::MAX }));
    assert_eq!(Grid::new(vec![], 10), Err(GridError::NoAxes));
}

#[test]
fn contract_an_axis_returns_its_ends_and_points() {
    let axis = Axis::new(2.0, 50.0, 7, Scale::Log).expect("an axis");
    assert_eq!((axis.from(), axis.to(), axis.points()), (2.0, 50.0, 7));
}
