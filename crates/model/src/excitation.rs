//! The excitation: the harmonic force on the primary structure at a moment.

/// The harmonic force and its quarter-turn: `[P cos(ωt + φ), P sin(ωt + φ)]`, N.
///
/// The formulas of this crate take this pair instead of `t`, so that a caller who steps in time may turn it by a rotation instead
/// of calling `cos` at every step.
pub type Excitation = [f64; 2];
