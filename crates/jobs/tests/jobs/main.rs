//! The jobs as another program calls them, on studies of a few runs.

mod band;
mod branches;
mod certify;
mod damaged;
mod describe;
mod design;
mod design_answers;
mod design_histories;
mod design_records;
mod evaluate;
mod fronts;
mod interrupted;
mod limits;
mod links;
mod losses;
mod motions;
mod own_structures;
mod paper;
mod prove;
mod quantity;
mod records;
mod replaced;
mod report;
mod retention;
mod scenes;
mod shards;
mod simulate;
mod stationary;
mod sweep;
mod sweep_points;
mod table2;
mod tune;
mod verify;
mod verify_fronts;
mod walls;

use retune_jobs::design::{Requirements, Specification, design};
use retune_jobs::tune::{Optimum, tune};
use retune_jobs::{Done, Observer};
use retune_jobs::{Request, Silent};
use retune_store::Begin;
use retune_study::Study;
use retune_testkit::desk::Desk;
use retune_testkit::observers::good;
use serde_json::Value;

/// A request for the results of a study of the desk, in a directory of it.
fn request(desk: &Desk, study: &str, out: &str) -> Request {
    Request { out: Some(desk.path(out)), ..Request::new(&desk.path(study)) }
}

/// The same, to resume what there is.
fn resume(desk: &Desk, study: &str, out: &str) -> Request {
    Request { begin: Begin::Resume, ..request(desk, study, out) }
}

/// The same, to discard unfinished work.
fn restart(desk: &Desk, study: &str, out: &str) -> Request {
    Request { begin: Begin::Restart, ..request(desk, study, out) }
}

/// The same, to replace whatever results there are.
fn replace(desk: &Desk, study: &str, out: &str) -> Request {
    Request { replace: true, ..request(desk, study, out) }
}

/// The answer of a job that was done now.
#[track_caller]
fn found<T>(done: Done<T>) -> T {
    match done {
        Done::Made(answer) => answer,
        Done::FinishedBefore => panic!("it was finished before"),
    }
}

/// Makes the search of a study of the desk, into a directory of it.
#[track_caller]
fn search(desk: &Desk, study: &str, out: &str) -> Optimum {
    found(good(tune(&request(desk, study, out), &Silent)))
}

/// What is asked of `design`.
fn asked(specification: Value) -> Specification {
    serde_json::from_value(specification).expect("specification")
}

/// Makes a design into `out` of a desk.
#[track_caller]
fn make(desk: &Desk, requirements: &Requirements, watch: &dyn Observer) {
    drop(good(design(requirements, &request(desk, "out", "out"), watch)));
}

/// Reads a study of the desk.
#[track_caller]
fn read(desk: &Desk, study: &str) -> Study {
    retune_study::read(&desk.path(study)).unwrap_or_else(|error| panic!("{error}"))
}
