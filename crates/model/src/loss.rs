//! The loss of a contact: a factor on Hertz's force, never below zero (`docs/theory.md`, "Contacts that lose energy").
//!
//! Hunt and Crossley: `1 + λ ż`, with one λ. K. H. Hunt and F. R. E. Crossley, Coefficient of restitution interpreted as damping in
//! vibroimpact, J. Appl. Mech. 42 (1975) 440. With the same restitution at every speed: see [`Restoring`].

mod collision;
mod remainder;
mod restoring;

pub(crate) use restoring::Factor;
pub use restoring::Restoring;

use collision::{chi, langevin};
use std::sync::Arc;

use crate::{NonNegative, OutOfRange, Positive, Restitution};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The loss of a contact; none by default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "InFile", into = "InFile")]
#[schemars(with = "InFile")]
pub enum Loss {
    /// λ, s/m; 0 without loss.
    Damping(NonNegative),
    /// e, the restitution of an undisturbed collision at any speed; 1 without loss.
    Restoring(Restitution),
}

impl Default for Loss {
    fn default() -> Self {
        Self::Damping(NonNegative::default())
    }
}

/// What a contact loses. Give `lambda` for the law of Hunt and Crossley, by which the force is K z^1.5 (1 + lambda dz/dt), never below 0; or
/// `restitution` and `at`, the impact speed at which that law has it; or `restitution` alone, for the same at every speed.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Loss", extend("oneOf" = [{ "required": ["lambda"] }, { "required": ["restitution"] }], "dependentRequired" = {
    "at": ["restitution"]
}))]
struct InFile {
    /// lambda, damping factor of the contact force, s/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lambda: Option<NonNegative>,
    /// restitution, restitution of a contact at every speed: that of an undisturbed collision; where `at` is given, at that speed alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    restitution: Option<Restitution>,
    /// The impact speed at which the restitution holds, m/s; left out, it holds at every speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    at: Option<Positive>,
}

/// Why the fields of a file do not describe a loss.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
enum Refused {
    #[error("give `lambda` (s/m) or `restitution`, not both")]
    Both,
    #[error(
        "empty: give `lambda` (s/m), or `restitution`, which holds at every speed or at the impact speed `at` (m/s)"
    )]
    Neither,
    #[error("missing field `restitution`: speed after over speed before a collision at the speed `at`")]
    NoRestitution,
    #[error("no `lambda` gives this restitution at this speed: {0}")]
    OutOfRange(#[from] OutOfRange),
}

impl TryFrom<InFile> for Loss {
    type Error = Refused;

    fn try_from(InFile { lambda, restitution, at }: InFile) -> Result<Self, Refused> {
        match (lambda, restitution, at) {
            (Some(lambda), None, None) => Ok(Self::Damping(lambda)),
            (None, Some(restitution), Some(at)) => Ok(Self::restoring_at(restitution, at)?),
            (None, Some(restitution), None) => Ok(Self::Restoring(restitution)),
            (Some(_), ..) => Err(Refused::Both),
            (None, None, None) => Err(Refused::Neither),
            (None, None, Some(_)) => Err(Refused::NoRestitution),
        }
    }
}

impl From<Loss> for InFile {
    fn from(loss: Loss) -> Self {
        let none = Self { lambda: None, restitution: None, at: None };
        match loss {
            Loss::Damping(lambda) => Self { lambda: Some(lambda), ..none },
            Loss::Restoring(restitution) => Self { restitution: Some(restitution), ..none },
        }
    }
}

impl Loss {
    /// The law of Hunt and Crossley with this restitution `e` of an undisturbed collision at the touch-down speed `at`: `λ = χ(e) / v`.
    ///
    /// # Errors
    /// λ is beyond the numbers.
    pub fn restoring_at(restitution: Restitution, at: Positive) -> Result<Self, OutOfRange> {
        Ok(Self::Damping(NonNegative::new(chi(restitution.get()) / at.get())?))
    }

