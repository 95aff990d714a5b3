//! Searches and what they search, from outside of the crate.

mod band;
mod fminsearch;
mod global;
mod goal;
mod gradient;
mod grid;
mod interrupted;
mod limits;
mod minimax;
mod needs;
mod objective;
mod paper;
mod peaks;
mod pieces;
mod problems;
mod reference;
mod surf;
