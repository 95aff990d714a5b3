//! The values of a sweep, and why a motion could not be computed.

use retune_model::OutOfRange;
use retune_solver::SolverError;

/// Why a motion could not be computed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A value out of the parameter's range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// A run could not be finished.
    #[error(transparent)]
    Run(#[from] SolverError),
    /// A scene without a damper has no stroboscopic map here: its steady response is known in closed form.
    #[error("the scene has no damper: its steady response is known in closed form")]
    NoDamper,
    /// A constant force has no period.
    #[error("omega is 0: the force has no period to look at the motion by")]
    NoPeriod,
}

/// `count` evenly spaced values from `from` to `to`, both included. Each is computed from the ends, so that rounding errors do not
/// accumulate.
pub fn evenly(from: f64, to: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count).map(|i| from + (to - from) * (i as f64 / last)).collect()
}
