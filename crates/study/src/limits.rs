//! The limits that a design must keep.

use super::Rule;
use retune_model::{NonNegative, Positive};
use retune_optim::{Limits, PerLimit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest values allowed. A design that breaks a limit is worse than any that keeps all; of two that do, the one that breaks
/// them by less (the sum of reached / limit - 1) is better.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LimitsGiven {
    /// The stroke: largest spring deflection |x2 - x1 - D| in any run of the objective, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stroke: Option<Positive>,
    /// Largest contact force on either wall in any run of the objective, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<Positive>,
    /// Largest D + C, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cavity: Option<Positive>,
    /// From when on stroke and force must keep their limits, s: 0, the default, for the whole run from rest on, t0 of `window` for
    /// the motion that E1max is taken from. A settled motion counts in any case, and in whole blocks. The steady response has no
    /// beginning: of it the limits hold for the steady motion alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<NonNegative>,
}

impl LimitsGiven {
    /// The limits as searches take them.
    pub fn limits(&self) -> Limits {
        let Self { stroke, force, cavity, from } = self;
        let most = PerLimit([stroke, force, cavity].map(|limit| limit.map(Positive::get)));
        Limits { most, from: from.map_or(0.0, NonNegative::get) }
    }

    /// Whether none is given.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Checks what serde cannot; `end` is that of the run, s.
    ///
    /// # Errors
    /// The [`Rule`] that is broken.
    pub(super) fn check(&self, end: f64) -> Result<(), Rule> {
        match self.from {
            Some(from) if from.get() >= end => Err(Rule::NotAllowed {
                field: "optimize.limits.from".to_owned(),
                value: from.get().to_string(),
                allowed: "a time before T of `window`, s",
            }),
            _ => Ok(()),
        }
    }
}
