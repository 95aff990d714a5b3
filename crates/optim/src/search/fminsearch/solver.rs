//! The state of a run and its iteration.

use super::log::{Procedure, Row, State, Stop};
use super::options::{Error, Options, Scaling};
use super::simplex::{self, Vertex};
use argmin::core::{Error as ArgminError, KV, Problem, Solver, TerminationReason, TerminationStatus};
use argmin::kv;

/// Reflection ρ, expansion χ, contraction ψ and shrink σ coefficients (Lagarias et al. 1998, eq. 2.1 and after).
const RHO: f64 = 1.0;
const CHI: f64 = 2.0;
const PSI: f64 = 0.5;
const SIGMA: f64 = 0.5;

/// Default limit of iterations, and of evaluations, for each coordinate.
const LIMIT_PER_COORDINATE: u64 = 200;

/// A run of `fminsearch`: an argmin solver for objectives `Fn(&[f64], cutoff: f64) -> f64`.
///
/// It holds everything a run needs to continue; see the [module](super).
#[derive(Clone, Debug, PartialEq)]
pub struct Fminsearch {
    pub(super) options: Options,
    /// Parameters are the simplex's coordinates times these.
    pub(super) scale: Vec<f64>,
    /// Only the start before the initial simplex is made, then n + 1 vertices from best to worst.
    pub(super) simplex: Vec<Vertex>,
    pub(super) iteration: u64,
    pub(super) func_count: u64,
    procedure: Procedure,
}

impl Fminsearch {
    /// A run from `start` (any unit, length n ≥ 1) that has evaluated nothing yet.
    ///
    /// # Errors
    /// An invalid tolerance, bound or coordinate, by name and value; see [`Error`].
    pub fn new(start: &[f64], options: Options) -> Result<Self, Error> {
        options.check(start)?;
        let scale: Vec<f64> = match options.scaling {
            Scaling::None => vec![1.0; start.len()],
            Scaling::Start => start.iter().map(|x| if *x == 0.0 { 1.0 } else { x.abs() }).collect(),
        };
        let x = start.iter().zip(&scale).map(|(x, scale)| x / scale).collect();
        let simplex = vec![Vertex { x, value: f64::INFINITY }];
        Ok(Self { options, scale, simplex, iteration: 0, func_count: 0, procedure: Procedure::Start })
    }

    /// The options of this run.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Whether the start has been evaluated.
    pub fn has_begun(&self) -> bool {
        self.func_count > 0
    }

    /// The last row of the log. Its value is +∞ before the start has been evaluated.
    pub fn row(&self) -> Row {
        let best = &self.simplex[0];
        Row {
            iteration: self.iteration,
            func_count: self.func_count,
            procedure: self.procedure,
            best: self.parameters(&best.x),
            value: best.value,
        }
    }

    /// The reason why this run ends here, if it does. The limits are tested before convergence, as in MATLAB.
    pub fn stop(&self) -> Option<Stop> {
        let n = self.scale.len();
        if self.simplex.len() <= n {
            return None; // the initial simplex is made regardless of the limits
        }
        let limit = LIMIT_PER_COORDINATE * n as u64;
        if self.func_count >= self.options.max_fun_evals.unwrap_or(limit) {
            Some(Stop::MaxFunEvals)
        } else if self.iteration >= self.options.max_iter.unwrap_or(limit) {
            Some(Stop::MaxIter)
        } else if simplex::converged(&self.simplex, self.options.tol_x, self.options.tol_fun) {
            Some(Stop::Converged)
        } else {
            None
        }
    }

