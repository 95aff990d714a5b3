//! MATLAB's `fminsearch`: the Nelder–Mead simplex method as Lagarias, Reeds, Wright & Wright (1998) state it,
//! "Convergence properties of the Nelder–Mead simplex method in low dimensions", SIAM J. Optim. 9(1), 112–147,
//! with MATLAB's initial simplex, stop test, names and order of arithmetic.
//!
//! - The simplex starts at the given point and 5 % along each coordinate (0.00025 where it is zero).
//! - Points outside the box are not evaluated. They, and points where the objective is NaN or infinite (either
//!   sign), count as +∞: they are never accepted and push the simplex back.
//! - A run stops once the simplex is small in *both* x and value, or at MaxIter or MaxFunEvals iterations and
//!   evaluations. As in MATLAB the limits are checked between iterations, so the last one may exceed MaxFunEvals.
//! - The objective is given a cutoff and may stop early above it; see [`minimize`].
//!
//! # With argmin
//! [`Fminsearch`] is an [`argmin::core::Solver`] over [`State`]; [`minimize`] and [`Fminsearch::run`] drive it with
//! argmin's `Executor`. Observers of an `Executor` of your own receive the same rows: the parameters and cost of
//! the state are the best vertex, and the key-value store has `iteration`, `func_count` and `procedure`. They must
//! be `'static` and cannot end a run, which is why `run` has a `watch` closure instead: it may borrow and may break.
//!
//! # Interrupting a run
//! The solver is the whole state of a run: [`Fminsearch::run`] continues where `watch` broke it, and the rows are those of an uninterrupted run.
//! (In an `Executor` of your own the observers' `observe_init` sees the last row of a continued run again.)

mod log;
mod options;
mod simplex;
mod solver;
mod start;

pub use log::{Procedure, Row, State, Stop};
pub use options::{Bounds, Error, Options, Scaling};
pub use solver::Fminsearch;

use argmin::core::{
    Error as ArgminError, Executor, KV, Problem, Solver, TerminationReason, TerminationStatus,
};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// The best point of a run and how it was reached.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Minimum {
    /// The best parameters, as the objective receives them (never scaled).
    pub x: Vec<f64>,
    /// The objective there.
    pub value: f64,
    /// Iterations done, the initial simplex included.
    pub iterations: u64,
    /// Evaluations of the objective.
    pub func_count: u64,
    /// Why the run ended.
    pub stop: Stop,
    /// The coordinates the simplex moved in, and so the meaning of `tol_x`.
    pub scaling: Scaling,
}

/// Minimises `objective` from `start` with MATLAB's `fminsearch`.
///
/// `objective(parameters, cutoff)` returns the value at `parameters` (as many as `start`, in its order and units).
/// As soon as it knows that the value exceeds `cutoff` it may stop and return any larger number instead, NaN and
/// infinities included: the run is the same to the last bit. A value of at most `cutoff` must be exact. `cutoff` is
/// +∞ where the value is needed in any case.
///
/// `watch` receives each [`Row`] as it is made and may end the run with [`ControlFlow::Break`]. A break on the row that
/// ends the run anyway keeps the reason of that row.
///
/// # Errors
/// Invalid options, a start that is empty, not finite or outside its bounds ([`Fminsearch::new`]), or one where the
/// objective is not finite ([`Error::StartValue`]).
///
/// # Example
/// ```
/// use retune_optim::{Options, Stop, minimize};
/// use std::ops::ControlFlow;
///
/// let bowl = |x: &[f64], _cutoff: f64| (x[0] - 3.0).powi(2) + (x[1] + 1.0).powi(2);
/// let found = minimize(bowl, &[1.0, 1.0], Options::default(), |_row| ControlFlow::Continue(()))?;
/// assert_eq!(found.stop, Stop::Converged);
/// assert!((found.x[0] - 3.0).abs() < 1e-3 && (found.x[1] + 1.0).abs() < 1e-3);
/// # Ok::<(), retune_optim::Error>(())
/// ```
pub fn minimize(
    objective: impl Fn(&[f64], f64) -> f64,
    start: &[f64],
    options: Options,
    watch: impl FnMut(&Row) -> ControlFlow<()>,
) -> Result<Minimum, Error> {
    Fminsearch::new(start, options)?.run(objective, watch)
}

impl Fminsearch {
    /// Runs, or continues, until a stop test holds or `watch` breaks; see [`minimize`] for both closures.
    ///
    /// After an interruption the solver can be run again to continue with the next row.
    ///
    /// # Errors
    /// [`Error::StartValue`] where the objective is not finite at the start; the solver is then unchanged.
    pub fn run(
        &mut self,
        objective: impl Fn(&[f64], f64) -> f64,
        watch: impl FnMut(&Row) -> ControlFlow<()>,
    ) -> Result<Minimum, Error> {
        Executor::new(objective, Watched { solver: self, watch, broken: false })
            .ctrlc(false)
            .run()
            .map_err(|error| error.downcast().unwrap_or_else(|other| Error::Executor(other.to_string())))?;
        let Row { iteration, func_count, best, value, .. } = self.row();
        let stop = self.stop().unwrap_or(Stop::Interrupted);
        Ok(Minimum {
            x: best,
            value,
            iterations: iteration,
            func_count,
            stop,
            scaling: self.options().scaling,
        })
    }
}

/// A run that passes each new row to `watch` and ends once that breaks.
struct Watched<'a, W> {
    solver: &'a mut Fminsearch,
    watch: W,
    broken: bool,
}

impl<W: FnMut(&Row) -> ControlFlow<()>> Watched<'_, W> {
    fn tell(&mut self) {
        self.broken = (self.watch)(&self.solver.row()).is_break();
    }
}

impl<O, W> Solver<O, State> for Watched<'_, W>
where
    O: Fn(&[f64], f64) -> f64,
    W: FnMut(&Row) -> ControlFlow<()>,
{
    fn name(&self) -> &str {
        Solver::<O, State>::name(self.solver)
    }

    fn init(&mut self, problem: &mut Problem<O>, state: State) -> Result<(State, Option<KV>), ArgminError> {
        let fresh = !self.solver.has_begun();
        let answer = self.solver.init(problem, state)?;
        if fresh {
            self.tell();
        }
        Ok(answer)
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<O>,
        state: State,
    ) -> Result<(State, Option<KV>), ArgminError> {
        let answer = self.solver.next_iter(problem, state)?;
        self.tell();
        Ok(answer)
    }

    fn terminate(&mut self, state: &State) -> TerminationStatus {
        if self.broken {
            return TerminationStatus::Terminated(TerminationReason::Interrupt);
        }
        Solver::<O, State>::terminate(self.solver, state)
    }
}
