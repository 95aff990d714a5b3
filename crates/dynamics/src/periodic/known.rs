//! Motions known for one damper, continued to similar dampers: a search evaluates them besides runs from rest.

use super::branches::{Branches, Control, Plan, branches, equations};
use super::largest::COUNTS;
use super::onset::Seed;
use super::orbit::Orbit;
use super::shooting::{Shooting, Solution};
use crate::parameter::Error;
use retune_model::{Measure, Parameter, Scene};
use retune_solver::Settings;

/// Numbers of steps on the way to another damper, tried in turn.
const STEPS: [usize; 3] = [1, 4, 16];

/// The branches of a scene along ω about their largest values of a measure: those that runs from rest at the samples of a plan lead to, and
/// those through `known` motions of another damper, continued to this one.
///
/// # Errors
/// A scene in the range cannot be run.
pub fn from_rest_and(
    known: &[Seed],
    scene: &Scene,
    (plan, measure): (Plan, Measure),
    settings: &Settings,
) -> Result<Branches, Error> {
    let plan = Plan { starts: 0, apart: 0, fine: 0, passes: 0, crests: Some(measure), ..plan };
    let mut found = branches(scene, plan, settings, Control::default())?;
    let shooting = equations(scene, &plan, settings)?;
    for seed in known {
        let own = shooting.of_periods(seed.orbit.periods);
        if let Some(motion) = moved(&own, seed, scene)
            && found.holds(&own, &motion).is_none()
        {
            found.follow(&own, &motion, &|| true);
        }
    }
    Ok(found)
}

impl Branches {
    /// Motions of all branches of a scene with values of a measure large enough to continue them to other dampers.
    ///
    /// # Errors
    /// A value of the range is out of the parameter's.
    pub fn known(&self, scene: &Scene, measure: Measure, settings: &Settings) -> Result<Vec<Seed>, Error> {
        let most = self.largest(measure).map_or(0.0, |largest| largest.value);
        let counts = |orbit: &Orbit| orbit.seen.largest(measure) >= COUNTS * most;
        Ok(self.seeds(&equations(scene, &self.plan, settings)?, counts).concat())
    }
}

/// The stable motion that a known one becomes on the way to the damper of a scene; none if it vanishes before.
fn moved(own: &Shooting, seed: &Seed, scene: &Scene) -> Option<Solution> {
    let from = seed.scene();
    let arrived = |steps: &usize| {
        let mut states = seed.orbit.states.clone();
        let mut last = None;
        for step in 1..=*steps {
            let mut shooting = own.clone();
            shooting.forced.scene = between(from, scene, step as f64 / *steps as f64)?;
            let motion = shooting.correct_at_value(&shooting.unknowns(&states, seed.orbit.value))?;
            states = shooting.states(&motion.x);
            last = Some(motion);
        }
        last.filter(|motion| Orbit::of(own, motion).is_ok_and(|orbit| orbit.is_stable()))
    };
    STEPS.iter().find_map(arrived)
}

/// The scene `to` with a damper at a share of the way from that of `from`.
fn between(from: &Scene, to: &Scene, share: f64) -> Option<Scene> {
    let (own, mut damper) = (from.damper?, to.damper?);
    for parameter in Parameter::VARIED {
        let [Some(a), Some(b)] = [&own, &damper].map(|damper| parameter.of_damper(damper)) else { continue };
        parameter.set_damper(&mut damper, if share < 1.0 { a + share * (b - a) } else { b }).ok()?;
    }
    Some(Scene { damper: Some(damper), ..*to })
}
