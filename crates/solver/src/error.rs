//! Why a run could not be finished, and the remedy.

use std::fmt;

/// Why a run could not be finished. Every variant carries the time that was reached.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SolverError {
    /// A method that chooses its steps by their error had to choose one below the spacing of floating-point numbers. The hybrid
    /// has no such steps.
    #[error("the step became too small at t = {} s (h = {h:.1e} s); choose the hybrid solver", plain(*.t))]
    StepTooSmall {
        /// Time reached, s.
        t: f64,
        /// The step that was refused, s.
        h: f64,
    },
    /// The exact flow of the hybrid has a step that is lost to rounding at the end of the run.
    #[error("the motion changes within {h:.1e} s, which is lost to rounding at t = {} s; {remedy}", plain(*.t))]
    TooFast {
        /// A time of the run at which the step is lost, s.
        t: f64,
        /// The step, s.
        h: f64,
        /// The remedy.
        remedy: Remedy,
    },
    /// The hybrid found no step for a contact: the contact force is lost to rounding relative to the other forces, or vice versa.
    #[error(
        "a contact at t = {} s cannot be followed: its stiffness is too many orders of magnitude from that of the springs; \
         check what it is made of: R, q, E1 to E4", plain(*.t)
    )]
    Contact {
        /// Time reached, s.
        t: f64,
    },
    /// The run needs more steps than it may take.
    #[error(
        "the run needed more than {} (t = {} s); raise max_steps",
        match evaluations {
            None => format!("{limit} steps"),
            Some(most) => format!("{most} evaluations of its equations and quantities, the most with max_steps = {limit}"),
        },
        plain(*.t)
    )]
    TooManySteps {
        /// Time reached, s.
        t: f64,
        /// The limit.
        limit: u64,
        /// The limit on evaluations that follows from it, if that was exceeded (see [`Budget`](crate::Budget)).
        evaluations: Option<u64>,
    },
    /// The run would need many times the steps that it may take (see [`Budget`](crate::Budget)).
    #[error(
        "after {steps} steps the run has come to t = {} s: at this rate it takes {needed:.1e} steps, and max_steps is {limit}; \
         {remedy}", plain(*.t)
    )]
    TooSlow {
        /// Time reached, s.
        t: f64,
        /// Steps taken.
        steps: u64,
        /// Steps that the run would take at this rate; infinite if it does not move at all.
        needed: f64,
        /// The limit.
        limit: u64,
        /// The remedy.
        remedy: Remedy,
    },
    /// The motion of a fixed-step method has grown beyond the finite numbers.
    #[error("the motion blows up at t = {} s: a fixed step is too long for it; choose the hybrid solver", plain(*.t))]
    Unstable {
        /// Time reached, s.
        t: f64,
    },
    /// The motion has more energy than the force can have supplied, or its maximum lies outside the window.
    #[error(
        "the motion cannot be: an energy of {} J at {} s, in a run to t = {} s whose force can give {} J; \
         its digits are lost: the parameters are too far apart, or rtol, atol or the step do not suit them", plain(*.value), plain(*.time), plain(*.t), plain(*.most)
    )]
    Implausible {
        /// End of the run, s.
        t: f64,
        /// Largest energy of the structure or the damper as computed, J.
        value: f64,
        /// When it was reached, as computed, s.
        time: f64,
        /// The most that it can have, (P t)²/(2 m1), J.
        most: f64,
    },
    /// The damper was inside a wall that it never touched.
    #[error(
        "a contact was missed in a run to t = {} s: the damper is {depth:e} m inside a wall that it never touched; \
         please report this scene", plain(*.t)
    )]
    Missed {
        /// End of the run, s.
        t: f64,
        /// Its depth inside the wall, m.
        depth: f64,
    },
    /// A general method met rigid walls, whose impacts are jumps.
    #[error(
        "only the hybrid solver follows impacts with rigid walls: choose it, or give the walls Hertz's surfaces"
    )]
    RigidWalls {
        /// Start of the run, s.
        t: f64,
    },
    /// A motion that grazes a rigid wall has no derivative.
    #[error(
        "the motion has no derivative: at t = {} s the damper touches a rigid wall at almost no speed, and with a little less motion it does \
         not strike it", plain(*.t)
    )]
    Grazing {
        /// When it does, s.
        t: f64,
    },
    /// A pulse or a record has no period.
    #[error(
        "a pulse or a record has no period, and its motion no settled response: ask for the largest values in a window"
    )]
    NoPeriod {
        /// Start of the run, s.
        t: f64,
    },
    /// The derivatives of a motion under a pulse or a record are not taken.
    #[error("derivatives are not taken under a pulse or a record: search without them")]
    NoDerivatives {
        /// Start of the run, s.
        t: f64,
    },
    /// The state overflowed.
    #[error(
        "the motion is no longer a finite number at t = {} s; the parameters are beyond what can be computed", plain(*.t)
    )]
    NonFinite {
        /// Time reached, s.
        t: f64,
    },
}

impl SolverError {
    /// The time that was reached, s.
    pub fn time(&self) -> f64 {
        match *self {
            Self::StepTooSmall { t, .. }
            | Self::TooFast { t, .. }
            | Self::Contact { t }
            | Self::TooManySteps { t, .. }
            | Self::TooSlow { t, .. }
            | Self::Unstable { t }
            | Self::Implausible { t, .. }
            | Self::RigidWalls { t }
            | Self::Grazing { t }
            | Self::NoPeriod { t }
            | Self::NoDerivatives { t }
            | Self::Missed { t, .. }
            | Self::NonFinite { t } => t,
        }
    }
}

/// A number in the fewest digits that read back to the same value, with a power of ten where it is very large or small.
fn plain(value: f64) -> String {
    if value == 0.0 || (1e-4..1e7).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

/// The change that would let a run finish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// The run is too long, not its steps too short.
    ShorterRun,
    /// The fastest rate sets the flight step: ω, or a stiffness or a damping over a mass, in the symbols of a study file.
    Slower(&'static str),
    /// Most steps are those of contacts.
    LessForce,
    /// General methods take more steps than the hybrid, whose own error names the cause if it cannot finish either.
    Hybrid,
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Remedy::ShorterRun => write!(f, "shorten T"),
            Remedy::Slower(fastest) => write!(f, "lower {fastest}, which makes the motion this fast"),
            Remedy::LessForce => write!(f, "lower P: nearly all steps are those of contacts"),
            Remedy::Hybrid => write!(f, "choose the hybrid solver"),
        }
    }
}
