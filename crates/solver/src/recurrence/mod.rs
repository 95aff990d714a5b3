//! Whether a motion repeats.
//!
//! Read `section` (the states of a run once per period of the force), `test` (whether they return), `limit` (the motion that they converge
//! to) and `ahead` (where the run will be), then `repeats`, which ends a run whose motion repeats or will.

pub mod ahead;
pub mod limit;
pub mod repeats;
pub mod section;
pub mod test;
