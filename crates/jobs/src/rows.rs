//! The rows of a table that are known before any of them is computed: those of a grid, of a sweep. They are computed in parallel; what the
//! journal knows is not computed again; a share of them can be computed on another machine (`parts`).

use crate::{Error, Observer, Progress};
use rayon::prelude::*;
use retune_store::Journal;
use std::ops::Range;

/// Such rows. Each depends on its number alone, so that they can be computed in any order.
pub trait Rows: Sync {
    /// How many there are.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of numbers that each has.
    fn width(&self) -> usize;

    /// The numbers of a row, infinite where there is none; and then why the first of them has no value.
    fn numbers(&self, row: usize) -> (Vec<f64>, Option<String>);

    /// Hears of the numbers of a row that are not computed again.
    fn recall(&self, _numbers: &[f64]) {}
}

/// The numbers of some rows, in their order, each with the reason where it has none. The progress is told of each row.
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

/// What a function gives for each of some things, side by side. The progress is told of each.
///
/// # Errors
/// That of the first thing for which it fails, not of the first thread.
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

/// The same as a stage of its own, whose progress is told.
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
