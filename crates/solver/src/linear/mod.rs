//! The exact flow of a forced linear system, between contacts.
//!
//! A flight step is exact whatever its length, so it need only be short enough to detect a contact. Four steps are computed side by side.
//! Read `flow` (one step), then `steps` (steps as they are passed to observers), then `gap` (the first contact in a step), then `reduced`
//! (longer steps once a fast part of the motion has decayed), `pieces` and `uneven` (steps from sample to sample of a record).

pub mod flow;
pub mod gap;
pub mod pieces;
pub mod reduced;
pub mod steps;
mod uneven;
