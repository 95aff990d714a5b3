//! What a caller asks of a solver, and what it answers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An integration method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Exact linear flow between contacts, regularised Hertz contact: Retune's own and the default.
    Hybrid,
    /// Rosenbrock 2(3) of Shampine & Reichelt (1997), the paper's method.
    Ode23s,
    /// Dormand & Prince 5(4) (1980).
    Ode45,
    /// Bogacki & Shampine 3(2) (1989).
    Ode23,
    /// Dormand & Prince 8(5, 3), the code DOP853 of Hairer, Nørsett & Wanner (1993).
    Dop853,
    /// The classical Runge–Kutta method of order 4 at a fixed step.
    Rk4,
    /// Semi-implicit Euler at a fixed step, as in game physics.
    Euler,
}

impl Method {
    /// Every method.
    pub const ALL: [Method; 7] = [
        Method::Hybrid,
        Method::Ode23s,
        Method::Ode45,
        Method::Ode23,
        Method::Dop853,
        Method::Rk4,
        Method::Euler,
    ];

    /// Its name in studies, tables and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Hybrid => "hybrid",
            Method::Ode23s => "ode23s",
            Method::Ode45 => "ode45",
            Method::Ode23 => "ode23",
            Method::Dop853 => "dop853",
            Method::Rk4 => "rk4",
            Method::Euler => "euler",
        }
    }

    /// Whether the method takes equal steps, whatever the error.
    pub const fn has_fixed_step(self) -> bool {
        matches!(self, Method::Rk4 | Method::Euler)
    }
}

/// How a general-purpose method meets a contact. The hybrid always locates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Contacts {
    /// Touch-down and lift-off are located as events and steps end there.
    #[default]
    Located,
    /// Steps run over the kink of the force, as in the paper.
    Stepped,
}

/// How a run is integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The method.
    pub method: Method,
    /// How contacts are met by every method but the hybrid.
    pub contacts: Contacts,
    /// Relative tolerance of a step.
    pub rtol: f64,
    /// Absolute tolerance of a step, in the units of each component of the state (m, m/s). The hybrid needs none.
    pub atol: f64,
    /// Longest step, s, of every method but the hybrid (MATLAB's `MaxStep`); `None` for a tenth of the run. A method of fixed
    /// step takes this one; `None` for [`Settings::FIXED_STEP`].
    pub step: Option<f64>,
    /// Most steps a run may take before it is refused as [`SolverError::TooManySteps`].
    pub max_steps: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::Hybrid,
            contacts: Contacts::Located,
            rtol: 1e-10,
            atol: 1e-12,
            step: None,
            max_steps: 20_000_000,
        }
    }
}

impl Settings {
    /// Step of a method of fixed step that was given none, 1 ms.
    pub const FIXED_STEP: f64 = 1e-3;

    /// The longest step that a run to time `to` (s) may take.
    pub fn longest_step(&self, to: f64) -> f64 {
        match self.step {
            Some(step) => step.min(to),
            None if self.method.has_fixed_step() => Self::FIXED_STEP,
            None => 0.1 * to,
        }
    }
}

/// A span of time over which maxima are taken, `0 <= from < to`, s. Every run starts at rest at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Start t0 of the observation; the motion before it is a transient that counts for nothing.
    pub from: f64,
    /// End T of the run.
    pub to: f64,
}

/// A largest value and when it was reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// The time, s.
    pub time: f64,
}

/// The smallest model that was exact for a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SceneKind {
    /// No damper: one degree of freedom, exact flow.
    Bare,
    /// A damper that touched neither wall, checked on the trajectory: two degrees of freedom, exact flow.
    Linear,
    /// A damper that touched.
    Contact,
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Steps taken (of the hybrid: flight and contact steps).
    pub steps: u64,
    /// Steps tried and rejected.
    pub rejected: u64,
    /// Evaluations of a right-hand side (of the hybrid: of the contact equations; an exact flight step needs none).
    pub evaluations: u64,
}

