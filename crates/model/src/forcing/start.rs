//! Where a motion starts.

use crate::Finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A state at t = 0, SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Start {
    /// x1, displacement of the structure, m.
    pub x1: Finite,
    /// v1, its velocity, m/s.
    pub v1: Finite,
    /// x2, position of the damper, m; x1 + D if left out, where its spring is at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x2: Option<Finite>,
    /// v2, its velocity, m/s.
    pub v2: Finite,
}

impl Start {
    /// The state `[x1, v1, x2, v2]` (m, m/s) of a damper that is at the distance `rest` (m) from the structure where its spring is at rest.
    pub fn state(&self, rest: f64) -> [f64; 4] {
        let Self { x1, v1, x2, v2 } = self;
        [x1.get(), v1.get(), x2.map_or(x1.get() + rest, Finite::get), v2.get()]
    }
}
