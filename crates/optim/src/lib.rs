//! Searches for the parameters that make an objective small.
//!
//! The methods receive a closure and know nothing of what it computes: no springs, no files, no clocks.
//! What happens on the way is told to the caller's observers; nothing is printed.
//!
//! - [`Grid`] and [`surf`]: the objective on every point of a grid, in parallel, with the same bytes at any
//!   number of threads; [`best_separated`] picks starts for a refinement from it.

pub mod grid;
pub mod surf;

pub use grid::{Axis, AxisError, Grid, GridError, Scale};
pub use surf::{best_separated, surf};
