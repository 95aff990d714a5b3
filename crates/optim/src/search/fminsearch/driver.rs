//! `fminsearch` as a solver of argmin, whose executor drives it.

use super::{Error, Fminsearch, Minimum, Objective, Row, Stop};
use argmin::core::{
    Error as ArgminError, Executor, IterState, KV, Problem, Solver, TerminationReason, TerminationStatus,
};
use std::ops::ControlFlow;

type Log<'a> = &'a mut dyn FnMut(&Row) -> ControlFlow<()>;
type State = IterState<Vec<f64>, (), (), (), (), f64>;

impl Fminsearch {
    /// Runs, or continues, until a stop test holds or `log` breaks; see [`minimize`](super::minimize) for both closures. After an interruption it can be
    /// run again to continue with the next row; the rows are those of an uninterrupted run.
    ///
    /// # Errors
    /// [`Error::StartValue`] where the objective is not finite at the start; the run is then unchanged.
    pub fn run(
        &mut self,
        objective: impl Fn(&[f64], f64) -> f64,
        mut log: impl FnMut(&Row) -> ControlFlow<()>,
    ) -> Result<Minimum, Error> {
        self.drive(&objective, &mut log)
    }

    fn drive(&mut self, objective: Objective<'_>, log: Log<'_>) -> Result<Minimum, Error> {
        let solver = Logged { run: self, log, interrupted: false };
        Executor::new(objective, solver)
            .ctrlc(false)
            .run()
            .map_err(|error| error.downcast().unwrap_or_else(|other| Error::Executor(other.to_string())))?;
        let Row { iteration: iterations, func_count, best: x, value, .. } = self.row();
        let stop = self.stop().unwrap_or(Stop::Interrupted);
        Ok(Minimum { x, value, iterations, func_count, stop, scaling: self.options.scaling })
    }
}

/// A run whose rows are logged.
struct Logged<'a> {
    run: &'a mut Fminsearch,
    log: Log<'a>,
    interrupted: bool,
}

impl Logged<'_> {
    /// Logs the last row, and returns it as argmin's state.
    fn report(&mut self, is_new: bool, state: State) -> (State, Option<KV>) {
        let row = self.run.row();
        if is_new {
            self.interrupted = (self.log)(&row).is_break();
        }
        (state.param(row.best).cost(row.value), None)
    }
}

impl<'a> Solver<Objective<'a>, State> for Logged<'_> {
    fn name(&self) -> &str {
        "fminsearch"
    }

    fn init(
        &mut self,
        problem: &mut Problem<Objective<'a>>,
        state: State,
    ) -> Result<(State, Option<KV>), ArgminError> {
        let is_new = problem.problem("iterations", |objective| Ok(self.run.begin(objective)?))?;
        Ok(self.report(is_new, state))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<Objective<'a>>,
        state: State,
    ) -> Result<(State, Option<KV>), ArgminError> {
        problem.problem("iterations", |objective| {
            self.run.iterate(objective);
            Ok(())
        })?;
        Ok(self.report(true, state))
    }

    fn terminate(&mut self, _state: &State) -> TerminationStatus {
        let stop = if self.interrupted { Some(Stop::Interrupted) } else { self.run.stop() };
        stop.map_or(TerminationStatus::NotTerminated, |stop| {
            TerminationStatus::Terminated(match stop {
                Stop::Converged => TerminationReason::SolverConverged,
                Stop::MaxIter => TerminationReason::MaxItersReached,
                Stop::MaxFunEvals => TerminationReason::SolverExit("MaxFunEvals".to_owned()),
                Stop::Interrupted => TerminationReason::Interrupt,
            })
        })
    }
}