    /// The parameters at a point in the simplex's coordinates.
    fn parameters(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.scale).map(|(x, scale)| x * scale).collect()
    }

    /// Calls the objective at any point and counts the evaluation.
    fn call<O>(
        &mut self,
        problem: &mut Problem<O>,
        parameters: &[f64],
        cutoff: f64,
    ) -> Result<f64, ArgminError>
    where
        O: Fn(&[f64], f64) -> f64,
    {
        self.func_count += 1;
        problem.problem("cost_count", |objective| Ok(objective(parameters, cutoff)))
    }

    /// The vertex at `x`: +∞ outside the box (without a call), and where the objective is not finite.
    fn vertex<O>(&mut self, problem: &mut Problem<O>, x: Vec<f64>, cutoff: f64) -> Result<Vertex, ArgminError>
    where
        O: Fn(&[f64], f64) -> f64,
    {
        let parameters = self.parameters(&x);
        let inside = parameters.iter().enumerate().all(|(j, p)| self.options.bounds_of(j).contain(*p));
        let value = if inside { self.call(problem, &parameters, cutoff)? } else { f64::INFINITY };
        Ok(Vertex { x, value: if value.is_finite() { value } else { f64::INFINITY } })
    }

    /// Iteration 1: the start and one more vertex along each coordinate.
    fn make_simplex<O>(&mut self, problem: &mut Problem<O>) -> Result<Procedure, ArgminError>
    where
        O: Fn(&[f64], f64) -> f64,
    {
        let start = self.simplex[0].x.clone();
        for (j, &scale) in self.scale.clone().iter().enumerate() {
            let mut x = start.clone();
            x[j] = super::start::stepped(x[j], scale, self.options.bounds_of(j));
            let vertex = self.vertex(problem, x, f64::INFINITY)?;
            self.simplex.push(vertex);
        }
        Ok(Procedure::InitialSimplex)
    }

    /// One step of the method. Vertices are sorted: `simplex[0]` is the best, `simplex[n]` the worst.
    ///
    /// # Why the cutoffs do not change the result
    /// A value v above its cutoff may be returned as any v′ above it, and v′ must then lead to the same vertices:
    /// - *reflected* (cutoff: worst): v is compared with best ≤ second worst ≤ worst and kept only if below the
    ///   second worst. Any number above worst fails all three comparisons and leads to an inside contraction, which does not use v.
    /// - *expanded* (cutoff: the reflected value) and *outside* (the same): compared with the reflected value alone,
    ///   kept only if below it, or at most equal; any number above it is dropped.
    /// - *inside* (cutoff: worst): compared with worst alone, kept only if below it.
    ///
    /// None of the cutoffs could be lower: a value just below them affects a decision or is kept. The values of the initial simplex
    /// and of a shrink are all kept, so they have no cutoff.
    fn step<O>(&mut self, problem: &mut Problem<O>) -> Result<Procedure, ArgminError>
    where
        O: Fn(&[f64], f64) -> f64,
    {
        let n = self.scale.len();
        let (best, second_worst) = (self.simplex[0].value, self.simplex[n - 1].value);
        let Vertex { x: worst_x, value: worst } = self.simplex[n].clone();
        let centroid = simplex::centroid(&self.simplex);
        let at = |t: f64| simplex::along(&centroid, &worst_x, t);

        let reflected = self.vertex(problem, at(RHO), worst)?;
        let (taken, procedure) = if reflected.value < best {
            let expanded = self.vertex(problem, at(RHO * CHI), reflected.value)?;
            if expanded.value < reflected.value {
                (expanded, Procedure::Expand)
            } else {
                (reflected, Procedure::Reflect)
            }
        } else if reflected.value < second_worst {
            (reflected, Procedure::Reflect)
        } else if reflected.value < worst {
            let outside = self.vertex(problem, at(PSI * RHO), reflected.value)?;
            if outside.value > reflected.value {
                return self.shrink(problem);
            }
            (outside, Procedure::ContractOutside)
        } else {
            let inside = self.vertex(problem, at(-PSI), worst)?;
            if inside.value >= worst {
                return self.shrink(problem);
            }
            (inside, Procedure::ContractInside)
        };
        self.simplex[n] = taken;
        Ok(procedure)
    }

    /// Moves every vertex halfway to the best one, and evaluates them again in their order.
    fn shrink<O>(&mut self, problem: &mut Problem<O>) -> Result<Procedure, ArgminError>
    where
        O: Fn(&[f64], f64) -> f64,
    {
        for i in 1..self.simplex.len() {
            let x = simplex::shrunk(&self.simplex[0].x, &self.simplex[i].x, SIGMA);
            self.simplex[i] = self.vertex(problem, x, f64::INFINITY)?;
        }
        Ok(Procedure::Shrink)
    }

    /// The last row in the form that argmin's observers read.
    fn report(&self, state: State) -> (State, Option<KV>) {
        let Row { iteration, func_count, procedure, best, value } = self.row();
        let log = kv!(
            "iteration" => iteration;
            "func_count" => func_count;
            "procedure" => procedure.label();
        );
        (state.param(best).cost(value), Some(log))
    }
}

impl<O> Solver<O, State> for Fminsearch
where
    O: Fn(&[f64], f64) -> f64,
{
    fn name(&self) -> &str {
        "fminsearch"
    }

    /// Iteration 0: evaluates the start, unless this run has already begun.
    fn init(&mut self, problem: &mut Problem<O>, state: State) -> Result<(State, Option<KV>), ArgminError> {
        if !self.has_begun() {
            let start = self.parameters(&self.simplex[0].x);
            let value = self.call(problem, &start, f64::INFINITY)?;
            if !value.is_finite() {
                self.func_count = 0;
                return Err(Error::StartValue { value }.into());
            }
            self.simplex[0].value = value;
        }
        Ok(self.report(state))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<O>,
        state: State,
    ) -> Result<(State, Option<KV>), ArgminError> {
        let complete = self.simplex.len() > self.scale.len();
        self.procedure = if complete { self.step(problem)? } else { self.make_simplex(problem)? };
        simplex::sort(&mut self.simplex);
        self.iteration += 1;
        Ok(self.report(state))
    }

    fn terminate(&mut self, _state: &State) -> TerminationStatus {
        match self.stop() {
            None => TerminationStatus::NotTerminated,
            Some(stop) => TerminationStatus::Terminated(match stop {
                Stop::Converged => TerminationReason::SolverConverged,
                Stop::MaxIter => TerminationReason::MaxItersReached,
                Stop::MaxFunEvals => {
                    TerminationReason::SolverExit("Maximum number of evaluations reached".into())
                }
                Stop::Interrupted => TerminationReason::Interrupt,
            }),
        }
    }
}
