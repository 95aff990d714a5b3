//! A moment of the motion, and how it changes there.

use retune_model::Excitation;

/// A moment of the motion.
#[derive(Clone, Copy, Debug)]
pub struct Knot<const N: usize> {
    /// Time, s.
    pub t: f64,
    /// `[P cos ωt, P sin ωt]`, N.
    pub excitation: Excitation,
    /// State.
    pub y: [f64; N],
    /// `[dt/dθ, d²t/dθ²]`, the rate of time in the coordinate in which the segment is smooth; `[1, 0]` where that is time itself.
    pub clock: [f64; 2],
}

/// The time derivatives of a motion at a moment.
#[derive(Clone, Copy, Debug)]
pub struct Jet<const N: usize> {
    /// The deviation from the origin and its first three time derivatives.
    pub states: [[f64; N]; 4],
    /// The force and its first two, N, N/s, N/s².
    pub force: [f64; 3],
}
