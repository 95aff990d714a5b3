//! The result of an evaluation: a value and the runs behind it.

use super::limits::PerLimit;
use super::spec::Goal;
use retune_model::{Parameter, PerMeasure, Scene};

/// The run with the largest quantity among those behind a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// That quantity, in its unit.
    pub largest: f64,
    /// Its scene, with the parameter errors of its ensemble member.
    pub scene: Scene,
    /// Phase of its force, rad.
    pub phase: f64,
    /// Number of its term.
    pub term: usize,
}

/// A run behind a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// The scene and the largest quantity.
    pub place: Place,
    /// The largest values that were observed; 0 for others.
    pub reached: PerMeasure<f64>,
}

/// The value of a design and the quantities behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// The number that searches minimise: the value of a feasible design, above [`INFEASIBLE`](crate::INFEASIBLE) for any other.
    pub ranked: f64,
    /// The weighted sum of the terms, in the unit of the quantity.
    pub value: f64,
    /// Total violation of the limits; see [`crate::Limits::violation`].
    pub violation: f64,
    /// The largest values from [`crate::Limits::from`] on, and the cavity; those of runs are 0 if no limit needs them.
    pub reached: PerLimit<f64>,
    /// The worst run.
    pub worst: Place,
    /// Runs made; a steady response in closed form counts as one.
    pub runs: u64,
    /// Runs that should have settled and did not.
    pub unsettled: u64,
}

/// A scene with the loss of the contacts of another.
fn with_loss_of(scene: Scene, other: &Scene) -> Scene {
    let restitution = Parameter::Restitution;
    restitution.of(other).and_then(|e| restitution.at(scene, e).ok()).unwrap_or(scene)
}

impl Evaluation {
    /// The frequency of the worst run, rad/s; none of a pulse or a record, or of a constant force.
    pub fn worst_omega(&self) -> Option<f64> {
        Some(self.worst.scene.forcing.frequency.get()).filter(|omega| *omega > 0.0)
    }

    /// The scene of the worst run: `scene` at its record, ω, k1 and restitution, without the parameter errors of an ensemble member and
    /// with the force starting at a crest.
    pub fn worst_run(&self, mut scene: Scene, goal: &Goal) -> Scene {
        scene.forcing.frequency = self.worst.scene.forcing.frequency;
        if goal.term(self.worst.term).is_some_and(|term| !term.records.is_empty()) {
            scene.forcing = self.worst.scene.forcing;
        }
        if goal.term(self.worst.term).is_some_and(|term| term.k1.is_some()) {
            scene.primary.stiffness = self.worst.scene.primary.stiffness;
        }
        if goal.term(self.worst.term).is_some_and(|term| term.restitution.is_some()) {
            scene = with_loss_of(scene, &self.worst.scene);
        }
        scene
    }
}
