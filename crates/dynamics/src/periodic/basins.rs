//! A map of basins: the motion on which each start in a plane of initial states settles.
//!
//! The starts are at a crest of the force, with the structure in any state that the force can bring it to and the damper at rest in it. A
//! run is followed until it is as near to a known motion as [`settle`](super::settle::settle) requires of a repetition.

use super::attractors::Sample;
use super::branches::{Branches, Plan, equations, sample};
use super::settle::{CHECKS, NEAR, Starts};
use crate::parameter::Error;
use crate::poincare::{PoincareMap, coupled};
use crate::record::{coordinates, distance};
use rayon::prelude::*;
use retune_model::{Coupled, Scene};
use retune_solver::observe::Unobserved;
use retune_solver::{Motion, Phase, Settings};

/// Number of starts along a side of the plane; odd, so that the one in the middle is at rest.
pub const SIDE: usize = 81;

/// The basins at one value of a parameter.
#[derive(Clone, Debug)]
pub struct Basins {
    /// What runs from many starts settle on there.
    pub sample: Sample,
    /// The starts: `x1` (m) and `v1` (m/s).
    pub sides: [Vec<f64>; 2],
    /// The index of the sample's motion that each start ends on, `x1` varying fastest; none if it ends on none of them.
    pub ends: Vec<Option<usize>>,
}

/// The plane at one value of a parameter, and the motions there.
pub struct Plane {
    /// What runs from many starts settle on there.
    pub sample: Sample,
    /// The speed that the structure reaches without damper, m/s.
    reach: f64,
    scene: Scene,
    system: Coupled,
    settings: Settings,
}

impl Plane {
    /// Finds the motions of a scene at a value of the parameter, and their branches among `known` ones.
    ///
    /// # Errors
    /// The scene cannot be run there.
    pub fn new(
        scene: &Scene,
        plan: Plan,
        settings: &Settings,
        value: f64,
        known: Option<&Branches>,
    ) -> Result<Self, Error> {
        let shooting = equations(scene, &plan, settings)?;
        let scene = shooting.scene_at(value)?;
        let reach = Starts::over(&scene, plan.parameter, [value; 2])?.reach;
        let mut sample = sample(&scene, plan, settings, value, None)?;
        for one in &mut sample.attractors {
            let own = shooting.of_periods(one.orbit.periods);
            let motion = own.correct_at_value(&own.unknowns(&one.orbit.states, value));
            one.branch = motion.and_then(|motion| known?.holds(&own, &motion));
        }
        Ok(Self { sample, reach, scene, system: coupled(&scene)?, settings: *shooting.settings() })
    }

    /// The index of the motion that a run ends on, from `x1` (m) and `v1` (m/s) of the structure with the damper at rest in it.
    ///
    /// # Errors
    /// The run cannot be finished.
    pub fn end(&self, [x1, v1]: [f64; 2]) -> Result<Option<usize>, Error> {
        let at = |y: &[f64; 4]| coordinates(&self.scene, y);
        let y = [x1, v1, x1 + self.system.rest_distance(), v1];
        let mut map = PoincareMap::new(&self.system, &self.settings);
        let mut motion = Motion { t: 0.0, y, phase: Phase::of(&self.system, &y) };
        for _ in 0..CHECKS[CHECKS.len() - 1] {
            motion = map.next(motion, &mut Unobserved)?;
            let now = at(&motion.y);
            let near = |state: &[f64; 4]| distance(&at(state), &now) < NEAR * distance(&now, &[0.0; 4]);
            let mut motions = self.sample.attractors.iter();
            if let Some(number) = motions.position(|one| one.orbit.states.iter().any(near)) {
                return Ok(Some(number));
            }
        }
        Ok(None)
    }

    /// Follows all starts. `done` is called after each row.
    ///
    /// # Errors
    /// A run cannot be finished.
    pub fn basins(self, done: impl Fn() + Sync) -> Result<Basins, Error> {
        let speed = self.reach;
        let middle = (SIDE / 2) as f64;
        // Six decimals are enough for a start, and short in a table.
        let place = |reach: f64, i: usize| (1e6 * reach * (i as f64 - middle) / middle).round() / 1e6;
        let sides = [speed / self.scene.forcing.frequency.get(), speed]
            .map(|reach| (0..SIDE).map(|i| place(reach, i)).collect::<Vec<f64>>());
        let row = |v1: &f64| {
            let row: Result<Vec<_>, Error> = sides[0].iter().map(|x1| self.end([*x1, *v1])).collect();
            done();
            row
        };
        let rows: Result<Vec<_>, Error> = sides[1].par_iter().map(row).collect();
        Ok(Basins { sample: self.sample, ends: rows?.concat(), sides })
    }
}

impl Basins {
    /// Each start, `x1` and `v1`, with the number of the motion that it ends on.
    pub fn starts(&self) -> impl Iterator<Item = ([f64; 2], Option<usize>)> {
        let starts = self.sides[1].iter().flat_map(|v1| self.sides[0].iter().map(move |x1| [*x1, *v1]));
        starts.zip(self.ends.iter().copied())
    }
}
