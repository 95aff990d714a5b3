//! Tables whose rows are known in advance, such as grids and sweeps. Rows are computed in parallel, values in the journal are reused, and
//! shares of the rows can be computed on other machines (`parts`).

use crate::{Error, Observer, Progress};
use rayon::prelude::*;
use retune_store::Journal;
use std::ops::Range;

/// The rows of a table. Each depends only on its index, so that they can be computed in any order.
pub trait Rows: Sync {
    /// The number of rows.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of numbers in each row.
    fn width(&self) -> usize;

    /// The numbers of a row, infinite where missing, and if so the reason for the first.
    fn numbers(&self, row: usize) -> (Vec<f64>, Option<String>);

    /// Receives the numbers of a row that are taken from the journal.
    fn recall(&self, _numbers: &[f64]) {}
}

/// Computes a range of rows in order: their numbers, and the reason where some are missing. Reports progress for each row.
pub fn compute(
    rows: &dyn Rows,
    some: Range<usize>,
    journal: &Journal,
    progress: &dyn Progress,
) -> Vec<(Vec<f64>, Option<String>)> {
    let width = rows.width();
    let row = |row: usize| {
        progress.begin();
        let mut made: Option<(Vec<f64>, Option<String>)> = None;
        let numbers: Vec<f64> = (0..width)
            .map(|i| {
                let number = || made.get_or_insert_with(|| rows.numbers(row)).0[i];
                journal.grid_value(width * row + i, number, |_| {})
            })
            .collect();
        if made.is_none() && !journal.is_broken() {
            progress.known();
            rows.recall(&numbers);
        }
        progress.inc(1);
        (numbers, made.and_then(|(_, reason)| reason))
    };
    some.into_par_iter().map(row).collect()
}

/// Applies a function to all items in parallel, in order. Reports progress for each item.
///
/// # Errors The error of the first item in order that fails, independent of the threads.
pub fn of_each<T: Sync, U: Send>(
    all: &[T],
    progress: &dyn Progress,
    of: impl Fn(&T) -> Result<U, Error> + Sync + Send,
) -> Result<Vec<U>, Error> {
    let one = |one: &T| {
        progress.begin();
        let made = of(one);
        progress.inc(1);
        made
    };
    let made: Vec<Result<U, Error>> = all.par_iter().map(one).collect();
    made.into_iter().collect()
}

/// [`of_each`] as a stage with its own progress.
///
/// # Errors
/// As [`of_each`].
pub fn in_a_stage<T: Sync, U: Send>(
    (watch, stage): (&dyn Observer, &'static str),
    all: &[T],
    of: impl Fn(&T) -> Result<U, Error> + Sync + Send,
) -> Result<Vec<U>, Error> {
    let bar = watch.progress(stage, all.len() as u64);
    let made = of_each(all, &*bar, of);
    bar.finish();
    made
}
