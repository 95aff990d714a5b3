//! All branches that runs lead to: attractors at samples of a parameter, the branches through them, and those that bifurcate from these.

use super::attractors::{Reached, Sample, attractors_at, attractors_from};
use super::events::Event;
use super::largest::{COUNTS, crest, keep_crests, merged, stable_parts};
use super::orbit::Orbit;
use super::settle::{MOST_PERIODS, Starts, most_energy};
use super::shooting::{Shooting, Solution};
use super::trace::{Branch, doubled, trace};
use crate::parameter::{Error, evenly};
use rayon::prelude::*;
use retune_model::{Measure, Parameter, Scene};
use retune_solver::Settings;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

/// Spacings of the runs in gaps without a stable motion, one for each pass, as shares of the range; and the divisor for the number of their
/// starts, since runs that do not settle take longest.
pub const SPACINGS: [f64; 2] = [1.0 / 200.0, 1.0 / 400.0];
const FEWER: usize = 4;
/// Most periods of the motions that deflated Newton's iteration looks for.
const APART: usize = 2;
/// The narrowest gap that is searched, as a share of the range.
const NARROW: f64 = 2e-4;
/// Most branches.
const MOST_BRANCHES: usize = 200;

/// What to search for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The parameter.
    pub parameter: Parameter,
    /// Its range.
    pub range: [f64; 2],
    /// Number of its samples at which runs are started from rest.
    pub samples: usize,
    /// Other starts for each: one set over the whole range and the states that the force can reach.
    pub starts: usize,
    /// Runs at each sample from whose states deflated Newton's iteration looks for new motions of one and two periods.
    pub apart: usize,
    /// Number of values at which one more run is started from rest once the branches through the samples are known.
    pub fine: usize,
    /// Number of passes over the gaps without a stable motion, each finer than the last: at most one for each of [`SPACINGS`].
    pub passes: usize,
    /// Only motions with at least this value of a measure are followed along the parameter; the others count where runs meet them.
    pub least: Option<(Measure, f64)>,
    /// Follow branches only about their largest value of this measure, and none that bifurcate: enough to find that value.
    pub crests: Option<Measure>,
}

impl Plan {
    /// A plan without samples or any further search.
    pub const fn over(parameter: Parameter, range: [f64; 2]) -> Self {
        Self {
            parameter,
            range,
            samples: 0,
            starts: 0,
            apart: 0,
            fine: 0,
            passes: 0,
            least: None,
            crests: None,
        }
    }

    /// Number of starts over the whole range, besides those from rest.
    pub const fn others(&self) -> usize {
        self.samples * self.starts
    }

    /// Whether a motion is followed.
    pub(super) fn follows(&self, orbit: &Orbit) -> bool {
        self.least.is_none_or(|(measure, least)| orbit.seen.largest(measure) >= least)
    }

    /// Number of starts at a value between the samples.
    pub(super) const fn fewer_starts(&self) -> usize {
        self.starts.div_ceil(FEWER)
    }
}

/// Branches and samples.
#[derive(Clone, Debug)]
pub struct Branches {
    /// What was asked for.
    pub plan: Plan,
    /// The branches, in the order in which they were found.
    pub branches: Vec<Branch>,
    /// The samples, in the order of their values.
    pub samples: Vec<Sample>,
    /// Whether the search ended early, by [`Control::proceed`] or after the most branches.
    pub ended: bool,
}

/// Callbacks that report the progress of a search and may end it.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Called after each run from rest at a sample of the plan.
    pub done: &'a (dyn Fn() + Sync),
    /// Called before each run and each motion of a branch; once it returns false, the search ends.
    pub proceed: &'a (dyn Fn() -> bool + Sync),
}

impl Default for Control<'_> {
    fn default() -> Self {
        Self { done: &|| (), proceed: &|| true }
    }
}

/// A range of the parameter.
pub type Interval = [f64; 2];

