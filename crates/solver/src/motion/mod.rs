//! The pieces that every motion is made of.
//!
//! A method hands its motion over as smooth segments between two moments, and whoever looks at them needs bounds on how fast a
//! quantity can change there. Nothing in this room knows a method or an observer. Read `knot`, then `segment`, then `form`;
//! `polynomial` and `lanes` hold the arithmetic.

pub mod form;
pub mod knot;
pub mod lanes;
pub mod polynomial;
pub mod segment;
