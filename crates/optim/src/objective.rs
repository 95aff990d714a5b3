//! The objective of a damper's design.
//!
//! Read `spec` (the specification in a study), `evaluate` (its value for a scene: an `evaluation`), then its parts: `band` (the worst
//! over frequencies), `ensemble` (a statistic over small errors), `limits`; `design_objective`, the function that searches call; its
//! derivatives, `gradient` (of the value) and `pieces` (of each of the peaks whose largest it is), used by a `descent`; and `tmd`, the
//! starts of searches for the best TMD. `needs` has the largest value of every measure.

pub mod band;
pub mod descent;
pub mod design_objective;
pub mod ensemble;
pub mod evaluate;
pub mod evaluation;
pub mod gradient;
pub mod limits;
pub mod motions;
pub mod needs;
pub mod pieces;
pub mod runs;
pub mod spec;
pub mod tmd;
pub mod unusable;
