//! Whether a motion repeats.
//!
//! Read `section` (the states of a run once per period of the force), `test` (whether they return), then `repeats`, which ends a run whose
//! motion does.

pub mod repeats;
pub mod section;
pub mod test;
