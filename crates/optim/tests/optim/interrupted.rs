//! Interrupted runs: what they keep, and how they continue.

use crate::problems::PROBLEMS;
use retune_optim::{Fminsearch, Minimum, Options, Row, Stop, minimize};
use std::ops::ControlFlow;

const START: [f64; 2] = [-1.2, 1.0];

/// Rosenbrock's function with a corner cut out, so that the first simplex holds a vertex without a value.
fn holed(x: &[f64]) -> f64 {
    let (_name, rosenbrock, start) = PROBLEMS[1];
    assert_eq!(start, START);
    if x[0] < -1.25 { f64::NAN } else { rosenbrock(x) }
}

fn new() -> Fminsearch {
    Fminsearch::new(&START, Options::default()).expect("a valid start")
}

/// The whole run and its rows.
fn unbroken() -> (Minimum, Vec<Row>) {
    let mut rows = Vec::new();
    let found = minimize(
        |x, _| holed(x),
        &START,
        Options::default(),
        |row| {
            rows.push(row.clone());
            ControlFlow::Continue(())
        },
    );
    (found.expect("a valid start"), rows)
}

/// Breaks the run at every row and continues.
fn interrupted_at_every_row(mut solver: Fminsearch) -> (Minimum, Vec<Row>) {
    let mut rows = Vec::new();
    for _ in 0..1000 {
        let found = solver.run(
            |x, _| holed(x),
            |row| {
                rows.push(row.clone());
                ControlFlow::Break(())
            },
        );
        let found = found.expect("a valid start");
        if found.stop != Stop::Interrupted {
            return (found, rows);
        }
    }
    panic!("no end in 1000 rows")
}

#[test]
fn contract_interruption_keeps_what_was_found() {
    let (_, whole) = unbroken();
    for broken_at in [0, 1, 17] {
        let mut rows = Vec::new();
        let found = minimize(
            |x, _| holed(x),
            &[-1.2, 1.0],
            Options::default(),
            |row| {
                rows.push(row.clone());
                if row.iteration == broken_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            },
        )
        .expect("a valid start");
        assert_eq!(rows, whole[..=broken_at as usize]);
        let last = &whole[broken_at as usize];
        assert_eq!((found.stop, found.iterations, &found.x), (Stop::Interrupted, broken_at, &last.best));
        assert_eq!((found.value, found.func_count), (last.value, last.func_count));
    }
}

#[test]
fn invariant_an_interrupted_run_continues_as_if_unbroken() {
    assert_eq!(interrupted_at_every_row(new()), unbroken());

    // A run that has ended stays so: no row, no evaluation.
    let mut ended = new();
    let found = ended.run(|x, _| holed(x), |_| ControlFlow::Continue(()));
    let again = ended.run(|_, _| panic!("evaluated"), |row| panic!("told {row:?}"));
    assert_eq!(found, again);
}
