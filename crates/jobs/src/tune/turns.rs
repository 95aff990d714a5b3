//! Rows of runs that go on side by side, told one run after the other.

use crate::Error;
use retune_optim::Row;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

/// Whose turn it is: its rows are told as they come, those of later runs wait. Once a row cannot be told, all runs are to end.
pub struct Turns<T>(Mutex<State<T>>);

struct State<T> {
    tell: T,
    told: Result<(), Error>,
    /// The run whose rows are told.
    turn: usize,
    later: BTreeMap<usize, Later>,
}

/// What a run has to tell in its turn, and whether it has ended.
#[derive(Default)]
struct Later {
    rows: Vec<(Row, Vec<f64>)>,
    ended: bool,
}

impl<T: FnMut(usize, &Row, &[f64]) -> Result<(), Error>> Turns<T> {
    /// Runs 0, 1, …, of which `tell` hears as 1, 2, ….
    pub fn new(tell: T) -> Self {
        Self(Mutex::new(State { tell, told: Ok(()), turn: 0, later: BTreeMap::new() }))
    }

    /// A run has a row and its whole design to tell.
    pub fn tell(&self, run: usize, row: &Row, design: &[f64]) -> ControlFlow<()> {
        let state = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if run == state.turn {
            state.tell(row, design);
        } else {
            state.later.entry(run).or_default().rows.push((row.clone(), design.to_vec()));
        }
        if state.told.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }

    /// A run has ended: it is the turn of the next one that has not.
    pub fn end(&self, run: usize) {
        let state = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        state.later.entry(run).or_default().ended = true;
        while state.later.get(&state.turn).is_some_and(|run| run.ended) {
            state.turn += 1;
            let next = state.later.entry(state.turn).or_default();
            for (row, design) in std::mem::take(&mut next.rows) {
                state.tell(&row, &design);
            }
        }
    }

    /// Whether all could be told so far.
    pub fn all_told(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).told.is_ok()
    }

    /// The same, when all runs have ended.
    ///
    /// # Errors
    /// Why the first row that could not be told was not.
    pub fn check(self) -> Result<(), Error> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).told
    }
}

impl<T: FnMut(usize, &Row, &[f64]) -> Result<(), Error>> State<T> {
    fn tell(&mut self, row: &Row, design: &[f64]) {
        if self.told.is_ok() {
            self.told = (self.tell)(self.turn + 1, row, design);
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
        let mut told = Vec::new();
        let turns = Turns::new(|run, row, _| {
            told.push((run, row.iteration));
            Ok(())
        });
        for (run, iteration) in [(1, 0), (2, 0), (0, 0), (2, 1), (0, 1)] {
            assert!(turns.tell(run, &row(iteration), &[]).is_continue());
        }
        turns.end(1);
        assert!(turns.tell(0, &row(2), &[]).is_continue());
        turns.end(0);
        assert!(turns.tell(2, &row(2), &[]).is_continue());
        turns.end(2);
        turns.check().expect("told");
        assert_eq!(told, [(1, 0), (1, 1), (1, 2), (2, 0), (3, 0), (3, 1), (3, 2)]);
    }

    #[test]
    fn contract_a_row_that_cannot_be_told_ends_all_runs() {
        let turns = Turns::new(|_, row, _| match row.iteration {
            2 => Err(Error::Figure { name: "row 2".to_owned(), problem: String::new() }),
            3 => Err(Error::Figure { name: "row 3".to_owned(), problem: String::new() }),
            _ => Ok(()),
        });
        assert!(turns.tell(1, &row(1), &[]).is_continue());
        assert!(turns.tell(0, &row(2), &[]).is_break());
        assert!(turns.tell(1, &row(3), &[]).is_break());
        turns.end(0);
        assert!(matches!(turns.check(), Err(Error::Figure { name, .. }) if name == "row 2"));
    }
}
