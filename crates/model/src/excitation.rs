//! The force at a moment, and a stretch of time without jumps of it.

/// The harmonic force and its quarter-turn: `[P cos(ωt + φ), P sin(ωt + φ)]`, N.
///
/// The formulas of this crate take this pair instead of `t`, so that a caller who steps in time may advance it by a rotation instead
/// of calling `cos` at every step. For a [`History`](crate::History) it is `[f, -(df/dt) / ω]`.
pub type Excitation = [f64; 2];

/// A stretch of time between two jumps of the pair, with the pair at its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Its start, s.
    pub from: f64,
    /// Its end, s; infinite if nothing changes any more.
    pub to: f64,
    /// `[f, -(df/dt) / ω]` at its start.
    pub begin: Excitation,
}
