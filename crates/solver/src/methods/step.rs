//! One step of a general method: the contract that every file beside this one fulfils.

use crate::system::System;

/// The result of one step of a method.
pub struct Attempt<const N: usize> {
    /// The solution at the end of the step.
    pub y: [f64; N],
    /// `f` there.
    pub slope: [f64; N],
    /// Estimate of the local error.
    pub error: [f64; N],
    /// Dense output: `y(t + s h) = y + h Σ p_j s^(j+1)`, `0 <= s <= 1`.
    pub dense: [[f64; N]; POWERS],
}

/// Powers of the step fraction in a dense output: those of DOP853.
pub const POWERS: usize = 7;

/// The cubic that meets value and slope `(y, f)` at both ends of a step, as a dense output.
pub fn hermite<const N: usize>(
    h: f64,
    (y, f): (&[f64; N], &[f64; N]),
    (end, slope): (&[f64; N], &[f64; N]),
) -> [[f64; N]; POWERS] {
    let mut dense = [[0.0; N]; POWERS];
    for i in 0..N {
        let chord = (end[i] - y[i]) / h;
        dense[0][i] = f[i];
        dense[1][i] = 3.0 * chord - 2.0 * f[i] - slope[i];
        dense[2][i] = f[i] + slope[i] - 2.0 * chord;
    }
    dense
}

/// The error estimate of a method that has none: zero, NaN where the state is not finite.
pub fn unknown_error<const N: usize>(end: &[f64; N]) -> [f64; N] {
    end.map(|v| 0.0 * v)
}

/// A one-step method with an embedded error estimate. It receives `f(t, y)` and returns `f` at the end of the step.
pub trait OneStep<const N: usize> {
    /// Exponent of the step control, one over the order of the error estimate's method plus one.
    const POWER: f64;
    /// Whether every step is the longest: the method has no error estimate.
    const FIXED: bool = false;
    /// Evaluations per step, the one at its start not counted.
    const EVALUATIONS: u64;
    /// Takes a step of length `h`; `None` if the method's equations have no solution there.
    fn attempt(system: &impl System<N>, t: f64, y: &[f64; N], f: &[f64; N], h: f64) -> Option<Attempt<N>>;
    /// The first step to try, given the longest that may be taken: MATLAB's, from `|y'|`, unless the method has its own.
    fn first_step(
        _system: &impl System<N>,
        _t: f64,
        y: &[f64; N],
        f: &[f64; N],
        tolerance: Tolerance,
        longest: f64,
    ) -> f64 {
        if Self::FIXED {
            return longest;
        }
        let rate = tolerance.norm(f, y, y) / (0.8 * tolerance.rtol.powf(Self::POWER));
        if longest * rate > 1.0 { 1.0 / rate } else { longest }
    }
}

/// MATLAB's tolerances: a component's error may be `rtol max(|y|, atol / rtol)`.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance over relative tolerance.
    pub threshold: f64,
}

impl Tolerance {
    /// `max_i |e_i| / max(|y_i|, |z_i|, threshold)`.
    pub fn norm<const N: usize>(self, e: &[f64; N], y: &[f64; N], z: &[f64; N]) -> f64 {
        (0..N).fold(0.0, |worst, i| {
            let ratio = e[i].abs() / y[i].abs().max(z[i].abs()).max(self.threshold);
            if ratio.is_nan() || ratio > worst { ratio } else { worst }
        })
    }
}
