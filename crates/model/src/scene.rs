//! The parameters of a scene, with the paper's symbols in files and words in code. The mapping is written here, once.

use crate::{Forcing, NonNegative, PoissonRatio, Positive, hertz_stiffness};
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

/// The damper: a mass on a spring and a dashpot in a cavity of the primary structure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Damper {
    /// m2, mass of the damper, kg.
    #[serde(rename = "m2")]
    pub mass: Positive,
    /// k2, stiffness of the damper's spring, N/m.
    #[serde(rename = "k2")]
    pub stiffness: NonNegative,
    /// c2, damping between damper and primary structure, N·s/m.
    #[serde(rename = "c2")]
    pub damping: NonNegative,
    /// D, distance between the damper at rest and the primary structure, m.
    #[serde(rename = "D")]
    pub rest_distance: NonNegative,
    /// C, clearance between the damper at rest and the obstacle, m.
    #[serde(rename = "C")]
    pub clearance: NonNegative,
    /// The colliding surfaces.
    pub contact: Contact,
}

/// The four colliding surfaces: the damper's are spheres of one large radius, the structure's and the obstacle's are flat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// R, radius of the damper's surfaces, m (not given in the paper).
    #[serde(rename = "R")]
    pub radius: Positive,
    /// q, geometrical coefficient of Hertz's theory; 0.318 for a sphere on a plane (not given in the paper).
    #[serde(rename = "q")]
    pub coefficient: Positive,
    /// E1, Young's modulus of the primary structure's surface, N/m².
    #[serde(rename = "E1")]
    pub young_1: Positive,
    /// nu1, Poisson's ratio of the primary structure's surface.
    #[serde(rename = "nu1")]
    pub poisson_1: PoissonRatio,
    /// E2, Young's modulus of the damper's surface that meets the primary structure, N/m².
    #[serde(rename = "E2")]
    pub young_2: Positive,
    /// nu2, Poisson's ratio of the damper's surface that meets the primary structure.
    #[serde(rename = "nu2")]
    pub poisson_2: PoissonRatio,
    /// E3, Young's modulus of the obstacle's surface, N/m².
    #[serde(rename = "E3")]
    pub young_3: Positive,
    /// nu3, Poisson's ratio of the obstacle's surface.
    #[serde(rename = "nu3")]
    pub poisson_3: PoissonRatio,
    /// E4, Young's modulus of the damper's surface that meets the obstacle, N/m².
    #[serde(rename = "E4")]
    pub young_4: Positive,
    /// nu4, Poisson's ratio of the damper's surface that meets the obstacle.
    #[serde(rename = "nu4")]
    pub poisson_4: PoissonRatio,
}

impl Contact {
    /// Hertz stiffnesses `[K1, K3]` of the contacts with the primary structure and with the obstacle, N/m^1.5.
    pub fn stiffness(&self) -> [f64; 2] {
        let pair =
            |young_a: Positive, poisson_a: PoissonRatio, young_b: Positive, poisson_b: PoissonRatio| {
                hertz_stiffness(
                    self.coefficient.get(),
                    self.radius.get(),
                    [(young_a.get(), poisson_a.get()), (young_b.get(), poisson_b.get())],
                )
            };
        [
            pair(self.young_1, self.poisson_1, self.young_2, self.poisson_2),
            pair(self.young_3, self.poisson_3, self.young_4, self.poisson_4),
        ]
    }
}
