//! One contact, from touch-down to lift-off, in regularised time (equations: `retune_model::RegularisedContact`).
//!
//! The equations are polynomial there. Without loss they are followed in Taylor series (`series`), which observers search as polynomials.
//! With a loss or a strong dashpot, and for derivatives, by DOP853, which keeps its order through both ends of the contact: steps are
//! planned from the undisturbed Hertz collision, whose shape is the same for every speed, and the error estimate checks each. Lift-off is a
//! simple root of `q`: a step aimed at it and a last short one with `q` as the independent variable (M. Hénon, Physica D 5, 1982) reach it
//! without iteration. For these read `piece` (a stretch of a contact), `shared` (the cache of its observers), `plan` (lengths of steps),
//! then `integrate` (the loop).

pub mod integrate;
pub mod piece;
pub mod plan;
pub mod series;
pub mod shared;