    /// The restitution of an undisturbed collision at a touch-down speed, m/s.
    pub fn restitution(self, speed: f64) -> f64 {
        let chi = match self {
            Self::Restoring(e) => return e.get(),
            Self::Damping(lambda) => lambda.get() * speed,
        };
        if chi > 40.0 {
            return 1.0 / chi; // coth a is 1 to rounding
        }
        let excess = |e: f64| langevin(0.5 * chi * (1.0 + e)) - (1.0 - e) / (1.0 + e);
        let (mut lower, mut upper) = (0.0, 1.0);
        if excess(upper) <= 0.0 {
            return upper;
        }
        for _ in 0..100 {
            let middle = 0.5 * (lower + upper);
            if excess(middle) < 0.0 { lower = middle } else { upper = middle }
        }
        upper
    }

    /// Whether nothing is lost.
    pub fn is_none(&self) -> bool {
        match self {
            Self::Damping(lambda) => lambda.get() == 0.0,
            Self::Restoring(e) => e.get() == 1.0,
        }
    }
}

/// How far below zero rounding may bring `1 + λ w` where the force ends.
const ROUNDING: f64 = 1e-9;

/// The law of a contact's loss in the equations of motion.
#[derive(Clone, Debug)]
pub(crate) enum Law {
    /// `1 + λ w`; zero where that would pull.
    Damping(f64),
    Restoring(Arc<Restoring>),
}

impl From<Loss> for Law {
    fn from(loss: Loss) -> Self {
        match loss {
            Loss::Damping(lambda) => Self::Damping(lambda.get()),
            Loss::Restoring(e) if e.get() == 1.0 => Self::Damping(0.0),
            Loss::Restoring(e) => Self::Restoring(Restoring::of(e.get())),
        }
    }
}

impl Law {
    pub(crate) const NONE: Self = Self::Damping(0.0);

    pub(crate) fn is_lossy(&self) -> bool {
        !matches!(self, Self::Damping(0.0))
    }

    /// The factor at a rate of indentation `w` (m/s) and `s`, `S = (2/5) κ z^(5/2)` (m²/s²) with `κ = K (1/m1 + 1/m2)`, half of the square of
    /// the touch-down speed of an undisturbed collision without loss that reaches `z`. Where `1 + λ w = 0` to rounding, the slope is that
    /// of the side on which the force acts.
    #[inline]
    pub(crate) fn factor(&self, s: impl FnOnce() -> f64, w: f64) -> Factor {
        match self {
            Self::Damping(lambda) => {
                let f = 1.0 + lambda * w;
                if f > -ROUNDING {
                    Factor { f: f.max(0.0), by_w: *lambda, ..Factor::default() }
                } else {
                    Factor::default()
                }
            }
            Self::Restoring(law) => law.factor(s(), w),
        }
    }

    /// The derivative of the factor by the law's parameter, λ or e.
    pub(crate) fn by_parameter(&self, s: impl FnOnce() -> f64, w: f64) -> f64 {
        match self {
            Self::Damping(lambda) if 1.0 + lambda * w > -ROUNDING => w,
            Self::Damping(_) => 0.0,
            Self::Restoring(law) => law.by_restitution(s(), w),
        }
    }

