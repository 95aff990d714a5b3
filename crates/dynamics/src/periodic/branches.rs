//! All branches that runs lead to: attractors at samples of a parameter, the branches through them, and those that branch off.

use super::orbit::{Orbit, Seen as Values};
use super::settle::{self, MOST_PERIODS, Settled, is_same, settle};
use super::shooting::{Shooting, Solution};
use super::switch::doubled;
use super::trace::{Branch, trace};
use crate::parameter::{Error, evenly};
use rayon::prelude::*;
use retune_model::{Bare, Parameter, Scene};
use retune_solver::Settings;

/// How far apart runs are started in the gaps without a stable motion, again and again, as shares of the range; with this share of the
/// starts, for runs that do not settle take longest.
pub const SPACINGS: [f64; 2] = [1.0 / 200.0, 1.0 / 400.0];
const FEWER: usize = 4;
/// The narrowest gap that is looked into, as a share of the range.
const NARROW: f64 = 2e-4;
/// Most branches.
const MOST_BRANCHES: usize = 200;
/// A branch as far as this from a motion is not tried, in units of the motion's size.
const FAR: f64 = 0.3;

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
    /// How often the gaps without a stable motion are looked into, more closely each time: at most as often as [`SPACINGS`] says.
    pub looks: usize,
}

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
    pub irregular: Vec<Values>,
    /// Whether the run from rest settled on none.
    pub rest_is_irregular: bool,
    /// Number of starts, that from rest among them.
    pub starts: usize,
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
}

/// A range of the parameter.
pub type Interval = [f64; 2];

/// Finds the branches of a scene along a parameter. Where no stable motion is found, more samples are taken. `done` is called after each
/// sample of the plan.
///
/// # Errors
/// A scene in the range cannot be run.
pub fn branches(
    scene: &Scene,
    plan: Plan,
    settings: &Settings,
    done: impl Fn() + Sync,
) -> Result<Branches, Error> {
    let shooting = equations(scene, &plan, settings)?;
    let mut values = evenly(plan.range[0], plan.range[1], plan.samples);
    let mut found = Branches { plan, branches: Vec::new(), samples: Vec::new() };
    let mut spacings = SPACINGS.iter().take(plan.looks);
    let mut starts = plan.starts;
    loop {
        let look = |&value: &f64| {
            let seen = look(&shooting, value, starts);
            if found.samples.is_empty() {
                done();
            }
            seen
        };
        let seen: Vec<Result<Seen, Error>> = values.par_iter().map(look).collect();
        for seen in seen {
            let sample = seen?.sample(&shooting, |own, solution| {
                found.holds(own, solution).or_else(|| found.follow(own, solution))
            })?;
            found.samples.push(sample);
        }
        let Some(spacing) = spacings.next() else { break };
        (values, starts) = (found.unseen(*spacing), plan.starts.div_ceil(FEWER));
    }
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
    let bare = Bare::new(&middle.primary, &middle.forcing);
    let size = (2.0 * bare.steady(middle.forcing.frequency.get()).e1_max).sqrt().max(f64::MIN_POSITIVE);
    Ok(Shooting::new(middle, plan.parameter, 1, (to - from, size), settings))
}

/// What runs settle on at a value of the parameter, without the branches.
///
/// # Errors
/// A scene cannot be run.
pub fn sample(scene: &Scene, plan: Plan, settings: &Settings, value: f64) -> Result<Sample, Error> {
    let shooting = equations(scene, &plan, settings)?;
    look(&shooting, value, plan.starts)?.sample(&shooting, |_, _| None)
}

/// What runs settle on at a value of the parameter.
struct Seen {
    value: f64,
    /// Periods, the motion, how many starts, whether from rest.
    attractors: Vec<(usize, Solution, usize, bool)>,
    irregular: Vec<Values>,
    rest_is_irregular: bool,
    starts: usize,
}

impl Seen {
    /// As a sample, with the branch that each motion is on.
    fn sample(
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

fn look(shooting: &Shooting, value: f64, starts: usize) -> Result<Seen, Error> {
    let system = shooting.system(value)?;
    let scene = shooting.scene_at(value)?;
    let mut seen = Seen {
        value,
        attractors: Vec::new(),
        irregular: Vec::new(),
        rest_is_irregular: false,
        starts: starts + 1,
    };
    let all = [system.rest()].into_iter().chain(settle::starts(&system, &scene, starts));
    for (number, y) in all.enumerate() {
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

impl Branches {
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

    /// The number of the branch that a motion lies on; none if it is on none.
    pub fn holds(&self, shooting: &Shooting, motion: &Solution) -> Option<usize> {
        let value = shooting.value(&motion.x);
        self.branches.iter().position(|branch| {
            branch.shooting.periods == shooting.periods
                && branch.points.windows(2).any(|pair| {
                    let [a, b] = [pair[0].value, pair[1].value];
                    if (a - value) * (b - value) > 0.0 {
                        return false;
                    }
                    let share = if a == b { 0.0 } else { (value - a) / (b - a) };
                    let [x, y] = [&pair[0], &pair[1]].map(|orbit| shooting.unknowns(&orbit.states, value));
                    let guess = &x + (y - &x) * share;
                    shooting.nearest(&guess, &motion.x).1 < FAR
                        && shooting
                            .correct_at_value(&guess)
                            .is_some_and(|own| is_same(shooting, &own, motion))
                })
        })
    }

    /// Follows the branch through a motion and those that branch off where it gains or loses stability; gives its number.
    fn follow(&mut self, shooting: &Shooting, seed: &Solution) -> Option<usize> {
        if self.branches.len() >= MOST_BRANCHES {
            return None;
        }
        let number = self.branches.len();
        self.branches.push(trace(shooting, seed, self.plan.range)?);
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
                let Some(off) = doubled(&branch.shooting, event, self.plan.range) else { continue };
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
