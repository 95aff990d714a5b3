//! The output of a run: argmin's state, a row for each iteration, and the reason it ended.

use argmin::core::IterState;
use serde::{Deserialize, Serialize};

/// The argmin state of a run: its parameters and cost are the best vertex.
pub type State = IterState<Vec<f64>, (), (), (), (), f64>;

/// The step of an iteration, by MATLAB's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Procedure {
    /// Evaluated the start (iteration 0).
    #[serde(rename = "")]
    Start,
    /// Evaluated the other vertices of the first simplex (iteration 1).
    #[serde(rename = "initial simplex")]
    InitialSimplex,
    /// Accepted the reflected point, because it was good enough or because expanding it did not help.
    #[serde(rename = "reflect")]
    Reflect,
    /// Accepted the expanded point.
    #[serde(rename = "expand")]
    Expand,
    /// Accepted a point between the centroid and the worst vertex.
    #[serde(rename = "contract inside")]
    ContractInside,
    /// Accepted a point between the centroid and the reflected point.
    #[serde(rename = "contract outside")]
    ContractOutside,
    /// Moved all vertices halfway to the best one.
    #[serde(rename = "shrink")]
    Shrink,
}

impl Procedure {
    /// MATLAB's name: empty for the start, then `initial simplex`, `reflect`, `expand`, `contract inside`,
    /// `contract outside`, `shrink`.
    pub fn label(self) -> &'static str {
        match self {
            Self::Start => "",
            Self::InitialSimplex => "initial simplex",
            Self::Reflect => "reflect",
            Self::Expand => "expand",
            Self::ContractInside => "contract inside",
            Self::ContractOutside => "contract outside",
            Self::Shrink => "shrink",
        }
    }
}

impl std::fmt::Display for Procedure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.label())
    }
}

/// One line of the log: the state after an iteration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// 0 for the start, 1 for the initial simplex, then one for each step.
    pub iteration: u64,
    /// Evaluations of the objective so far.
    pub func_count: u64,
    /// The step of the iteration.
    pub procedure: Procedure,
    /// The best parameters so far, as the objective receives them (never scaled).
    pub best: Vec<f64>,
    /// The objective there.
    pub value: f64,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stop {
    /// The simplex is smaller than both tolerances.
    Converged,
    /// The number of iterations reached `MaxIter`.
    MaxIter,
    /// The number of evaluations reached `MaxFunEvals`.
    MaxFunEvals,
    /// `watch` ended the run before any of the other reasons applied.
    Interrupted,
}
