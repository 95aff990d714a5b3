//! What is told of an evaluation, column by column.

use crate::errors::Fault;
use rayon::prelude::*;
use retune_model::Measure;
use retune_optim::{Evaluation, Limit};

/// The number of columns.
pub const COUNT: usize = 6;
/// Rows without a value whose exceptions are kept.
pub const TOLD: usize = 100;
/// What a row without a value has.
const NOTHING: [f64; COUNT] = [f64::INFINITY, f64::NAN, f64::NAN, f64::NAN, f64::NAN, f64::NAN];

/// The names of [`numbers_of`], the second of which is that of a quantity.
pub fn column_names(quantity: &'static str) -> [&'static str; COUNT] {
    ["value", quantity, "stroke", "contact_force", "violation", "omega_worst"]
}

/// What is known of an evaluation beside its quantity, which is known in any case.
#[derive(Clone, Copy)]
pub struct Known {
    pub quantity: Measure,
    pub stroke: bool,
    pub force: bool,
}

/// What an evaluation found, by [`column_names`]; stroke and force are NaN unless they are known, and so is the frequency of what has none.
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

/// The rows of designs as columns, evaluated in parallel, and those without a value in their order, each with the reason. The rows are written
/// where they belong as they are found, so that nothing is left to do on one thread.
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
