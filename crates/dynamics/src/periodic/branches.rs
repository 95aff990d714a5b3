//! All branches that runs lead to: attractors at samples of a parameter, the branches through them, and those that branch off.

use super::look::{Reached, Sample, look};
use super::orbit::Orbit;
use super::settle::{MOST_PERIODS, most_energy};
use super::shooting::{Shooting, Solution};
use super::switch::doubled;
use super::trace::{Branch, trace};
use crate::parameter::{Error, evenly};
use rayon::prelude::*;
use retune_model::{Parameter, Scene};
use retune_solver::Settings;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};

/// How far apart runs are started in the gaps without a stable motion, again and again, as shares of the range; with this share of the
/// starts, for runs that do not settle take longest.
pub const SPACINGS: [f64; 2] = [1.0 / 200.0, 1.0 / 400.0];
const FEWER: usize = 4;
/// Most periods of motions that Newton's iteration looks for.
const APART: usize = 2;
/// The narrowest gap that is looked into, as a share of the range.
const NARROW: f64 = 2e-4;
/// Most branches.
const MOST_BRANCHES: usize = 200;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The parameter.
    pub parameter: Parameter,
    /// Its range.
    pub range: [f64; 2],
    /// Number of its samples at which runs are started.
    pub samples: usize,
    /// Starts at each, beside that from rest.
    pub starts: usize,
    /// Runs at each sample from whose states Newton's iteration is led to motions of one and two periods other than those known.
    pub apart: usize,
    /// Number of values at which one run more is started, from rest, once the branches through the samples are known.
    pub fine: usize,
    /// How often the gaps without a stable motion are looked into, more closely each time: at most as often as [`SPACINGS`] says.
    pub looks: usize,
}

impl Plan {
    /// A plan without samples and without whatever is looked for beside them.
    pub const fn over(parameter: Parameter, range: [f64; 2]) -> Self {
        Self { parameter, range, samples: 0, starts: 0, apart: 0, fine: 0, looks: 0 }
    }

    /// Starts where runs are started beside the samples.
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
    /// Whether the search was ended before it had found all it could.
    pub ended: bool,
}

/// Who follows a search, and may end it.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Called after each sample of the plan.
    pub done: &'a (dyn Fn() + Sync),
    /// Asked before each run and each motion of a branch: once it is false, no more are made.
    pub goes_on: &'a (dyn Fn() -> bool + Sync),
}

impl Default for Watch<'_> {
    fn default() -> Self {
        Self { done: &|| (), goes_on: &|| true }
    }
}

/// A range of the parameter.
pub type Interval = [f64; 2];

/// Finds the branches of a scene along a parameter. Where no stable motion is found, more samples are taken.
///
/// # Errors
/// A scene in the range cannot be run.
pub fn branches(scene: &Scene, plan: Plan, settings: &Settings, watch: Watch<'_>) -> Result<Branches, Error> {
    let shooting = equations(scene, &plan, settings)?;
    let mut values = evenly(plan.range[0], plan.range[1], plan.samples);
    let mut found = Branches { plan, branches: Vec::new(), samples: Vec::new(), ended: false };
    let ended = AtomicBool::new(false);
    let goes_on = || {
        (watch.goes_on)() || {
            ended.store(true, SeqCst);
            false
        }
    };
    let mut spacings = SPACINGS.iter().take(plan.looks);
    let mut starts = plan.starts;
    loop {
        let first = found.samples.is_empty();
        let look = |&value: &f64| {
            let seen = look(&shooting, value, starts, &goes_on);
            if first {
                (watch.done)();
            }
            seen
        };
        let seen: Vec<Result<Reached, Error>> = values.par_iter().map(look).collect();
        for seen in seen {
            found.add(&shooting, seen?, &goes_on)?;
        }
        if first {
            for periods in 1..=APART {
                found.seek_apart(&shooting, periods, &goes_on)?;
            }
        }
        if ended.load(SeqCst) {
            break;
        }
        let Some(spacing) = spacings.next() else { break };
        (values, starts) = (found.unseen(*spacing), plan.fewer_starts());
    }
    found.seek_from_rest(&shooting, &goes_on)?;
    found.ended = ended.into_inner();
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
    Ok(Shooting::new(middle, plan.parameter, 1, (to - from, size), settings))
}

/// What runs settle on at a value of the parameter, without the branches.
///
/// # Errors
/// A scene cannot be run.
pub fn sample(scene: &Scene, plan: Plan, settings: &Settings, value: f64) -> Result<Sample, Error> {
    let shooting = equations(scene, &plan, settings)?;
    look(&shooting, value, plan.starts, &|| true)?.sample(&shooting, |_, _| None)
}

impl Branches {
    /// Adds what runs have reached, with the branches through it that are new.
    ///
    /// # Errors
    /// A scene cannot be run.
    pub(super) fn add(
        &mut self,
        shooting: &Shooting,
        seen: Reached,
        goes_on: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        if seen.starts > 0 {
            let sample = seen.sample(shooting, |own, motion| {
                self.holds(own, motion).or_else(|| self.follow(own, motion, goes_on))
            })?;
            self.samples.push(sample);
        }
        Ok(())
    }

    /// Values in the gaps without a stable motion, at most `spacing` of the range apart, beside those that have been looked at.
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

    /// Follows the branch through a motion and those that branch off where it gains or loses stability; gives its number.
    pub(super) fn follow(
        &mut self,
        shooting: &Shooting,
        seed: &Solution,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<usize> {
        if self.branches.len() >= MOST_BRANCHES {
            return None;
        }
        let number = self.branches.len();
        self.branches.push(trace(shooting, seed, self.plan.range, goes_on)?);
        let mut next = number;
        while next < self.branches.len() && self.branches.len() < MOST_BRANCHES {
            let branch = self.branches[next].clone();
            next += 1;
            if 2 * branch.shooting.periods > MOST_PERIODS {
                continue;
            }
            for event in &branch.events {
                let stable = |place: Option<usize>| {
                    place.and_then(|place| branch.points.get(place)).is_some_and(Orbit::is_stable)
                };
                if stable(event.place.checked_sub(1)) == stable(Some(event.place + 1)) {
                    continue;
                }
                let Some(off) = doubled(&branch.shooting, event, self.plan.range, goes_on) else { continue };
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
        Some(number)
    }

    /// The parts of the range over which a branch has a stable motion, and those over which none has.
    pub fn stable_and_irregular(&self) -> [Vec<Interval>; 2] {
        let mut parts: Vec<Interval> = Vec::new();
        for branch in &self.branches {
            let pairs = branch.points.windows(2).enumerate();
            for (_, pair) in pairs.filter(|(i, _)| branch.is_stable_after(*i)) {
                let [a, b] = [pair[0].value, pair[1].value];
                parts.push([a.min(b), a.max(b)]);
            }
        }
        parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut stable: Vec<Interval> = Vec::new();
        for part in parts {
            match stable.last_mut() {
                Some(last) if part[0] <= last[1] => last[1] = last[1].max(part[1]),
                _ => stable.push(part),
            }
        }
        let [from, to] = self.plan.range;
        let begins = [from].into_iter().chain(stable.iter().map(|part| part[1]));
        let ends = stable.iter().map(|part| part[0]).chain([to]);
        let narrow = 1e-9 * (to - from);
        let irregular = begins.zip(ends).filter(|(a, b)| b - a > narrow).map(|(a, b)| [a, b]).collect();
        [stable, irregular]
    }
}
