//! MATLAB's `fminsearch`: the Nelder–Mead simplex method as Lagarias, Reeds, Wright & Wright (1998) state it,
//! "Convergence properties of the Nelder–Mead simplex method in low dimensions", SIAM J. Optim. 9(1), 112–147,
//! with MATLAB's initial simplex, stop test, names and order of arithmetic.
//! - The simplex starts at the given point and 5 % along each coordinate (0.00025 where it is zero).
//! - Points outside the box are not evaluated. They, and points where the objective is NaN or infinite (either sign), count as +∞: they are
//!   never accepted and push the simplex back.
//! - A run stops once the simplex is small in *both* x and value, or at MaxIter or MaxFunEvals iterations and evaluations. As in MATLAB the
//!   limits are checked between iterations, so the last one may exceed MaxFunEvals.

mod driver;
mod options;

pub use options::{Bounds, Error, Options, Scaling};

use std::cmp::Ordering;
use std::ops::ControlFlow;

/// Reflection ρ, expansion χ, contraction ψ and shrink σ (Lagarias et al. 1998, eq. 2.1 and after).
const RHO: f64 = 1.0;
const CHI: f64 = 2.0;
const PSI: f64 = 0.5;
const SIGMA: f64 = 0.5;
/// Step of the initial simplex along a coordinate, relative to it; and along a coordinate that is zero.
const STEP: f64 = 0.05;
const STEP_AT_ZERO: f64 = 0.00025;
/// Default limit of iterations, and of evaluations, for each coordinate.
const LIMIT_PER_COORDINATE: u64 = 200;

/// The step of an iteration, by MATLAB's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Procedure {
    /// Evaluated the start (iteration 0).
    Start,
    /// Evaluated the other vertices of the first simplex (iteration 1).
    InitialSimplex,
    /// Accepted the reflected point, because it was good enough or because expanding it did not help.
    Reflect,
    /// Accepted the expanded point.
    Expand,
    /// Accepted a point between the centroid and the worst vertex.
    ContractInside,
    /// Accepted a point between the centroid and the reflected point.
    ContractOutside,
    /// Moved all vertices halfway to the best one.
    Shrink,
}

/// MATLAB's name.
impl std::fmt::Display for Procedure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Start => "",
            Self::InitialSimplex => "initial simplex",
            Self::Reflect => "reflect",
            Self::Expand => "expand",
            Self::ContractInside => "contract inside",
            Self::ContractOutside => "contract outside",
            Self::Shrink => "shrink",
        })
    }
}

/// One line of the log: the state after an iteration.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// 0 for the start, 1 for the initial simplex, then one for each step.
    pub iteration: u64,
    /// Evaluations of the objective so far.
    pub func_count: u64,
    /// The step of the iteration.
    pub procedure: Procedure,
    /// The best parameters so far, as the objective receives them (never scaled).
    pub best: Vec<f64>,
    /// The objective there.
    pub value: f64,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum Stop {
    /// The simplex is smaller than both tolerances.
    Converged,
    /// The number of iterations reached `MaxIter`.
    MaxIter,
    /// The number of evaluations reached `MaxFunEvals`.
    MaxFunEvals,
    /// `watch` ended the run before any of the other reasons applied.
    Interrupted,
}

/// The best point of a run and how it was reached.
#[derive(Clone, Debug, PartialEq)]
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
/// As soon as it knows that the value exceeds `cutoff` it may stop and return any larger number instead, NaN and infinities included: the
/// run is the same to the last bit. A value of at most `cutoff` must be exact. `cutoff` is +∞ where the value is needed in any case.
///
/// `log` receives each [`Row`] as it is made and may end the run with [`ControlFlow::Break`]. A break on the row that ends the run anyway
/// keeps the reason of that row.
///
/// # Errors
/// Invalid options, a start that is empty or outside its bounds, or one where the objective is not finite: see [`Error`].
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
    log: impl FnMut(&Row) -> ControlFlow<()>,
) -> Result<Minimum, Error> {
    Fminsearch::new(start, options)?.run(objective, log)
}

/// An objective with a cutoff: see [`minimize`]. Dynamic, so that a search is compiled once: an evaluation takes far longer than a dynamic
/// call.
type Objective<'a> = &'a dyn Fn(&[f64], f64) -> f64;

