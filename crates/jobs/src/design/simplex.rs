//! What goes down where there are no derivatives: under a shock and a record.

use retune_optim::{INFEASIBLE, Point, minimize};
use retune_study::Search;
use std::ops::ControlFlow;

/// The end of the refinement of a search from a start; the start itself where none can begin there.
pub(super) fn simplex(value: impl Fn(&[f64], f64) -> f64, search: &Search, start: &[f64]) -> Point {
    let found = minimize(value, start, search.options.clone(), |_| ControlFlow::Continue(()));
    found.map_or_else(
        |_| Point { x: start.to_vec(), value: INFEASIBLE },
        |minimum| Point { x: minimum.x, value: minimum.value },
    )
}
