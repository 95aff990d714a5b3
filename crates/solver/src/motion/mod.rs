//! The pieces that every motion is made of.
//!
//! A method passes its motion on as smooth segments between two moments, and observers need bounds on how fast a quantity can change on
//! them. No file here knows a method or an observer. Read `knot`, then `segment`, then `form`; `linearised` is a contact for small changes;
//! `polynomial` and `lanes` hold the arithmetic.

pub mod form;
pub mod knot;
pub mod lanes;
pub mod linearised;
pub mod polynomial;
pub mod segment;
