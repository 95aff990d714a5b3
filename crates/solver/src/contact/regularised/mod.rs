//! One contact, from touch-down to lift-off, in regularised time (equations: `retune_model::RegularisedContact`).
//!
//! The equations are polynomial there, so DOP853 keeps its order through both ends of the contact. Steps are planned from the
//! undisturbed Hertz collision, whose shape is the same for every speed, and the error estimate checks each. Lift-off is a
//! simple root of `q`: a step aimed at it and a last short one with `q` as the independent variable (M. Hénon, Physica D 5,
//! 1982) reach it without iteration.
//!
//! Read `piece` (a stretch of a contact), `shared` (what its observers share), `plan` (lengths of steps), then `integrate` (the loop).

pub mod integrate;
pub mod piece;
pub mod plan;
pub mod shared;
