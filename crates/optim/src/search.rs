//! Searches for the minimum of any function of several parameters.

pub(crate) mod fminsearch;
pub(crate) mod global;
pub(crate) mod grid;
pub(crate) mod minimax;
pub(crate) mod space;
pub(crate) mod surf;

pub use fminsearch::{Bounds, Error, Fminsearch, Minimum, Options, Procedure, Row, Scaling, Stop, minimize};
pub use global::{Basin, Descent, Global, GlobalError, Point, basins, explore};
pub use grid::{Axis, AxisError, Grid, GridError, Scale};
pub use minimax::{Height, Piece, minimax};
pub use space::{Side, Space};
pub use surf::{best_separated, best_separated_above, surf, surf_part};
