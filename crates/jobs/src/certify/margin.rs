//! The margin of a design: motions found at a larger force are followed back, along the force and along each parameter, to their onset.

use super::certificate::{Margin, Other, ParameterError};
use super::motions::{AtForce, NOTABLE, Place, with_force};
use crate::amount::Amount;
use rayon::prelude::*;
use retune_dynamics::periodic::branches::equations;
use retune_dynamics::periodic::{Onset, Orbit, Seed, onset};
use retune_model::{Forcing, Measure, Parameter};
use retune_optim::Unusable;
use retune_solver::Settings;
use retune_study::Margins;

/// Force down to which motions are followed, as a share of the design's force. It is below 1 because the shift of an onset with a parameter
/// needs onsets below the design's force.
const DOWN: f64 = 0.9;
const PARAMETERS: [Parameter; 8] = [
    Parameter::K1,
    Parameter::C1,
    Parameter::M2,
    Parameter::K2,
    Parameter::C2,
    Parameter::D,
    Parameter::C,
    Parameter::R,
];

impl Place {
    /// Follows the motions with notably larger values at a larger force back to their onsets. Lowers the margin to the first onset, and
    /// returns the motions that exist at the design's force.
    fn lower(
        &self,
        found: &AtForce,
        measure: Measure,
        settings: &Settings,
        margin: &mut Margin,
    ) -> Result<Vec<Seed>, Unusable> {
        let Some((amplitude, own)) = self.scene.forcing.amplitude() else { return Ok(Vec::new()) };
        let own = own.get();
        let errors = 0.01 * margin.needed_percent;
        // The value from rest, as a power of the force through the two known points.
        let power = (found.from_rest / self.from_rest).ln() / found.times.ln();
        let notable = move |times: f64| NOTABLE * self.from_rest * times.powf(power);
        let counts = |orbit: &Orbit| orbit.seen.largest(measure) > notable(orbit.value / own);
        let k1 = self.scene.primary.stiffness.get();
        let largest = found.branches.largest(measure);
        if let Some(one) = largest.filter(|one| one.orbit.is_none() && one.value > notable(found.times)) {
            // An irregular motion cannot be followed: its onset may be anywhere above the previous force.
            let before =
                margin.forces.iter().copied().filter(|times| *times < found.times).fold(1.0, f64::max);
            margin.lower_to(before, Other { k1: Some(k1), reached: None, ..Other::new(measure, &one) });
        }
        let scene = with_force(&self.scene, found.times)?;
        let shooting = equations(&scene, &self.plan(), settings)?;
        let seeds =
            found.branches.seeds(&shooting, |orbit| orbit.seen.largest(measure) > notable(found.times));
        let other = |onset: &Onset| Other {
            value: Amount::new(measure, onset.orbit.seen.largest(measure)),
            omega: onset.omega,
            k1: Some(k1),
            state: onset.orbit.seen.start,
            periods: Some(onset.orbit.periods),
            impacts: onset.orbit.seen.impacts.clone(),
            reached: None,
        };
        let begins = |seeds: &[Seed]| onset(seeds, amplitude, DOWN * own, &counts);
        let onsets: Vec<Option<Onset>> = seeds.par_iter().map(|seeds| begins(seeds)).collect();
        let mut there = Vec::new();
        for (seeds, onset) in seeds.iter().zip(onsets) {
            let Some(onset) = onset else { continue };
            margin.lower_to(onset.value / own, other(&onset));
            if onset.value <= own {
                there.extend(seeds.iter().filter_map(|seed| seed.moved(amplitude, own)));
                continue;
            }
            for parameter in PARAMETERS {
                let Some(value) = parameter.of(&self.scene).filter(|value| *value > 0.0) else { continue };
                let at = |error: &f64| {
                    let moved: Vec<Seed> = seeds
                        .par_iter()
                        .filter_map(|seed| seed.moved(parameter, value * (1.0 + error)))
                        .collect();
                    let onset = begins(&moved).filter(|moved| moved.value <= own)?;
                    Some((*error, onset))
                };
                for (error, moved) in [-errors, errors].iter().filter_map(at) {
                    // The onset force varies almost linearly over so small an error.
                    let share = (onset.value - own) / (onset.value - moved.value);
                    margin.add(parameter.symbol(), 100.0 * error * share, other(&moved));
                }
            }
        }
        Ok(there)
    }
}

impl Margin {
    /// The initial margin, before any motion is found.
    pub(super) fn new(needed: &Margins, forcing: &Forcing) -> Self {
        Self {
            needed_force: 1.0 + needed.force,
            forces: vec![1.0 + needed.force],
            safe_to: 1.0 + needed.force,
            other: None,
            needed_percent: 100.0 * needed.errors,
            amplitude: forcing.amplitude().map(|(parameter, _)| parameter),
            parameters: Vec::new(),
        }
    }

    /// Lowers the margin to the onsets of motions found at a larger force; returns the motions that exist at the design's force, each with
    /// the index of its place.
    pub(super) fn lower(
        &mut self,
        places: &[Place],
        found: &[AtForce],
        measure: Measure,
        settings: &Settings,
    ) -> Result<Vec<(usize, Seed)>, Unusable> {
        let mut there = Vec::new();
        for (i, (place, found)) in places.iter().zip(found).enumerate() {
            there.extend(place.lower(found, measure, settings, self)?.into_iter().map(|seed| (i, seed)));
        }
        Ok(there)
    }

    /// Records a motion whose onset is at `times` the force.
    fn lower_to(&mut self, times: f64, other: Other) {
        if times < self.safe_to {
            (self.safe_to, self.other) = (times, Some(other));
        }
    }

    /// Records a motion that an error of a parameter brings; the smallest error of each parameter is kept.
    fn add(&mut self, parameter: &'static str, percent: f64, other: Other) {
        let known = self.parameters.iter().position(|one| one.parameter == parameter);
        let one = ParameterError { parameter, percent, other };
        match known {
            None => self.parameters.push(one),
            Some(i) if percent.abs() < self.parameters[i].percent.abs() => self.parameters[i] = one,
            Some(_) => {}
        }
    }
}
