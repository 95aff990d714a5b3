//! A sample of the rows of a table, computed again.

use super::report::Report;
use super::tally::Tally;
use crate::Error;
use crate::again::{Numbers, Row, Source, each_row};
use rayon::prelude::*;
use retune_study::counted;
use std::path::Path;

/// Computes at most `most` rows again, evenly spread, and compares every number of them with the file.
pub fn check(
    path: &Path,
    name: &str,
    source: &Source,
    most: usize,
    report: &mut Report<'_>,
) -> Result<(), Error> {
    let mut applicable = Vec::new();
    let mut names = csv::StringRecord::new();
    let mut count = 0_u64;
    each_row(path, |number, row| {
        names.clone_from(row.names);
        count += 1;
        if (source.applies)(row) {
            applicable.push(number);
        }
    })?;
    let kept = applicable.len().min(most);
    let place = |i: usize| applicable[i * (applicable.len() - 1) / kept.saturating_sub(1).max(1)];
    let wanted: Vec<usize> = (0..kept).map(place).collect();
    let mut rows = Vec::with_capacity(kept);
    each_row(path, |number, row| {
        if wanted.get(rows.len()) == Some(&number) {
            rows.push(row.fields.clone());
        }
    })?;
    let again = |fields: &csv::StringRecord| (source.row)(Row { names: &names, fields });
    let found: Vec<Option<Numbers>> = rows.par_iter().map(again).collect();
    let mut tally = Tally::default();
    for (fields, found) in rows.iter().zip(found) {
        let row = Row { names: &names, fields };
        match found {
            Some(found) => found.iter().for_each(|(name, found)| tally.see(row.number(name), *found)),
            None => tally.differs(f64::INFINITY), // no command writes such a row
        }
    }
    report.tell(name, &format!("{kept} of {} run again", counted(count, "row")), &tally)
}
