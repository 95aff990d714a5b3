//! The result of a run: largest values, counts, the final state and the work.

use retune_model::Measure;
use serde::{Deserialize, Serialize};

/// A largest value and when it was reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// The time, s.
    pub time: f64,
}

/// The smallest model that was exact for a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SceneKind {
    /// No damper: one degree of freedom, exact flow.
    Bare,
    /// A damper that touched neither wall, checked on the trajectory: two degrees of freedom, exact flow.
    Linear,
    /// A damper that touched.
    Contact,
}

/// The work of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Steps taken (by the hybrid: flight and contact steps).
    pub steps: u64,
    /// Steps tried and rejected.
    pub rejected: u64,
    /// Evaluations of a right-hand side (by the hybrid: of the contact equations; an exact flight step needs none).
    pub evaluations: u64,
}

/// Largest values of the motion of the primary structure, each located as a maximum of its magnitude, and when they are reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StructureMaxima {
    /// `|x1|`, m.
    pub displacement: Extreme,
    /// `|v1|`, m/s.
    pub velocity: Extreme,
    /// `|a1|`, m/s², contact forces included.
    pub acceleration: Extreme,
    /// The force on the ground `|k1 x1 + c1 v1|`, N.
    pub ground_force: Extreme,
}

impl StructureMaxima {
    /// All of them, in this order.
    pub fn all(&self) -> [Extreme; 4] {
        let Self { displacement, velocity, acceleration, ground_force } = *self;
        [displacement, velocity, acceleration, ground_force]
    }
}

/// The observations of a run within its window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Largest energy of the primary structure, J.
    pub e1_max: Extreme,
    /// Largest energy of the damper, the paper's E2, J; zero without a damper.
    pub e2_max: Extreme,
    /// Largest values of the primary structure's motion.
    pub structure: StructureMaxima,
    /// Touch-downs on the primary structure and on the obstacle.
    pub impacts: [u64; 2],
    /// Largest contact forces on the primary structure and on the obstacle, N; infinite for a rigid wall that was struck.
    pub force_max: [f64; 2],
    /// Largest contact pressures on the primary structure and on the obstacle, N/m².
    pub pressure_max: [f64; 2],
    /// Largest relative displacement `|x2 - x1|` of the damper, m: its place in the cavity.
    pub relative_displacement_max: f64,
    /// The stroke: largest spring deflection `|x2 - x1 - D|`, m.
    pub spring_deflection_max: f64,
    /// State at the end of the window: `[x1, v1, x2, v2]`, or `[x1, v1, 0, 0]` without a damper.
    pub final_state: [f64; 4],
    /// The smallest model that was exact for the whole run.
    pub scene: SceneKind,
    /// The work of the run.
    pub work: Work,
}

impl Response {
    /// The largest value of a measure, in its unit; for contact force and pressure, the larger of both walls.
    pub fn largest(&self, measure: Measure) -> f64 {
        match measure {
            Measure::Energy => self.e1_max.value,
            Measure::Displacement => self.structure.displacement.value,
            Measure::Velocity => self.structure.velocity.value,
            Measure::Acceleration => self.structure.acceleration.value,
            Measure::GroundForce => self.structure.ground_force.value,
            Measure::Stroke => self.spring_deflection_max,
            Measure::ContactForce => self.force_max[0].max(self.force_max[1]),
            Measure::ContactPressure => self.pressure_max[0].max(self.pressure_max[1]),
            // A decay time takes separate runs.
            Measure::DecayTime => f64::NAN,
            Measure::Stationary(_) => self.largest(measure.of_run()),
        }
    }
}