/// The whole state of a run, which may be interrupted and continued.
#[derive(Clone, Debug, PartialEq)]
pub struct Fminsearch {
    options: Options,
    /// Parameters are the simplex's coordinates times these.
    scale: Vec<f64>,
    /// Only the start before the initial simplex is made, then n + 1 vertices from best to worst.
    simplex: Vec<Vertex>,
    iteration: u64,
    func_count: u64,
    procedure: Procedure,
}

/// A point and the value of the objective there.
#[derive(Clone, Debug, PartialEq)]
struct Vertex {
    /// Coordinates the simplex moves in: parameters over their scale.
    x: Vec<f64>,
    /// The objective: finite, or +∞ where it has no finite value. Never NaN.
    value: f64,
}

impl Fminsearch {
    /// A run from `start` (any unit, length n ≥ 1) that has evaluated nothing yet.
    ///
    /// # Errors
    /// See [`Error`].
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

    /// Iteration 0: evaluates the start, unless this run has begun already. Returns whether there is a new row.
    fn begin(&mut self, objective: Objective<'_>) -> Result<bool, Error> {
        if self.func_count > 0 {
            return Ok(false);
        }
        let value = objective(&self.parameters(&self.simplex[0].x), f64::INFINITY);
        if !value.is_finite() {
            return Err(Error::StartValue { value });
        }
        (self.simplex[0].value, self.func_count) = (value, 1);
        Ok(true)
    }

    /// One iteration.
    fn iterate(&mut self, objective: Objective<'_>) {
        let complete = self.simplex.len() > self.scale.len();
        self.procedure = if complete { self.step(objective) } else { self.make_simplex(objective) };
        // Equal values keep their order, so a new vertex comes after the one it ties with.
        self.simplex.sort_by(|a, b| a.value.partial_cmp(&b.value).unwrap_or(Ordering::Equal));
        self.iteration += 1;
    }

    /// The last row of the log.
    fn row(&self) -> Row {
        let Self { iteration, func_count, procedure, .. } = *self;
        let best = self.parameters(&self.simplex[0].x);
        Row { iteration, func_count, procedure, best, value: self.simplex[0].value }
    }

    /// The reason why this run ends here, if it does. The limits are tested before convergence, as in MATLAB.
    fn stop(&self) -> Option<Stop> {
        let n = self.scale.len();
        if self.simplex.len() <= n {
            return None; // the initial simplex is made regardless of the limits
        }
        let limit = LIMIT_PER_COORDINATE * n as u64;
        if self.func_count >= self.options.max_fun_evals.unwrap_or(limit) {
            Some(Stop::MaxFunEvals)
        } else if self.iteration >= self.options.max_iter.unwrap_or(limit) {
            Some(Stop::MaxIter)
        } else {
            self.has_converged().then_some(Stop::Converged)
        }
    }

    /// Whether both max|fᵢ − f₁| ≤ max(TolFun, 10·eps(f₁)) and max|vᵢ − v₁| ≤ max(TolX, 10·eps(max v₁)), over all vertices and
    /// coordinates, with MATLAB's `eps(x)`: the distance from |x| to the next larger double.
    fn has_converged(&self) -> bool {
        let eps = |x: f64| x.abs().next_up() - x.abs();
        let best = &self.simplex[0];
        let largest = best.x.iter().copied().fold(f64::NEG_INFINITY, f64::max); // MATLAB's max: signed
        let tol_fun = self.options.tol_fun.max(10.0 * eps(best.value));
        let tol_x = self.options.tol_x.max(10.0 * eps(largest));
        self.simplex[1..].iter().all(|vertex| {
            (vertex.value - best.value).abs() <= tol_fun
                && vertex.x.iter().zip(&best.x).all(|(v, v1)| (v - v1).abs() <= tol_x)
        })
    }