/// Finds the branches of a scene along a parameter. Where no stable motion is found, more samples are taken. For a range of one value only
/// the motions are found.
///
/// # Errors
/// A scene in the range cannot be run.
pub fn branches(
    scene: &Scene,
    plan: Plan,
    settings: &Settings,
    control: Control<'_>,
) -> Result<Branches, Error> {
    let shooting = equations(scene, &plan, settings)?;
    let starts = Starts::over(scene, plan.parameter, plan.range)?;
    let mut found = Branches { plan, branches: Vec::new(), samples: Vec::new(), ended: false };
    let ended = AtomicBool::new(false);
    let proceed = || {
        (control.proceed)() || {
            ended.store(true, SeqCst);
            false
        }
    };
    let from_rest = |value: &f64| {
        let seen = attractors_at(&shooting, *value, (&starts, 0), &proceed);
        (control.done)();
        seen
    };
    let [from, to] = plan.range;
    if from == to {
        found.samples.push(attractors_at(&shooting, from, (&starts, plan.others()), &proceed)?.sample());
        found.ended |= ended.into_inner();
        return Ok(found);
    }
    let values = evenly(from, to, plan.samples);
    let mut seen: Vec<Reached> = values.par_iter().map(from_rest).collect::<Result<_, Error>>()?;
    if let Some(measure) = plan.crests {
        found.plan.least = Some((measure, COUNTS * keep_crests(&mut seen, measure)));
    }
    found.add(&shooting, seen, &proceed);
    let other = |number: usize| attractors_from(&shooting, &starts, number, &proceed);
    let others = (0..plan.others()).into_par_iter().map(other).collect::<Result<_, Error>>()?;
    found.add(&shooting, others, &proceed);
    for periods in 1..=APART {
        found.seek_apart(&shooting, &starts, periods, &proceed)?;
    }
    for spacing in SPACINGS.iter().take(plan.passes) {
        if ended.load(SeqCst) {
            break;
        }
        let here = |value: &f64| attractors_at(&shooting, *value, (&starts, plan.fewer_starts()), &proceed);
        let values = found.unseen(*spacing);
        found.add(&shooting, values.par_iter().map(here).collect::<Result<_, Error>>()?, &proceed);
    }
    found.seek_from_rest(&shooting, &starts, &proceed)?;
    found.ended |= ended.into_inner();
    found.samples.sort_by(|a, b| a.value.total_cmp(&b.value));
    Ok(found)
}

/// The equations of motions of one period, in units that suit the plan.
///
/// # Errors
/// A value in the range is out of the parameter's.
pub fn equations(scene: &Scene, plan: &Plan, settings: &Settings) -> Result<Shooting, Error> {
    let [from, to] = plan.range;
    let middle = plan.parameter.at(*scene, 0.5 * (from + to))?;
    let size = (2.0 * most_energy(&middle)).sqrt().max(f64::MIN_POSITIVE);
    let span = if to > from { to - from } else { to };
    Ok(Shooting::new(middle, plan.parameter, 1, (span, size), settings))
}

/// The motions that runs settle on at a value of the parameter, without the branches: from rest and other starts there, or from start
/// `number` of those over the range.
///
/// # Errors
/// A scene cannot be run.
pub fn sample(
    scene: &Scene,
    plan: Plan,
    settings: &Settings,
    value: f64,
    number: Option<usize>,
) -> Result<Sample, Error> {
    let shooting = equations(scene, &plan, settings)?;
    let starts = Starts::over(scene, plan.parameter, plan.range)?;
    let seen = match number {
        Some(number) => attractors_from(&shooting, &starts, number, &|| true)?,
        None => attractors_at(&shooting, value, (&starts, plan.starts), &|| true)?,
    };
    Ok(seen.sample())
}

