//! The general methods: one file per method, and one loop for all of them.
//!
//! A method is a step with an error estimate and no loop (`step` has the contract); `onestep` takes the steps, and `located` ends
//! them at touch-downs. Read `step`, one short method (`ode45`), then `onestep`. `dop853` also serves the contacts of the hybrid.

pub mod dop853;
pub mod euler;
mod located;
pub mod ode23;
pub mod ode23s;
pub mod ode45;
pub mod onestep;
mod piece;
pub mod rk4;
pub mod step;

pub use dop853::Dop853;
pub use euler::Euler;
pub use ode23::Ode23;
pub use ode23s::Ode23s;
pub use ode45::Ode45;
pub use onestep::Run;
pub use rk4::Rk4;
pub use step::{Attempt, OneStep, POWERS, Tolerance};
