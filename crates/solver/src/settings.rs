//! The choices of a caller: method, tolerances, window.

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

    /// Whether a motion by this method is exact but for rounding and the tolerance of its contacts.
    pub const fn is_exact(self) -> bool {
        matches!(self, Method::Hybrid)
    }

    /// Whether the method takes equal steps, whatever the error.
    pub const fn has_fixed_step(self) -> bool {
        matches!(self, Method::Rk4 | Method::Euler)
    }
}

/// Treatment of contacts by a general-purpose method. The hybrid always locates them.
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
    /// How every method but the hybrid treats contacts.
    pub contacts: Contacts,
    /// Relative tolerance of a step.
    pub rtol: f64,
    /// Absolute tolerance of a step, in the units of each component of the state (m, m/s). The hybrid needs none.
    pub atol: f64,
    /// Longest step, s, of every method but the hybrid (MATLAB's `MaxStep`); `None` for a tenth of the run. A fixed-step method takes this
    /// step; `None` for [`Settings::FIXED_STEP`].
    pub step: Option<f64>,
    /// Most steps a run may take, or a quarter as many evaluations (see [`Budget`](crate::Budget)), before it is aborted with
    /// [`SolverError::TooManySteps`](crate::SolverError::TooManySteps).
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
    /// Default step of a fixed-step method, 1 ms.
    pub const FIXED_STEP: f64 = 1e-3;

    /// These settings with the exact method.
    #[must_use]
    pub fn exact(self) -> Self {
        Self { method: Method::Hybrid, ..self }
    }

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
    /// Start t0 of the observation; the motion before it is a transient and is ignored.
    pub from: f64,
    /// End T of the run.
    pub to: f64,
}
