//! Reports the rows of concurrent runs in the order of the runs.

use crate::Error;
use retune_optim::Row;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

/// Reports rows of the first unfinished run as they arrive and buffers those of later runs. After the first error nothing more is reported
/// and all runs are to stop.
pub struct OrderedReport<T>(Mutex<State<T>>);

struct State<T> {
    report: T,
    outcome: Result<(), Error>,
    /// The first unfinished run, whose rows are reported at once.
    current: usize,
    pending: BTreeMap<usize, Pending>,
}

/// The buffered rows of a run, and whether it has ended.
#[derive(Default)]
struct Pending {
    rows: Vec<(Row, Vec<f64>)>,
    ended: bool,
}

impl<T: FnMut(usize, &Row, &[f64]) -> Result<(), Error>> OrderedReport<T> {
    /// Runs are numbered from 0 here and from 1 in calls of `report`.
    pub fn new(report: T) -> Self {
        Self(Mutex::new(State { report, outcome: Ok(()), current: 0, pending: BTreeMap::new() }))
    }

    /// Reports or buffers a row of a run with its complete design.
    pub fn report(&self, run: usize, row: &Row, design: &[f64]) -> ControlFlow<()> {
        let state = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if run == state.current {
            state.report(row, design);
        } else {
            state.pending.entry(run).or_default().rows.push((row.clone(), design.to_vec()));
        }
        if state.outcome.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }

    /// Marks a run as ended and reports the buffered rows up to the next unfinished run.
    pub fn end(&self, run: usize) {
        let state = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        state.pending.entry(run).or_default().ended = true;
        while state.pending.get(&state.current).is_some_and(|run| run.ended) {
            state.current += 1;
            let next = state.pending.entry(state.current).or_default();
            for (row, design) in std::mem::take(&mut next.rows) {
                state.report(&row, &design);
            }
        }
    }

    /// Whether no report has failed so far.
    pub fn is_ok(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).outcome.is_ok()
    }

    /// Returns the outcome after all runs have ended.
    ///
    /// # Errors The error of the first report that failed.
    pub fn check(self) -> Result<(), Error> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).outcome
    }
}

impl<T: FnMut(usize, &Row, &[f64]) -> Result<(), Error>> State<T> {
    fn report(&mut self, row: &Row, design: &[f64]) {
        if self.outcome.is_ok() {
            self.outcome = (self.report)(self.current + 1, row, design);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use retune_optim::Procedure;

    fn row(iteration: u64) -> Row {
        Row { iteration, func_count: 1, procedure: Procedure::Start, best: vec![0.0], value: 1.0 }
    }

    #[test]
    fn contract_rows_of_runs_side_by_side_are_told_run_after_run() {
        let mut reported = Vec::new();
        let ordered = OrderedReport::new(|run, row, _| {
            reported.push((run, row.iteration));
            Ok(())
        });
        for (run, iteration) in [(1, 0), (2, 0), (0, 0), (2, 1), (0, 1)] {
            assert!(ordered.report(run, &row(iteration), &[]).is_continue());
        }
        ordered.end(1);
        assert!(ordered.report(0, &row(2), &[]).is_continue());
        ordered.end(0);
        assert!(ordered.report(2, &row(2), &[]).is_continue());
        ordered.end(2);
        ordered.check().expect("told");
        assert_eq!(reported, [(1, 0), (1, 1), (1, 2), (2, 0), (3, 0), (3, 1), (3, 2)]);
    }

    #[test]
    fn contract_a_row_that_cannot_be_told_ends_all_runs() {
        let ordered = OrderedReport::new(|_, row, _| match row.iteration {
            2 => Err(Error::Figure { name: "row 2".to_owned(), problem: String::new() }),
            3 => Err(Error::Figure { name: "row 3".to_owned(), problem: String::new() }),
            _ => Ok(()),
        });
        assert!(ordered.report(1, &row(1), &[]).is_continue());
        assert!(ordered.report(0, &row(2), &[]).is_break());
        assert!(ordered.report(1, &row(3), &[]).is_break());
        ordered.end(0);
        assert!(matches!(ordered.check(), Err(Error::Figure { name, .. }) if name == "row 2"));
    }
}
