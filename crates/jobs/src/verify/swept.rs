//! The points of a sweep, computed again.

use super::report::{Check, Report};
use super::table::Sample;
use crate::{Error, sweep};
use rayon::prelude::*;
use std::path::Path;

/// Checks at most `most` rows of a sweep, every number of each.
///
/// # Errors
/// The file or the input of the sweep cannot be read.
pub fn swept(place: &Path, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let sweep = &sweep::behind(place)?;
    let sample = Sample::read(&place.join(name), most)?;
    let columns = sweep.columns();
    let said: Vec<Vec<f64>> =
        sample.rows().map(|row| columns.iter().map(|column| row.number(&column.name)).collect()).collect();
    let found: Vec<Vec<f64>> =
        said.par_iter().map(|row| sweep.row(row[0], &sweep.numbers(row[0]).0)).collect();
    let mut checks = Vec::new();
    for (said, found) in said.iter().zip(&found) {
        if !said[0].is_finite() {
            checks.push(Check::never());
            continue;
        }
        checks.extend(
            said.iter().zip(found).map(|(&said, &found)| Check { said, again: Box::new(move || found) }),
        );
    }
    report.look(name, &sample.of(said.len()), &checks)
}
