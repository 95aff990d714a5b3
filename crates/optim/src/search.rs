//! Searches for the least value of a function of several parameters. They know nothing of what it computes.

pub mod fminsearch;
pub mod global;
pub mod grid;
pub mod space;
pub mod surf;