impl Branches {
    /// Adds what runs have reached, and follows the new branches through it.
    pub(super) fn add(
        &mut self,
        shooting: &Shooting,
        seen: Vec<Reached>,
        proceed: &(dyn Fn() -> bool + Sync),
    ) {
        let mut seen: Vec<Reached> = seen.into_iter().filter(|seen| seen.starts > 0).collect();
        let mut known = 0;
        loop {
            // Only among branches that are new since the last round: each motion is compared with each branch once.
            let all = self.branches.len();
            seen.par_iter_mut().for_each(|seen| {
                seen.find(shooting, |own, motion| self.holds_among(own, motion, known..all));
            });
            known = all;
            let Some(next) = seen.iter_mut().find_map(|seen| seen.next(|orbit| self.plan.follows(orbit)))
            else {
                break;
            };
            next.branch = self.follow(&shooting.of_periods(next.periods), &next.motion, proceed);
        }
        self.samples.extend(seen.into_iter().map(Reached::sample));
    }

    /// Values in the gaps without a stable motion, at most `spacing` of the range apart, away from the samples.
    fn unseen(&self, spacing: f64) -> Vec<f64> {
        let [from, to] = self.plan.range;
        let near = spacing * (to - from);
        let [_, gaps] = self.stable_and_irregular();
        let gaps = gaps.iter().filter(|[low, high]| high - low > NARROW * (to - from));
        let inside = gaps.flat_map(|[low, high]| {
            let count = ((high - low) / near).ceil();
            (0..count as usize).map(move |i| low + (i as f64 + 0.5) / count * (high - low))
        });
        inside
            .filter(|value| self.samples.iter().all(|sample| (sample.value - value).abs() > 0.25 * near))
            .collect()
    }

    /// Follows the branch through a motion and those that bifurcate where it gains or loses stability; returns its number.
    pub(super) fn follow(
        &mut self,
        shooting: &Shooting,
        seed: &Solution,
        proceed: &(dyn Fn() -> bool + Sync),
    ) -> Option<usize> {
        if self.branches.len() >= MOST_BRANCHES {
            self.ended = true;
            return None;
        }
        let number = self.branches.len();
        if let Some(measure) = self.plan.crests {
            self.branches.push(crest(shooting, seed, self.plan.range, measure)?);
            return Some(number);
        }
        self.branches.push(trace(shooting, seed, self.plan.range, proceed)?);
        let mut next = number;
        while next < self.branches.len() && self.branches.len() < MOST_BRANCHES {
            let branch = self.branches[next].clone();
            next += 1;
            if 2 * branch.shooting.periods > MOST_PERIODS {
                continue;
            }
            let branches_off = |event: &Event| {
                let stable = |place: usize| branch.points.get(place).is_some_and(Orbit::is_stable);
                let same = stable(event.place.wrapping_sub(1)) == stable(event.place + 1);
                let follows = !same && self.plan.follows(&event.orbit);
                follows.then(|| doubled(&branch.shooting, event, self.plan.range, proceed)).flatten()
            };
            let off: Vec<Branch> = branch.events.par_iter().filter_map(branches_off).collect();
            for off in off {
                let own = off.shooting.clone();
                let known = off.points.get(off.points.len() / 2).and_then(|orbit| {
                    let start = own.unknowns(&orbit.states, orbit.value);
                    self.holds(&own, &own.correct_at_value(&start)?)
                });
                if known.is_none() {
                    self.branches.push(off);
                }
            }
        }
        self.ended |= self.branches.len() >= MOST_BRANCHES;
        Some(number)
    }

    /// The parts of the range over which a branch has a stable motion, and those over which none has.
    pub fn stable_and_irregular(&self) -> [Vec<Interval>; 2] {
        let stable = merged(self.branches.iter().flat_map(stable_parts).collect());
        let [from, to] = self.plan.range;
        let begins = [from].into_iter().chain(stable.iter().map(|part| part[1]));
        let ends = stable.iter().map(|part| part[0]).chain([to]);
        let irregular = begins.zip(ends).filter(|(a, b)| b - a > 1e-9 * (to - from)).map(|(a, b)| [a, b]);
        let irregular = irregular.collect();
        [stable, irregular]
    }
}
