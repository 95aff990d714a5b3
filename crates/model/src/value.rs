//! Numbers within their range: one type for each range, checked once, when the value enters the program.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A value outside the range that its type allows.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{value} is not allowed here: give {allowed}")]
pub struct OutOfRange {
    /// The refused value.
    pub value: f64,
    /// The values that the type allows, in words.
    pub allowed: &'static str,
}

macro_rules! range_type {
    ($(#[$doc:meta])* $name:ident, $allowed:literal, $schema:tt, $valid:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize, JsonSchema)]
        #[serde(try_from = "f64", into = "f64")]
        #[schemars(with = "f64", extend $schema)]
        pub struct $name(f64);

        impl $name {
            /// Checks `value`.
            ///
            /// # Errors
            /// [`OutOfRange`] with the value and what is allowed.
            pub fn new(value: f64) -> Result<Self, OutOfRange> {
                let valid: fn(f64) -> bool = $valid;
                if valid(value) { Ok(Self(value)) } else { Err(OutOfRange { value, allowed: $allowed }) }
            }

            /// The number itself.
            pub const fn get(self) -> f64 {
                self.0
            }
        }

        impl TryFrom<f64> for $name {
            type Error = OutOfRange;
            fn try_from(value: f64) -> Result<Self, OutOfRange> {
                Self::new(value)
            }
        }

        impl From<$name> for f64 {
            fn from(value: $name) -> f64 {
                value.0
            }
        }
    };
}

range_type!(
    /// A finite number above zero: a mass, a Young's modulus, a radius.
    Positive, "a finite number above 0", ("exclusiveMinimum" = 0.0), |v| v.is_finite() && v > 0.0
);
range_type!(
    /// A finite number not below zero: a stiffness, a damping, a distance, a frequency, a time.
    NonNegative, "a finite number not below 0", ("minimum" = 0.0), |v| v.is_finite() && v >= 0.0
);
range_type!(
    /// A finite number of either sign: a position, a velocity.
    Finite, "a finite number", ("type" = "number"), f64::is_finite
);
range_type!(
    /// Poisson's ratio of an isotropic elastic solid, -1 < ν <= 0.5.
    PoissonRatio, "a number above -1 and at most 0.5", ("exclusiveMinimum" = -1.0, "maximum" = 0.5),
    |v| v > -1.0 && v <= 0.5
);
range_type!(
    /// A coefficient of restitution, 0 < e <= 1.
    Restitution, "a number above 0 and at most 1", ("exclusiveMinimum" = 0.0, "maximum" = 1.0),
    |v| v > 0.0 && v <= 1.0
);

impl Restitution {
    /// The restitution of a contact without loss.
    pub const ONE: Self = Self(1.0);
}

range_type!(
    /// The coefficient of restitution of an impact with a rigid wall, 0 <= e <= 1: at 0 there is no rebound.
    Bounce, "a number from 0 to 1", ("minimum" = 0.0, "maximum" = 1.0), |v| (0.0..=1.0).contains(&v)
);

impl Default for NonNegative {
    /// Zero.
    fn default() -> Self {
        Self(0.0)
    }
}

impl Default for Finite {
    /// Zero.
    fn default() -> Self {
        Self(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_values_out_of_range_are_refused() {
        for bad in [-1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(Positive::new(bad).is_err() && NonNegative::new(bad).is_err(), "{bad}");
        }
        assert!(Positive::new(0.0).is_err() && NonNegative::new(0.0).is_ok());
        assert!(
            PoissonRatio::new(0.5).is_ok()
                && PoissonRatio::new(0.51).is_err()
                && PoissonRatio::new(-1.0).is_err()
        );
    }
}
