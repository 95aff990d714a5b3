//! Searches for the parameters that make an objective small.
//!
//! The methods receive a closure and know nothing of what it computes: no springs, no files, no clocks. The one thing
//! here that knows of dampers is the closure itself, [`PeakEnergy`]: E1max as a function of a design, at one frequency or
//! the worst over a band.
//! What happens on the way is told to the caller's observers; nothing is printed.
//!
//! - [`Grid`] and [`surf()`]: the objective on every point of a grid, in parallel, with the same bytes at any
//!   number of threads; [`best_separated`] picks starts for a refinement from it.
//! - [`minimize`]: MATLAB's `fminsearch` (Lagarias et al. 1998) as an argmin solver, [`Fminsearch`], which logs
//!   each iteration and can be saved and continued.

pub mod band;
mod chunks;
pub mod ensemble;
pub mod fminsearch;
pub mod global;
pub mod goal;
pub mod grid;
pub mod limits;
pub mod objective;
pub mod space;
pub mod surf;

pub use band::{Band, worst_over};
pub use ensemble::{Ensemble, MOST_MEMBERS, Statistic};
pub use fminsearch::{Bounds, Error, Fminsearch, Minimum, Options, Procedure, Row, Scaling, Stop, minimize};
pub use global::{Basin, Descent, Global, GlobalError, Point, basins, explore};
pub use goal::{Evaluation, Frequencies, Goal, Place, Stiffnesses, Term, When};
pub use grid::{Axis, AxisError, Grid, GridError, Scale};
pub use limits::{INFEASIBLE, Limit, Limits, PerLimit, energy, ranked};
pub use objective::{Counts, Failures, PeakEnergy, Unusable, Variable, e1_max};
pub use space::{Side, Space};
pub use surf::{best_separated, surf, surf_part};
