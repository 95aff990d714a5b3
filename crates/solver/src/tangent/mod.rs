//! How a motion changes with its first state and with parameters, exactly: the variational equations of equation (1).
//!
//! The force of a contact and its slope vanish at touch-down and lift-off, so the right-hand side is continuously differentiable and
//! nothing jumps there: the equations hold through flight and contact alike, at fixed times (`docs/theory.md`, "Derivatives"). In flight
//! they are linear with constant coefficients (`flight`); over a contact that was computed at once they are the collocated equations,
//! differentiated (`collision`), and along one that is followed step by step an integral equation (`contact`). Impacts with rigid walls are
//! jumps, and so are their derivatives (`rigid`). [`Tangent`] follows a run as an observer and computes the derivatives piece by piece;
//! `gradient` has those of a largest value.

mod collision;
mod contact;
mod flight;
mod gradient;
mod observer;
mod rigid;
mod series;

pub(crate) use gradient::gradient_at;
pub use observer::{Tangent, Transition};
