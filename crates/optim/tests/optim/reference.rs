//! `reference_`: whole runs of fminsearch against SciPy's Nelder–Mead, point by point.
//! The runs were made by `tests/reference/fminsearch_scipy.py`, which holds the same four objectives
//! as `problems`.

use crate::problems::{Objective, PROBLEMS, quadratic, rosenbrock, terraces, tmd};
use retune_optim::{Options, Procedure, Row, Stop, minimize};
use serde::Deserialize;
use std::cell::RefCell;
use std::ops::ControlFlow;

#[derive(Deserialize)]
struct Reference {
    tolerance: f64,
    runs: Vec<Run>,
}

/// A run of SciPy's. Points are the parameters followed by the value.
#[derive(Deserialize)]
struct Run {
    name: String,
    start: Vec<f64>,
    iterations: u64,
    func_count: u64,
    best: Vec<Vec<f64>>,
    evaluations: Vec<Vec<f64>>,
}

fn reference() -> Reference {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/fminsearch_scipy.json");
    let text = std::fs::read_to_string(path).expect("the reference is in the repository");
    serde_json::from_str(&text).expect("the reference is what its script writes")
}

fn joined(point: &[f64], value: f64) -> Vec<f64> {
    [point, &[value]].concat()
}

/// Runs `objective` as SciPy ran it and compares all evaluations, the best of each iteration and the counts.
///
/// To the last bit: both programs do the same additions, multiplications, divisions and comparisons in the same
/// order, and IEEE 754 leaves none of their results open. Anything looser would hide a formula written differently.
fn same_as_scipy(name: &str, objective: Objective) -> Vec<Row> {
    let reference = reference();
    let run = reference.runs.iter().find(|run| run.name == name).expect("a run of that name");
    let evaluations = RefCell::new(Vec::new());
    let recorded = |x: &[f64], _cutoff: f64| {
        let value = objective(x);
        evaluations.borrow_mut().push(joined(x, value));
        value
    };
    let mut rows = Vec::new();
    let options = Options { tol_x: reference.tolerance, tol_fun: reference.tolerance, ..Options::default() };
    let found = minimize(recorded, &run.start, options, |row| {
        rows.push(row.clone());
        ControlFlow::Continue(())
    })
    .expect("a valid start");

    for (i, (ours, scipys)) in evaluations.borrow().iter().zip(&run.evaluations).enumerate() {
        assert_eq!(ours, scipys, "{name}: evaluation {i}");
    }
    assert_eq!(evaluations.borrow().len(), run.evaluations.len(), "{name}: evaluations recorded");
    let best: Vec<Vec<f64>> = rows[2..].iter().map(|row| joined(&row.best, row.value)).collect();
    assert_eq!(best, run.best, "{name}: best of each step");
    assert_eq!((found.iterations, found.func_count), (run.iterations, run.func_count), "{name}: counts");
    assert_eq!(found.stop, Stop::Converged);
    rows
}

#[test]
fn reference_quadratic_in_four_dimensions() {
    same_as_scipy("quadratic", quadratic);
}

#[test]
fn reference_rosenbrock() {
    same_as_scipy("rosenbrock", rosenbrock);
}

#[test]
fn reference_terraces_with_ties_and_shrinks() {
    let rows = same_as_scipy("terraces", terraces);
    assert!(rows.iter().any(|row| row.procedure == Procedure::Shrink), "the run shrinks");
}

#[test]
fn reference_tuned_mass_damper() {
    // The value at the start is known independently, from a time integration of the same structure: 635.1068 J.
    assert!((tmd(&[600.0, 262.0]) - 635.1068).abs() < 5e-5);
    same_as_scipy("tmd", tmd);
}

#[test]
fn reference_runs_take_every_kind_of_step() {
    use Procedure::{ContractInside, ContractOutside, Expand, InitialSimplex, Reflect, Shrink, Start};
    let rows: Vec<Row> =
        PROBLEMS.iter().flat_map(|(name, objective, _start)| same_as_scipy(name, *objective)).collect();
    for kind in [Start, InitialSimplex, Reflect, Expand, ContractInside, ContractOutside, Shrink] {
        assert!(rows.iter().any(|row| row.procedure == kind), "{kind:?}");
    }
}
