//! What motions there are, from outside of the crate.

mod attractor;
mod common;
mod dampers;
mod duffing;
mod lyapunov;
mod on_branches;
mod paper;
mod periodic;
mod regime;
mod sweep;
