//! One contact between the damper and a wall, from touch-down to lift-off.
//!
//! A contact that is close to an undisturbed Hertz collision is solved as a whole, by collocation; any other is integrated step by
//! step in regularised time. Both are exact to `rtol` and locate the lift-off. Read `collocation` for the common contact,
//! `regularised` for the others.

pub mod collocation;
pub mod regularised;