    /// The parameters at a point in the simplex's coordinates.
    fn parameters(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.scale).map(|(x, scale)| x * scale).collect()
    }

    /// The vertex at `x`: +∞ outside the box (without a call), and where the objective is not finite.
    fn vertex(&mut self, objective: Objective<'_>, x: Vec<f64>, cutoff: f64) -> Vertex {
        let parameters = self.parameters(&x);
        if !parameters.iter().enumerate().all(|(j, p)| self.options.bounds_of(j).contain(*p)) {
            return Vertex { x, value: f64::INFINITY };
        }
        self.func_count += 1;
        let value = objective(&parameters, cutoff);
        Vertex { x, value: if value.is_finite() { value } else { f64::INFINITY } }
    }

    /// Iteration 1: the start and one more vertex along each coordinate.
    fn make_simplex(&mut self, objective: Objective<'_>) -> Procedure {
        for j in 0..self.scale.len() {
            let mut x = self.simplex[0].x.clone();
            x[j] = stepped(x[j], self.scale[j], self.options.bounds_of(j));
            let vertex = self.vertex(objective, x, f64::INFINITY);
            self.simplex.push(vertex);
        }
        Procedure::InitialSimplex
    }

    /// One step of the method. Vertices are sorted: `simplex[0]` is the best, `simplex[n]` the worst.
    ///
    /// # Why the cutoffs do not change the result
    /// A value v above its cutoff may be returned as any v′ above it, and v′ must then lead to the same vertices:
    /// - *reflected* (cutoff: worst): v is compared with best ≤ second worst ≤ worst and kept only if below the second worst. Any number
    ///   above worst fails all three comparisons and leads to an inside contraction, which does not use v.
    /// - *expanded* and *outside* (cutoff: the reflected value): compared with the reflected value alone, kept only if below it, or at
    ///   most equal; any number above it is dropped.
    /// - *inside* (cutoff: worst): compared with worst alone, kept only if below it.
    ///
    /// None of the cutoffs could be lower: a value just below them affects a decision or is kept. The values of the initial simplex
    /// and of a shrink are all kept, so they have no cutoff.
    fn step(&mut self, objective: Objective<'_>) -> Procedure {
        let n = self.scale.len();
        let (best, second_worst) = (self.simplex[0].value, self.simplex[n - 1].value);
        let Vertex { x: worst_x, value: worst } = self.simplex[n].clone();
        let mean = |j: usize| self.simplex[..n].iter().map(|vertex| vertex.x[j]).sum::<f64>() / n as f64;
        let centroid: Vec<f64> = (0..n).map(mean).collect();
        // The point (1 + t)·x̄ − t·w on the line from the worst vertex w through the centroid x̄. With t = ρ, ρχ, ψρ this is MATLAB's
        // reflection, expansion and outside contraction as written there; with t = −ψ its inside contraction, to the last bit.
        let at = |t: f64| centroid.iter().zip(&worst_x).map(|(xbar, w)| (1.0 + t) * xbar - t * w).collect();

        let reflected = self.vertex(objective, at(RHO), worst);
        let (taken, procedure) = if reflected.value < best {
            let expanded = self.vertex(objective, at(RHO * CHI), reflected.value);
            if expanded.value < reflected.value {
                (expanded, Procedure::Expand)
            } else {
                (reflected, Procedure::Reflect)
            }
        } else if reflected.value < second_worst {
            (reflected, Procedure::Reflect)
        } else if reflected.value < worst {
            let outside = self.vertex(objective, at(PSI * RHO), reflected.value);
            if outside.value > reflected.value {
                return self.shrink(objective);
            }
            (outside, Procedure::ContractOutside)
        } else {
            let inside = self.vertex(objective, at(-PSI), worst);
            if inside.value >= worst {
                return self.shrink(objective);
            }
            (inside, Procedure::ContractInside)
        };
        self.simplex[n] = taken;
        procedure
    }

    /// Moves every vertex v halfway to the best one, to v₁ + σ·(v − v₁), and evaluates them again in their order.
    fn shrink(&mut self, objective: Objective<'_>) -> Procedure {
        for i in 1..self.simplex.len() {
            let ends = self.simplex[0].x.iter().zip(&self.simplex[i].x);
            let x = ends.map(|(v1, v)| v1 + SIGMA * (v - v1)).collect();
            self.simplex[i] = self.vertex(objective, x, f64::INFINITY);
        }
        Procedure::Shrink
    }
}

/// Coordinate `x` of the start moved for its vertex of the initial simplex: to (1 + 0.05) x, or to 0.00025 if it is
/// zero. If that is outside `bounds` (on the parameter `x · scale`) it steps the other way; if both are outside,
/// halfway to the farther bound.
fn stepped(x: f64, scale: f64, bounds: Bounds) -> f64 {
    let (there, back) =
        if x == 0.0 { (STEP_AT_ZERO, -STEP_AT_ZERO) } else { ((1.0 + STEP) * x, (1.0 - STEP) * x) };
    match bounds {
        _ if bounds.contain(there * scale) => there,
        Bounds { lower: Some(lower), upper: Some(upper) } if !bounds.contain(back * scale) => {
            let parameter = x * scale;
            let farther = if upper - parameter >= parameter - lower { upper } else { lower };
            (parameter + 0.5 * (farther - parameter)) / scale
        }
        _ => back,
    }
}
