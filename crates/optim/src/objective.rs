//! The objective of a damper's design.
//!
//! Read `spec` (the specification in a study), `evaluate` (its value for a scene), then its parts: `band` (the worst over
//! frequencies), `ensemble` (a statistic over small errors), `limits`; `pieces`, its derivatives; and `peak_energy`, the function that searches call.

pub mod band;
pub mod ensemble;
pub mod evaluate;
pub mod evaluation;
pub mod limits;
mod motions;
pub mod peak_energy;
pub mod pieces;
pub mod spec;
pub mod unusable;
