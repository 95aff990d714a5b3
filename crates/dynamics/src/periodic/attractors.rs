//! The motions that runs settle on at one value of the parameter.

use super::orbit::Orbit;
use super::seen::Seen;
use super::settle::{Settled, Starts, is_same, settle};
use super::shooting::{Shooting, Solution};
use crate::parameter::Error;
use retune_model::Measure;

/// A motion on which runs settle, at one sample.
#[derive(Clone, Debug)]
pub struct Attractor {
    /// The number of its branch; none if it was not followed, or could not be.
    pub branch: Option<usize>,
    /// The motion.
    pub orbit: Orbit,
    /// How many starts end on it.
    pub starts: usize,
    /// Whether the run from rest ends on it.
    pub from_rest: bool,
}

/// What runs settle on at one value of the parameter.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The value.
    pub value: f64,
    /// The number of the start, if it is one of those over the whole range; none if runs from rest and other starts were made at this
    /// value.
    pub number: Option<usize>,
    /// The periodic motions, the most frequent first.
    pub attractors: Vec<Attractor>,
    /// The largest values of runs that did not settle; that from rest first, if it is one of them.
    pub irregular: Vec<Seen>,
    /// Whether the run from rest did not settle.
    pub rest_is_irregular: bool,
    /// Number of starts, including that from rest.
    pub starts: usize,
}

/// A periodic motion that runs settle on.
pub(super) struct End {
    pub periods: usize,
    pub motion: Solution,
    orbit: Orbit,
    starts: usize,
    from_rest: bool,
    /// The number of its branch, once it is known.
    pub branch: Option<usize>,
    /// Whether following its branch was tried; `branch` is still none if that failed.
    followed: bool,
}

/// What runs settle on at a value of the parameter.
pub(super) struct Reached {
    value: f64,
    number: Option<usize>,
    attractors: Vec<End>,
    irregular: Vec<Seen>,
    rest_is_irregular: bool,
    /// Starts that were made.
    pub starts: usize,
}

impl Reached {
    fn empty(value: f64, number: Option<usize>) -> Self {
        Self {
            value,
            number,
            attractors: Vec::new(),
            irregular: Vec::new(),
            rest_is_irregular: false,
            starts: 0,
        }
    }

    /// Follows a run and adds the motion that it settles on.
    fn follow(&mut self, shooting: &Shooting, y: [f64; 4], from_rest: bool) -> Result<(), Error> {
        self.starts += 1;
        match settle(shooting, self.value, y)? {
            Settled::Irregular(values) => {
                self.irregular.push(values);
                self.rest_is_irregular |= from_rest;
            }
            Settled::On(periods, solution) => {
                let own = shooting.of_periods(periods);
                let known = self.attractors.iter_mut().find(|known| is_same(&own, &known.motion, &solution));
                match known {
                    Some(known) => known.starts += 1,
                    None => {
                        let end = End {
                            periods,
                            orbit: Orbit::of(&own, &solution)?,
                            motion: solution,
                            starts: 1,
                            from_rest,
                            branch: None,
                            followed: false,
                        };
                        self.attractors.push(end);
                    }
                }
            }
        }
        Ok(())
    }

    /// The largest value of a measure.
    pub(super) fn most(&self, measure: Measure) -> f64 {
        let periodic = self.attractors.iter().map(|one| one.orbit.seen.largest(measure));
        periodic.chain(self.irregular.iter().map(|seen| seen.largest(measure))).fold(0.0, f64::max)
    }

    /// Whether `predicate` holds for any of the periodic motions.
    pub(super) fn any(&self, shooting: &Shooting, predicate: impl Fn(&Shooting, &Solution) -> bool) -> bool {
        self.attractors.iter().any(|one| predicate(&shooting.of_periods(one.periods), &one.motion))
    }

    /// Sets the branch of each motion whose branch is not known yet, where `branch` finds it.
    pub(super) fn find(
        &mut self,
        shooting: &Shooting,
        branch: impl Fn(&Shooting, &Solution) -> Option<usize>,
    ) {
        for one in self.attractors.iter_mut().filter(|one| one.branch.is_none()) {
            one.branch = branch(&shooting.of_periods(one.periods), &one.motion);
        }
    }

    /// The next motion whose branch is to be followed; each is returned once.
    pub(super) fn next(&mut self, follows: impl Fn(&Orbit) -> bool) -> Option<&mut End> {
        let is_next = |one: &&mut End| one.branch.is_none() && !one.followed && follows(&one.orbit);
        let one = self.attractors.iter_mut().find(is_next)?;
        one.followed = true;
        Some(one)
    }

    /// Converts to a sample.
    pub(super) fn sample(self) -> Sample {
        let Self { value, number, irregular, rest_is_irregular, starts, .. } = self;
        let known =
            |End { branch, orbit, starts, from_rest, .. }| Attractor { branch, orbit, starts, from_rest };
        let mut attractors: Vec<Attractor> = self.attractors.into_iter().map(known).collect();
        attractors.sort_by_key(|attractor| std::cmp::Reverse(attractor.starts));
        Sample { value, number, attractors, irregular, rest_is_irregular, starts }
    }
}

/// Runs from rest and from `count` other starts, as long as `proceed` is true.
///
/// # Errors
/// A scene cannot be run.
pub(super) fn attractors_at(
    shooting: &Shooting,
    value: f64,
    (starts, count): (&Starts, usize),
    proceed: &dyn Fn() -> bool,
) -> Result<Reached, Error> {
    let system = shooting.system(value)?;
    let all = [system.rest()].into_iter().chain((0..count).map(|number| starts.state(number, &system)));
    let mut seen = Reached::empty(value, None);
    for (number, y) in all.enumerate() {
        if !proceed() {
            break;
        }
        seen.follow(shooting, y, number == 0)?;
    }
    Ok(seen)
}

/// The run from one of the starts over the range, if `proceed` is true.
///
/// # Errors
/// A scene cannot be run.
pub(super) fn attractors_from(
    shooting: &Shooting,
    starts: &Starts,
    number: usize,
    proceed: &dyn Fn() -> bool,
) -> Result<Reached, Error> {
    let value = starts.value(number);
    let mut seen = Reached::empty(value, Some(number));
    if proceed() {
        seen.follow(shooting, starts.state(number, &shooting.system(value)?), false)?;
    }
    Ok(seen)
}
