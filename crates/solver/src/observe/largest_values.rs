//! The largest values of any of the measures.

use super::displacement_range::DisplacementRange;
use super::magnitude::Magnitude;
use super::observer::{Impact, Observer, Path};
use super::quantity::PrimaryEnergy;
use super::running_maximum::RunningMaximum;
use super::structure::StructureMotion;
use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use retune_model::{Coupled, Measure, PerMeasure};

type Motion<'a> = Magnitude<StructureMotion<'a, Coupled, 4>>;

/// The measures of the structure's motion.
const MOTIONS: [Measure; 4] =
    [Measure::Displacement, Measure::Velocity, Measure::Acceleration, Measure::GroundForce];

/// Observes the largest values of the requested measures.
pub struct LargestValues<'a> {
    energy: Option<RunningMaximum<PrimaryEnergy<'a>>>,
    /// In the order of [`MOTIONS`].
    motions: [Option<Motion<'a>>; MOTIONS.len()],
    range: Option<DisplacementRange<'a>>,
}

impl<'a> LargestValues<'a> {
    /// Observes a structure and its damper for some measures.
    pub fn new(system: &'a Coupled, measures: PerMeasure<bool>) -> Self {
        let motion = |measure, quantity: fn(&'a Coupled, f64) -> StructureMotion<'a, Coupled, 4>| {
            let size = || Magnitude::new(|sign| quantity(system, sign), f64::INFINITY);
            measures.get(measure).then(size)
        };
        let energy = || RunningMaximum::new(PrimaryEnergy::new(system), f64::INFINITY);
        let range = Measure::OF_DAMPER.into_iter().any(|measure| measures.get(measure));
        Self {
            energy: measures.get(Measure::Energy).then(energy),
            motions: [
                motion(Measure::Displacement, StructureMotion::displacement),
                motion(Measure::Velocity, StructureMotion::velocity),
                motion(Measure::Acceleration, StructureMotion::acceleration),
                motion(Measure::GroundForce, StructureMotion::ground_force),
            ],
            range: range.then(|| DisplacementRange::new(system, f64::INFINITY)),
        }
    }

    /// The largest values so far, 0 for what is not observed, and before any motion was seen.
    pub fn values(&self) -> PerMeasure<f64> {
        let mut values = PerMeasure::all(0.0);
        let mut set = |measure, value: f64| values.set(measure, value.max(0.0));
        if let Some(energy) = &self.energy {
            set(Measure::Energy, energy.record().value);
        }
        for (measure, motion) in MOTIONS.into_iter().zip(&self.motions) {
            set(measure, motion.as_ref().map_or(0.0, |size| size.record().value));
        }
        for measure in Measure::OF_DAMPER {
            set(measure, self.range.as_ref().map_or(0.0, |range| range.largest(measure).value));
        }
        values
    }
}

impl Observer<4> for LargestValues<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        self.energy.segment(segment);
        self.motions.segment(segment);
        self.range.segment(segment);
    }
    fn path(&mut self, path: &dyn Path<4>) {
        self.energy.path(path);
        self.motions.path(path);
        self.range.path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.energy.steps(steps);
        self.motions.steps(steps);
        self.range.steps(steps);
    }
    fn skips(&self, block: &Block<4>) -> bool {
        self.energy.skips(block) && self.motions.skips(block) && self.range.skips(block)
    }
    fn impact(&mut self, impact: &Impact<4>) {
        self.energy.impact(impact);
        self.motions.impact(impact);
        self.range.impact(impact);
    }
    fn discontinuity(&mut self) {
        self.energy.discontinuity();
        self.motions.discontinuity();
        self.range.discontinuity();
    }
    fn search_work(&self) -> u64 {
        Observer::<4>::search_work(&self.energy) + self.motions.search_work() + self.range.search_work()
    }
}
