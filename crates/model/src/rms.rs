//! The catalogue of quantities of stationary random motions, each once, with its name, words and unit.

/// A quantity of a stationary random motion, which replaces a largest value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rms {
    /// The mean of E1.
    Energy,
    /// The root mean square of x1.
    Displacement,
    /// The root mean square of v1.
    Velocity,
    /// The root mean square of a1.
    Acceleration,
    /// The root mean square of k1 x1 + c1 v1.
    GroundForce,
    /// The root mean square of the spring's deflection x2 - x1 - D.
    Stroke,
}

impl Rms {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Energy,
        Self::Displacement,
        Self::Velocity,
        Self::Acceleration,
        Self::GroundForce,
        Self::Stroke,
    ];

    /// Its entry of the catalogue, as in [`Measure`](crate::Measure).
    pub(crate) const fn entry(self) -> [&'static str; 4] {
        match self {
            Self::Energy => {
                ["E1mean", "mean E1", "the mean energy of the structure in a stationary random motion", "J"]
            }
            Self::Displacement => ["x1rms", "rms x1", "the root mean square of its displacement", "m"],
            Self::Velocity => ["v1rms", "rms v1", "the root mean square of its velocity", "m/s"],
            Self::Acceleration => ["a1rms", "rms a1", "the root mean square of its acceleration", "m/s²"],
            Self::GroundForce => {
                ["ground_force_rms", "rms ground", "the root mean square of the force on the ground", "N"]
            }
            Self::Stroke => ["stroke_rms", "rms stroke", "the root mean square of the damper's stroke", "m"],
        }
    }
}
