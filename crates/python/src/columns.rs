//! The results of an evaluation as columns.

use crate::errors::Fault;
use rayon::prelude::*;
use retune_model::Measure;
use retune_optim::{Evaluation, Limit};

/// The number of columns.
pub const COUNT: usize = 6;
/// Most rows without a value whose exceptions are kept.
pub const MAX_EXCEPTIONS: usize = 100;
/// The numbers of a row without a value.
const NOTHING: [f64; COUNT] = [f64::INFINITY, f64::NAN, f64::NAN, f64::NAN, f64::NAN, f64::NAN];

/// The names of the columns of [`numbers_of`]; the second is the objective's quantity.
pub fn column_names(quantity: &'static str) -> [&'static str; COUNT] {
    ["value", quantity, "stroke", "contact_force", "violation", "omega_worst"]
}

/// Which quantities of an evaluation are known beside its own.
#[derive(Clone, Copy)]
pub struct Known {
    pub quantity: Measure,
    pub stroke: bool,
    pub force: bool,
}

/// The results of an evaluation in the order of [`column_names`]; NaN for a stroke or force that is not known, and for the frequency if
/// there is none.
pub fn numbers_of(found: &Evaluation, Known { quantity, stroke, force }: Known) -> [f64; COUNT] {
    let known = |measure, known| match known {
        true => found.reached.get(Limit::Of(measure)),
        false if measure == quantity => found.value,
        false => f64::NAN,
    };
    let [stroke, force] = [known(Measure::Stroke, stroke), known(Measure::ContactForce, force)];
    let omega = found.worst_omega().unwrap_or(f64::NAN);
    // An empty sum of violations is -0.
    [found.ranked, found.value, stroke, force, found.violation + 0.0, omega]
}

/// The columns of a batch.
type Columns = [Vec<f64>; COUNT];

/// Evaluates the rows of designs in parallel and returns them as columns, with the rows without a value in order, each with its reason.
/// Each row is written to its place when it is found, so that no serial work remains.
pub fn in_columns(
    designs: &[f64],
    width: usize,
    row: impl Fn(&[f64]) -> Result<[f64; COUNT], Fault> + Sync,
) -> (Columns, Vec<(usize, Box<Fault>)>) {
    let mut columns: Columns = std::array::from_fn(|_| vec![0.0; designs.len() / width]);
    let [a, b, c, d, e, f] = columns.each_mut().map(|column| column.par_iter_mut());
    let rows = (a, b, c, d, e, f, designs.par_chunks_exact(width)).into_par_iter().enumerate();
    let failed = rows.filter_map(|(i, (a, b, c, d, e, f, design))| {
        let (numbers, fault) = match row(design) {
            Ok(numbers) => (numbers, None),
            Err(fault) => (NOTHING, Some((i, Box::new(fault)))),
        };
        [*a, *b, *c, *d, *e, *f] = numbers;
        fault
    });
    let failed = failed.collect();
    (columns, failed)
}
