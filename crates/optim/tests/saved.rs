//! Interrupted runs: what they keep, and how they continue from memory or from a save.

mod problems;

use problems::PROBLEMS;
use retune_optim::{Bounds, Fminsearch, Minimum, Options, Row, Stop, minimize};
use std::cell::Cell;
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

/// Breaks the run at every row and continues with the solver that `continued` returns.
fn interrupted_at_every_row(
    solver: Fminsearch,
    continued: impl Fn(Fminsearch) -> Fminsearch,
) -> (Minimum, Vec<Row>) {
    let (mut solver, mut rows) = (solver, Vec::new());
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
        solver = continued(solver);
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
fn invariant_saved_run_continues_as_if_unbroken() {
    assert_eq!(interrupted_at_every_row(new(), |solver| solver), unbroken());
    let nulls = Cell::new(0);
    let through_json = |solver: Fminsearch| {
        let json = serde_json::to_string(&solver).expect("serialises");
        nulls.set(nulls.get() + json.matches("\"value\":null").count());
        let read: Fminsearch = serde_json::from_str(&json).expect("reads back");
        assert_eq!(read, solver);
        read
    };
    assert_eq!(interrupted_at_every_row(through_json(new()), through_json), unbroken());
    assert!(nulls.get() > 1, "a vertex without a value was saved after the start, too");

    // A run that has ended stays so: no row, no evaluation.
    let mut ended = new();
    let found = ended.run(|x, _| holed(x), |_| ControlFlow::Continue(()));
    let again = ended.run(|_, _| panic!("evaluated"), |row| panic!("told {row:?}"));
    assert_eq!(found, again);
}

#[test]
fn contract_damaged_saves_are_refused() {
    let options = Options { bounds: vec![Bounds::default(); 2], ..Options::default() };
    let mut solver = Fminsearch::new(&START, options).expect("a valid start");
    let third =
        |row: &Row| if row.iteration == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    solver.run(|x, _| holed(x), third).expect("a valid start");
    let good = serde_json::to_value(&solver).expect("serialises");
    assert!(serde_json::from_value::<Fminsearch>(good.clone()).is_ok());
    let damage: [(&str, serde_json::Value); 9] = [
        ("/simplex", serde_json::json!([])),
        ("/simplex/1/x", serde_json::json!([1.0])),
        ("/simplex/0/value", serde_json::json!(1e9)),
        ("/simplex/2/value", serde_json::json!(-1.0)),
        ("/scale", serde_json::json!([])),
        ("/scale/0", serde_json::json!(0.0)),
        ("/iteration", serde_json::json!(0)),
        ("/func_count", serde_json::json!(0)),
        ("/options/bounds/0/lower", serde_json::json!(5.0)),
    ];
    for (place, value) in damage {
        let mut bad = good.clone();
        *bad.pointer_mut(place).expect("a field of the save") = value;
        let error = serde_json::from_value::<Fminsearch>(bad).expect_err(place).to_string();
        assert!(error.contains("not a saved fminsearch run"), "{place}: {error}");
    }
}
