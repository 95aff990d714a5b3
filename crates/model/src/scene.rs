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

/// The exact optimum that Den Hartog's formulas approximate: the spring and dashpot that minimise the largest displacement, over all
/// frequencies, of an undamped structure under a harmonic force. `[k2, c2]`, N/m and N·s/m, of a damper of `mass` (kg). With `μ = m2/m1`,
/// `r = √(4 + 3μ)` and `ω0 = √(k1/m1)`
///
/// `ω2/ω0 = 2/(1 + μ) √(2 (16 + 23μ + 9μ² + 2 (2 + μ) r) / (3 (64 + 80μ + 27μ²)))`, `ζ = √((8 + 9μ - 4r) / (1 + μ)) / 4`,
///
/// `k2 = m2 ω2²` and `c2 = 2 m2 ω2 ζ`. For light dampers `8 - 4r` cancels: `8 + 9μ - 4r = 3μ (32 + 27μ) / (8 + 9μ + 4r)`.
///
/// O. Nishihara and T. Asami, Closed-form solutions to the exact optimizations of dynamic vibration absorbers (minimizations of the maximum
/// amplitude magnification factors), J. Vib. Acoust. 124 (2002) 576: the compliance.
pub fn nishihara_asami(primary: &Primary, mass: f64) -> [f64; 2] {
    let ratio = mass / primary.mass.get();
    let root = (4.0 + 3.0 * ratio).sqrt();
    let tuning = 2.0 * (16.0 + 23.0 * ratio + 9.0 * ratio * ratio + 2.0 * (2.0 + ratio) * root)
        / (3.0 * (64.0 + 80.0 * ratio + 27.0 * ratio * ratio));
    let frequency = primary.natural_frequency() * 2.0 / (1.0 + ratio) * tuning.sqrt();
    let squared = 3.0 * ratio * (32.0 + 27.0 * ratio) / (8.0 + 9.0 * ratio + 4.0 * root) / (1.0 + ratio);
    let zeta = 0.25 * squared.sqrt();
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
