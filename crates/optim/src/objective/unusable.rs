//! Why a design has no value.

use retune_model::{OutOfRange, Parameter, Unsettable};
use retune_solver::SolverError;
use thiserror::Error;

/// Why a design has no value.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Unusable {
    /// A parameter of the damper is out of range, or one that the damper does not have.
    #[error("{parameter}: {source}")]
    Value {
        /// The parameter.
        parameter: Parameter,
        /// Its value and what is allowed.
        source: Unsettable,
    },
    /// The stiffness k1 is out of range.
    #[error("k1: {0}")]
    Stiffness(OutOfRange),
    /// A member of an ensemble has a parameter out of range.
    #[error("a member of the ensemble: {0}")]
    Member(OutOfRange),
    /// The frequency of the force is out of range.
    #[error("omega: {0}")]
    Frequency(OutOfRange),
    /// The run could not be finished.
    #[error(transparent)]
    Run(#[from] SolverError),
    /// The motions of the design could not be found.
    #[error(transparent)]
    Motions(#[from] retune_dynamics::Error),
    /// The evaluation was stopped on the way.
    #[error("stopped before all of its runs were made")]
    Stopped,
    /// Derivatives of motions from other starts than rest, of a random motion or of a decay time were requested.
    #[error(
        "derivatives of the response \"motions\", of random motion and of decay times are not known: give a largest value, and the response \
         \"window\" or \"settled\""
    )]
    NoDerivatives,
    /// A random motion without a spread of its own.
    #[error(
        "its random motion never becomes stationary, or spreads without bound: give the structure damping, and the damper a spring"
    )]
    NotStationary,
    /// Its decay time is not within the run.
    #[error(
        "it has no decay time within the run: at the end, t = {to} s, its energy exceeds 5 % of its largest value; give a larger T"
    )]
    NotDecayed {
        /// The end of the run, s.
        to: f64,
    },
    /// There is no steady motion: a resonance is undamped.
    #[error(
        "it has no steady motion: nothing damps its resonance at omega = {omega} rad/s; give c1 or c2, or a band without it"
    )]
    Resonates {
        /// The frequency of the resonance, rad/s.
        omega: f64,
    },
    /// The steady motion reaches a wall, so that it is not linear.
    #[error(
        "the damper reaches a wall: its steady stroke at omega = {omega} rad/s is {stroke} m, of which D and C leave {room} m; \
         widen them, or look at a window of time instead of the steady response"
    )]
    Touches {
        /// Where the stroke is largest, rad/s.
        omega: f64,
        /// The stroke without walls, m.
        stroke: f64,
        /// The smaller of D and C, m.
        room: f64,
    },
}
