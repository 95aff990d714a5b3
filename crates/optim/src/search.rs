//! Searches for the minimum of a function of several parameters; they are independent of what it computes.

pub mod fminsearch;
pub mod global;
pub mod grid;
pub mod minimax;
pub mod space;
pub mod surf;
