//! The jobs made of many searches, as another program calls them, on studies of a few runs.

mod fronts;
mod retention;
mod verify;

use retune_store::Begin;
use retune_testkit::desk::Desk;
use retune_workbench::Request;

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
