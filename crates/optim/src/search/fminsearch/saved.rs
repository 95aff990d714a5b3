//! Saving a run: serde for [`Fminsearch`], which refuses a file that is not the state of a run.

use super::solver::Fminsearch;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

impl Serialize for Fminsearch {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Fminsearch {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let saved = Self::deserialize(deserializer)?;
        saved.check().map_err(|what| D::Error::custom(format!("not a saved fminsearch run: {what}")))?;
        Ok(saved)
    }
}

impl Fminsearch {
    /// Checks the invariants of the solver.
    fn check(&self) -> Result<(), String> {
        let n = self.scale.len();
        let vertices = if self.iteration == 0 { 1 } else { n + 1 };
        if n == 0 || self.simplex.len() != vertices || self.simplex.iter().any(|vertex| vertex.x.len() != n) {
            return Err(format!(
                "{vertices} vertices of {n} coordinates expected at iteration {}",
                self.iteration
            ));
        }
        if !self.scale.iter().all(|scale| scale.is_finite() && *scale > 0.0) {
            return Err("a scale is not above zero".into());
        }
        if !self.simplex.iter().all(|vertex| vertex.x.iter().all(|x| x.is_finite())) {
            return Err("a coordinate is not finite".into());
        }
        if !self.simplex.is_sorted_by(|a, b| a.value <= b.value) {
            return Err("the vertices are not sorted by value".into());
        }
        if self.simplex[0].value.is_finite() != self.has_begun() {
            return Err("the best value does not match the number of evaluations".into());
        }
        self.options.check(&self.row().best).map_err(|error| error.to_string())
    }
}
