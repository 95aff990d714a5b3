//! The parameters of a scene, with the paper's symbols in files and words in code. The mapping is written here, once.

use crate::{Damper, Forcing, NonNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Everything that decides a motion: the structure, the force on it, and the damper hung on it, if any.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// The heavy oscillator whose vibration is to be reduced.
    pub primary: Primary,
    /// What makes the primary structure move.
    pub forcing: Forcing,
    /// The damper; leave it out (or null) for the bare primary structure.
    #[serde(default)]
    pub damper: Option<Damper>,
}

/// The primary structure (PS), a linear oscillator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Primary {
    /// m1, mass of the primary structure, kg.
    #[serde(rename = "m1")]
    pub mass: Positive,
    /// c1, damping of the primary structure, N·s/m.
    #[serde(rename = "c1")]
    pub damping: NonNegative,
    /// k1, stiffness of the primary structure, N/m.
    #[serde(rename = "k1")]
    pub stiffness: NonNegative,
}

impl Primary {
    /// ω0 = √(k1/m1), the natural frequency without damping (section 2 of the paper), rad/s.
    pub fn natural_frequency(&self) -> f64 {
        (self.stiffness.get() / self.mass.get()).sqrt()
    }

    /// c1/(2 m1), half the width of the resonance where its energy has fallen to a half, to first order in the damping, rad/s
    /// (any text on vibration, for instance J. P. Den Hartog, Mechanical Vibrations, chapter 2).
    pub fn half_power_half_width(&self) -> f64 {
        0.5 * self.damping.get() / self.mass.get()
    }
}

/// Den Hartog's optimum for the displacement of an undamped structure under a harmonic force: `[k2, c2]`, N/m and N·s/m, of a damper of
/// `mass` (kg). With `μ = m2/m1` and `ω2 = √(k1/m1) / (1 + μ)` they are `k2 = m2 ω2²` and `c2 = 2 m2 ω2 √(3μ / (8 (1 + μ)))`.
///
/// J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 3.3.
pub fn den_hartog(primary: &Primary, mass: f64) -> [f64; 2] {
    let ratio = mass / primary.mass.get();
    let frequency = primary.natural_frequency() / (1.0 + ratio);
    let zeta = (3.0 * ratio / (8.0 * (1.0 + ratio))).sqrt();
    [mass * frequency * frequency, 2.0 * mass * frequency * zeta]
}

/// Warburton's optimum for the acceleration of an undamped structure under a harmonic force, or for its displacement under a rotating
/// imbalance: `[k2, c2]`, N/m and N·s/m, of a damper of `mass` (kg). With `μ = m2/m1` and `ω2 = √(k1/m1) / √(1 + μ)` they are `k2 = m2 ω2²`
/// and `c2 = 2 m2 ω2 √(3μ / (8 (1 + μ/2)))`.
///
/// G. B. Warburton, Optimum absorber parameters for various combinations of response and excitation parameters, Earthq. Eng. Struct. Dyn.
/// 10 (1982) 381, Table 1.
pub fn warburton(primary: &Primary, mass: f64) -> [f64; 2] {
    let ratio = mass / primary.mass.get();
    let frequency = primary.natural_frequency() / (1.0 + ratio).sqrt();
    let zeta = (3.0 * ratio / (8.0 * (1.0 + 0.5 * ratio))).sqrt();
    [mass * frequency * frequency, 2.0 * mass * frequency * zeta]
}
