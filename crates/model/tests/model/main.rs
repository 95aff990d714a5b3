//! The physics from outside of the crate.

mod band;
mod band_hunt;
mod bounds;
mod catalogue;
mod derivatives;
mod energies;
mod histories;
mod mode;
mod overdamped;
mod regularised;
mod sensitivity;
mod series;
mod stationary;
mod steady;