/// What was observed in a window of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Largest energy of the primary structure, J.
    pub e1_max: Extreme,
    /// Largest energy of the damper, the paper's E2, J; zero without a damper.
    pub e2_max: Extreme,
    /// Touch-downs on the primary structure and on the obstacle.
    pub impacts: [u64; 2],
    /// Largest contact forces on the primary structure and on the obstacle, N.
    pub force_max: [f64; 2],
    /// Largest relative displacement `|x2 - x1|` of the damper, m: its place in the cavity.
    pub relative_displacement_max: f64,
    /// The stroke: largest spring deflection `|x2 - x1 - D|`, m.
    pub spring_deflection_max: f64,
    /// State at the end of the window: `[x1, v1, x2, v2]`, or `[x1, v1, 0, 0]` without a damper.
    pub final_state: [f64; 4],
    /// The smallest model that was exact for the whole run.
    pub scene: SceneKind,
    /// What the run cost.
    pub work: Work,
}

/// Why a run could not be finished. Every variant carries the time that was reached.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SolverError {
    /// A method that chooses its steps by their error had to choose one below the spacing of floating-point numbers. The hybrid
    /// has no such steps.
    #[error("the step became too small at t = {t} s (h = {h:e} s); loosen rtol, or choose the hybrid solver")]
    StepTooSmall {
        /// Time reached, s.
        t: f64,
        /// The step that was refused, s.
        h: f64,
    },
    /// The exact flow of the hybrid has a step that is lost to rounding at the end of the run.
    #[error(
        "the motion changes within {h:e} s, which is lost to rounding at t = {t} s; shorten T, or lower what is this fast: omega, \
         or a stiffness or damping for its mass"
    )]
    TooFast {
        /// A time of the run at which the step is lost, s.
        t: f64,
        /// The step, s.
        h: f64,
    },
    /// The hybrid found no step to follow a contact with: its force is lost to rounding beside others, or they beside it.
    #[error(
        "a contact at t = {t} s cannot be followed: its force and the other forces are too many orders of magnitude apart; \
         check R and the masses"
    )]
    Contact {
        /// Time reached, s.
        t: f64,
    },
    /// The run needs more steps than it may take.
    #[error("the run needed more than {limit} steps (t = {t} s); {}", fewer_steps(*.method))]
    TooManySteps {
        /// Time reached, s.
        t: f64,
        /// The limit.
        limit: u64,
        /// The method, on which it depends how a run takes fewer.
        method: Method,
    },
    /// The run would need many times the steps that it may take (see [`Budget`](crate::Budget)).
    #[error(
        "after {steps} steps the run has come to t = {t} s: at this rate it takes {needed:e} steps, and max_steps is {limit}; {}",
        fewer_steps(*.method)
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
        /// The method.
        method: Method,
    },
    /// A method of fixed step has left the finite numbers.
    #[error("the motion blows up at t = {t} s: a fixed step is too long for it; choose the hybrid solver")]
    Unstable {
        /// Time reached, s.
        t: f64,
    },
    /// The motion has more energy than the force can have given it, or its largest at a time that is not in the window.
    #[error(
        "the motion cannot be: an energy of {value:e} J at {time:e} s, in a run to t = {t} s whose force can give {most:e} J; \
         the parameters are too far apart to be computed"
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
        "a contact was missed in a run to t = {t} s: the damper is {depth:e} m inside a wall that it never touched; \
         please report this scene"
    )]
    Missed {
        /// End of the run, s.
        t: f64,
        /// How far inside it is, m.
        depth: f64,
    },
    /// The state overflowed.
    #[error(
        "the motion is no longer a finite number at t = {t} s; the parameters are beyond what can be computed"
    )]
    NonFinite {
        /// Time reached, s.
        t: f64,
    },
}

/// What makes a run take fewer steps. Those of the hybrid follow from the motion, fixed ones from T alone.
fn fewer_steps(method: Method) -> &'static str {
    match method {
        Method::Hybrid => {
            "shorten T, raise max_steps, or check for a mass, a stiffness or a force of the wrong size"
        }
        Method::Rk4 | Method::Euler => "shorten T, raise max_steps, or choose the hybrid solver",
        Method::Ode23s | Method::Ode45 | Method::Ode23 | Method::Dop853 => {
            "shorten T, raise max_steps, loosen rtol, or choose the hybrid solver"
        }
    }
}