    /// A bound on the factor at rates up to `w` (m/s).
    pub(crate) fn most(&self, w: f64) -> f64 {
        match self {
            Self::Damping(lambda) => 1.0 + lambda * w.abs(),
            Self::Restoring(law) => 1.0 + law.chi,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn restoring(e: f64, v: f64) -> Loss {
        Loss::restoring_at(Restitution::new(e).expect("in (0, 1]"), Positive::new(v).expect("above 0"))
            .expect("a number")
    }

    /// `χ (1 + e) = ln((1 + χ) / (1 - χ e))` itself, by its power series in χ where its terms cancel.
    #[test]
    fn exact_restitution_is_that_of_the_undisturbed_collision() {
        for e in [1e-9_f64, 1e-3, 0.01, 0.024, 0.026, 0.15, 0.2, 0.5, 0.7, 0.9, 0.99, 0.999_999, 1.0 - 1e-12]
        {
            let v = 0.37;
            let chi = chi(e);
            let back = restoring(e, v).restitution(v);
            assert!((back / e - 1.0).abs() < 1e-13, "{e} {back}");
            let off = if chi > 0.1 && e > 0.1 {
                (chi.ln_1p() - (-chi * e).ln_1p()) / (chi * (1.0 + e)) - 1.0
            } else if chi <= 0.1 {
                // Σ (-χ)^k (1 - (-e)^(k + 2)) / (k + 2) = 0 after division by -χ²
                let term = |k: i32| (-chi).powi(k) * (1.0 - (-e).powi(k + 2)) / f64::from(k + 2);
                (0..20).map(term).sum::<f64>() / (1.0 - e)
            } else {
                chi * e - 1.0 // to exp(-1/e)
            };
            assert!(off.abs() < 1e-12 + 4e-16 / (1.0 - e), "{e}: {off:e}");
        }
        assert_eq!(restoring(1.0, 2.0), Loss::default());
    }

    #[test]
    fn exact_limits_of_small_and_large_losses() {
        // Hunt and Crossley's limit e = 1 - 2 χ / 3, and a speed after the collision that tends to 1/λ.
        for chi in [1e-4, 1e-6, 1e-8] {
            let loss = Loss::Damping(NonNegative::new(chi).expect("a number"));
            assert!(((1.0 - loss.restitution(1.0)) / (2.0 / 3.0 * chi) - 1.0).abs() < chi + 1e-8, "{chi}");
        }
        for chi in [1e2, 1e4] {
            let loss = Loss::Damping(NonNegative::new(chi).expect("a number"));
            assert!((loss.restitution(1.0) * chi - 1.0).abs() < 1e-12, "{chi}");
        }
    }

    #[test]
    fn contract_a_loss_is_given_in_one_of_three_ways() {
        let read = |text: &str| serde_json::from_str::<Loss>(text).map_err(|error| error.to_string());
        let lambda = read(r#"{"lambda":0.3}"#).expect("a loss");
        assert_eq!(serde_json::to_string(&lambda).expect("JSON"), r#"{"lambda":0.3}"#);
        assert_eq!(read(r#"{"restitution":0.7,"at":0.5}"#), Ok(restoring(0.7, 0.5)));
        let any = read(r#"{"restitution":0.7}"#).expect("a loss");
        assert_eq!(any, Loss::Restoring(Restitution::new(0.7).expect("in (0, 1]")));
        assert_eq!(serde_json::to_string(&any).expect("JSON"), r#"{"restitution":0.7}"#);
        for (text, said) in [
            ("{}", "empty: give `lambda` (s/m), or `restitution`"),
            (r#"{"lambda":-1}"#, "-1 is not allowed here: give a finite number not below 0"),
            (r#"{"lambda":1,"restitution":0.7,"at":1}"#, "not both"),
            (r#"{"lambda":1,"at":1}"#, "not both"),
            (r#"{"at":1}"#, "missing field `restitution`"),
            (r#"{"restitution":0.7,"at":0}"#, "0 is not allowed here: give a finite number above 0"),
            (r#"{"restitution":0,"at":1}"#, "0 is not allowed here: give a number above 0 and at most 1"),
            (r#"{"restitution":1.1,"at":1}"#, "1.1 is not allowed here: give a number above 0 and at most 1"),
            (r#"{"restitution":1e-300,"at":1e-300}"#, "no `lambda` gives this restitution at this speed"),
            (r#"{"e":0.7}"#, "unknown field `e`"),
        ] {
            let error = read(text).expect_err(text);
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
