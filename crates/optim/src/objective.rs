//! What a damper is judged by.
//!
//! Read `spec` (what a study asks for), `evaluate` (its value for a scene), then what that is made of: `band` (the worst over
//! frequencies), `ensemble` (a statistic over small errors), `limits`; and `peak_energy`, the function of a design that searches call.

pub mod band;
pub mod ensemble;
pub mod evaluate;
pub mod limits;
pub mod peak_energy;
pub mod spec;
pub mod unusable;
