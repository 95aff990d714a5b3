//! What a contact loses: the law of Hunt and Crossley, `F = K z^(3/2) (1 + λ ż)`, never pulling (`docs/theory.md`, "Contacts that lose
//! energy").
//!
//! K. H. Hunt and F. R. E. Crossley, Coefficient of restitution interpreted as damping in vibroimpact, J. Appl. Mech. 42 (1975) 440.

use crate::{NonNegative, OutOfRange, Positive, Restitution};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The loss of a contact; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "InFile", into = "InFile")]
#[schemars(with = "InFile")]
pub struct Loss {
    /// lambda, s/m; 0 without loss.
    pub lambda: NonNegative,
}

/// What a contact loses, the law of Hunt and Crossley: the force is K z^1.5 (1 + lambda dz/dt), never below 0. Give lambda, or the
/// restitution of an undisturbed collision and the impact speed at which it holds.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Loss", extend("oneOf" = [{ "required": ["lambda"] }, { "required": ["restitution", "at"] }]))]
struct InFile {
    /// lambda, damping factor of the contact force, s/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lambda: Option<NonNegative>,
    /// Speed after over speed before an undisturbed collision at the impact speed `at`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    restitution: Option<Restitution>,
    /// The impact speed at which the restitution holds, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    at: Option<Positive>,
}

/// Why what a file says is no loss.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
enum Refused {
    #[error("give `lambda` (s/m), or `restitution` with `at` (the impact speed, m/s), not both")]
    Both,
    #[error("empty: give `lambda` (s/m), or `restitution` with `at` (the impact speed, m/s)")]
    Neither,
    #[error("missing field `at`: the impact speed at which the restitution holds, m/s")]
    NoSpeed,
    #[error("missing field `restitution`: speed after over speed before a collision at the speed `at`")]
    NoRestitution,
    #[error("no `lambda` gives this restitution at this speed: {0}")]
    OutOfRange(#[from] OutOfRange),
}

impl TryFrom<InFile> for Loss {
    type Error = Refused;

    fn try_from(InFile { lambda, restitution, at }: InFile) -> Result<Self, Refused> {
        match (lambda, restitution, at) {
            (Some(lambda), None, None) => Ok(Self { lambda }),
            (None, Some(restitution), Some(at)) => Ok(Self::restoring(restitution, at)?),
            (Some(_), ..) => Err(Refused::Both),
            (None, None, None) => Err(Refused::Neither),
            (None, Some(_), None) => Err(Refused::NoSpeed),
            (None, None, Some(_)) => Err(Refused::NoRestitution),
        }
    }
}

impl From<Loss> for InFile {
    fn from(Loss { lambda }: Loss) -> Self {
        Self { lambda: Some(lambda), restitution: None, at: None }
    }
}

impl Loss {
    /// The loss with this restitution `e` of an undisturbed collision at the touch-down speed `at`.
    ///
    /// With `χ = λ v` the collision obeys `χ (1 + e) = ln((1 + χ) / (1 - χ e))`. With `a = χ (1 + e) / 2` that is
    /// `(1 - e) / (1 + e) = coth a - 1/a`, Langevin's function.
    ///
    /// # Errors
    /// λ is beyond the numbers.
    pub fn restoring(restitution: Restitution, at: Positive) -> Result<Self, OutOfRange> {
        let e = restitution.get();
        let ratio = (1.0 - e) / (1.0 + e);
        // A close guess (A. Cohen, Rheologica Acta 30 (1991) 270), and where coth a is 1 to rounding the root itself.
        let mut a = ratio * (3.0 - ratio * ratio) / (1.0 - ratio * ratio);
        if e < 0.025 {
            a = 0.5 * (1.0 + e) / e;
        } else if e < 1.0 {
            for _ in 0..8 {
                let value = langevin(a);
                a -= (value - ratio) / (1.0 - value * value - 2.0 * value / a);
            }
        }
        Ok(Self { lambda: NonNegative::new(2.0 * a / ((1.0 + e) * at.get()))? })
    }

    /// The restitution of an undisturbed collision at a touch-down speed, m/s: the inverse of [`Self::restoring`].
    pub fn restitution(self, speed: f64) -> f64 {
        let chi = self.lambda.get() * speed;
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
        self.lambda.get() == 0.0
    }
}

/// `coth a - 1/a` for `a >= 0`; where the difference would lose digits, its continued fraction `a / (3 + a² / (5 + a² / (7 + …)))`.
fn langevin(a: f64) -> f64 {
    if a > 1.0 {
        return 1.0 / a.tanh() - 1.0 / a;
    }
    a / (1..=10).rev().fold(23.0, |rest, k| f64::from(2 * k + 1) + a * a / rest)
}

/// How far below zero `1 + λ w` may be by rounding where the force ends.
const ROUNDING: f64 = 1e-9;

/// `1 + λ w` at the rate of indentation `w` (m/s), and its slope λ: the factors of Hertz's force. Both are zero where the wall would pull;
/// where the force ends, `1 + λ w = 0` to rounding, the slope is that of the side on which it acts.
#[inline]
pub(crate) fn factors(lambda: f64, w: f64) -> [f64; 2] {
    let factor = 1.0 + lambda * w;
    if factor > -ROUNDING { [factor.max(0.0), lambda] } else { [0.0; 2] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn restoring(e: f64, v: f64) -> Loss {
        Loss::restoring(Restitution::new(e).expect("in (0, 1]"), Positive::new(v).expect("above 0"))
            .expect("a number")
    }

    /// `χ (1 + e) = ln((1 + χ) / (1 - χ e))` itself, by its power series in χ where its terms cancel.
    #[test]
    fn exact_restitution_is_that_of_the_undisturbed_collision() {
        for e in [1e-9_f64, 1e-3, 0.01, 0.024, 0.026, 0.15, 0.2, 0.5, 0.7, 0.9, 0.99, 0.999_999, 1.0 - 1e-12]
        {
            let v = 0.37;
            let chi = restoring(e, v).lambda.get() * v;
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
        // Hunt and Crossley's e = 1 - 2 χ / 3, and a speed after the collision that tends to 1/λ.
        for chi in [1e-4, 1e-6, 1e-8] {
            let loss = Loss { lambda: NonNegative::new(chi).expect("a number") };
            assert!(((1.0 - loss.restitution(1.0)) / (2.0 / 3.0 * chi) - 1.0).abs() < chi + 1e-8, "{chi}");
        }
        for chi in [1e2, 1e4] {
            let loss = Loss { lambda: NonNegative::new(chi).expect("a number") };
            assert!((loss.restitution(1.0) * chi - 1.0).abs() < 1e-12, "{chi}");
        }
    }

    #[test]
    fn contract_a_loss_is_given_in_one_of_two_ways() {
        let read = |text: &str| serde_json::from_str::<Loss>(text).map_err(|error| error.to_string());
        let lambda = read(r#"{"lambda":0.3}"#).expect("a loss");
        assert_eq!(serde_json::to_string(&lambda).expect("JSON"), r#"{"lambda":0.3}"#);
        assert_eq!(read(r#"{"restitution":0.7,"at":0.5}"#), Ok(restoring(0.7, 0.5)));
        for (text, said) in [
            ("{}", "empty: give `lambda` (s/m), or `restitution` with `at`"),
            (r#"{"lambda":-1}"#, "-1 is not allowed here: give a finite number not below 0"),
            (r#"{"lambda":1,"restitution":0.7,"at":1}"#, "not both"),
            (r#"{"lambda":1,"at":1}"#, "not both"),
            (r#"{"restitution":0.7}"#, "missing field `at`"),
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
