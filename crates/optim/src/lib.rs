//! Searches for the parameters that minimise an objective.
//!
//! The methods receive a closure and do not depend on what it computes: no model, no files, no clocks. Only the objective,
//! [`DesignObjective`], knows the model: E1max, or another quantity, as a function of a design, at one frequency or the worst over a band.
//! Progress is reported to the caller's observers; nothing is printed.
//!
//! - [`Grid`] and [`surf()`]: the objective on every point of a grid, in parallel, with the same bytes at any
//!   number of threads; [`best_separated`] picks starts for a refinement from it.
//! - [`minimize`]: MATLAB's `fminsearch` (Lagarias et al. 1998); [`Fminsearch`] is the state of a run, which logs each
//!   iteration and can be continued.

mod chunks;
pub mod objective;
mod search;

pub use objective::band::{Band, worst_over};
pub use objective::descent::Foot;
pub use objective::design_objective::{Counts, DesignObjective, Failures};
pub use objective::ensemble::{Ensemble, MOST_MEMBERS, Statistic};
pub use objective::evaluation::{Evaluation, Place, Run};
pub use objective::limits::{INFEASIBLE, Limit, Limits, PerLimit, ranked, value_of};
pub use objective::motions::Known;
pub use objective::needs::{Need, Needs};
pub use objective::runs::Proceed;
pub use objective::spec::{FrequencyBand, Goal, Objective, Part, Response, StiffnessRange, Stiffnesses};
pub use objective::tmd::{TUNINGS, over_natural, springs_for};
pub use objective::unusable::Unusable;
pub use retune_model::{Design, Parameter};
pub use search::*;
