//! What runs settle on at one value of the parameter.

use super::orbit::Orbit;
use super::seen::Seen;
use super::settle::{self, Settled, is_same, settle};
use super::shooting::{Shooting, Solution};
use crate::parameter::Error;

/// A motion on which runs settle, at one sample.
#[derive(Clone, Debug)]
pub struct Attractor {
    /// The number of its branch; none if it could not be followed.
    pub branch: Option<usize>,
    /// The motion.
    pub orbit: Orbit,
    /// How many starts end on it.
    pub starts: usize,
    /// Whether the run from rest does.
    pub from_rest: bool,
}

/// What runs settle on at one value of the parameter.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The value.
    pub value: f64,
    /// The periodic motions, the most frequent first.
    pub attractors: Vec<Attractor>,
    /// What the runs reach that settled on none; the first one that from rest, if it did not.
    pub irregular: Vec<Seen>,
    /// Whether the run from rest settled on none.
    pub rest_is_irregular: bool,
    /// Number of starts, that from rest among them.
    pub starts: usize,
}

/// What runs settle on at a value of the parameter.
pub(super) struct Reached {
    value: f64,
    /// Periods, the motion, how many starts, whether from rest.
    attractors: Vec<(usize, Solution, usize, bool)>,
    irregular: Vec<Seen>,
    rest_is_irregular: bool,
    /// Starts that were made.
    pub starts: usize,
}

impl Reached {
    /// Whether a periodic motion is such a one.
    pub(super) fn is_any(&self, shooting: &Shooting, such: impl Fn(&Shooting, &Solution) -> bool) -> bool {
        self.attractors.iter().any(|(periods, motion, ..)| such(&shooting.of_periods(*periods), motion))
    }

    /// As a sample, with the branch that each motion is on.
    ///
    /// # Errors
    /// A scene cannot be run.
    pub(super) fn sample(
        self,
        shooting: &Shooting,
        mut branch: impl FnMut(&Shooting, &Solution) -> Option<usize>,
    ) -> Result<Sample, Error> {
        let Self { value, irregular, rest_is_irregular, starts, .. } = self;
        let mut attractors = Vec::new();
        for (periods, solution, starts, from_rest) in self.attractors {
            let own = shooting.of_periods(periods);
            let branch = branch(&own, &solution);
            attractors.push(Attractor { branch, orbit: Orbit::of(&own, &solution)?, starts, from_rest });
        }
        attractors.sort_by_key(|attractor| std::cmp::Reverse(attractor.starts));
        Ok(Sample { value, attractors, irregular, rest_is_irregular, starts })
    }
}

/// From rest and so many other starts, as long as it goes on.
///
/// # Errors
/// A scene cannot be run.
pub(super) fn look(
    shooting: &Shooting,
    value: f64,
    starts: usize,
    goes_on: &dyn Fn() -> bool,
) -> Result<Reached, Error> {
    let system = shooting.system(value)?;
    let scene = shooting.scene_at(value)?;
    let mut seen =
        Reached { value, attractors: Vec::new(), irregular: Vec::new(), rest_is_irregular: false, starts: 0 };
    let all = [system.rest()].into_iter().chain(settle::starts(&system, &scene, starts));
    for (number, y) in all.enumerate() {
        if !goes_on() {
            break;
        }
        seen.starts += 1;
        let from_rest = number == 0;
        match settle(shooting, value, y)? {
            Settled::Irregular(values) => {
                seen.irregular.push(values);
                seen.rest_is_irregular |= from_rest;
            }
            Settled::On(periods, solution) => {
                let own = shooting.of_periods(periods);
                let known = seen.attractors.iter_mut().find(|(_, known, ..)| is_same(&own, known, &solution));
                match known {
                    Some((_, _, starts, _)) => *starts += 1,
                    None => seen.attractors.push((periods, solution, 1, from_rest)),
                }
            }
        }
    }
    Ok(seen)
}
