//! The largest value of a quantity over all motions of a scene in a range of a parameter: exact on branches of stable periodic motions, and
//! from runs where no such branch is known.

use super::attractors::{Attractor, Sample};
use super::branches::{Branches, Control, Interval, Plan, branches};
use super::largest::{largest, stable_ranges};
use super::orbit::Orbit;
use super::seen::Seen;
use crate::parameter::Error;
use retune_model::{Measure, Scene};
use retune_solver::Settings;

/// A gap without a stable motion is reported if it is wider than this share of the range.
const NARROW: f64 = 1e-3;

/// The motion with the largest value.
#[derive(Clone, Debug, PartialEq)]
pub struct Largest {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// Where it is, in the parameter's unit.
    pub at: f64,
    /// The motion; none for a run that did not settle.
    pub orbit: Option<Orbit>,
    /// A state of it at a crest of the force.
    pub start: [f64; 4],
    /// Whether any run from rest ends on its branch; for an irregular motion, whether the run from rest did not settle.
    pub from_rest: bool,
    /// The share of starts that lead there.
    pub share: Share,
}

/// How many starts end on a motion or its branch, of those that were made where it is stable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Number of starts that end there.
    pub ends: usize,
    /// Number of all starts.
    pub starts: usize,
    /// The least and the largest value of the parameter at which it is stable.
    pub within: Interval,
}

impl Share {
    /// As a number; 0 where no start was made.
    pub fn of_starts(&self) -> f64 {
        if self.starts == 0 { 0.0 } else { self.ends as f64 / self.starts as f64 }
    }
}

/// The motions in a range.
#[derive(Clone, Debug, PartialEq)]
pub struct Motions {
    /// The largest value of each measure asked for; none where nothing was found.
    pub largest: Vec<Option<Largest>>,
    /// The share of the range over which a stable periodic motion is known.
    pub covered: f64,
    /// The parts over which none is known, and the largest value of the first measure in the runs there that did not settle.
    pub irregular: Vec<(Interval, f64)>,
}

/// Finds the motions of a scene in the range of a plan, which may be one value, and the largest values of some measures over them.
///
/// # Errors
/// A scene in the range cannot be run.
pub fn motions(
    scene: &Scene,
    plan: Plan,
    settings: &Settings,
    measures: &[Measure],
) -> Result<Motions, Error> {
    Ok(Motions::of(&branches(scene, plan, settings, Control::default())?, measures))
}

impl Motions {
    /// Summarises the branches found.
    pub fn of(found: &Branches, measures: &[Measure]) -> Self {
        let [from, to] = found.plan.range;
        let first = |seen: &Seen| measures.first().map_or(0.0, |measure| seen.largest(*measure));
        let largest = measures.iter().map(|measure| found.largest(*measure)).collect();
        if from == to {
            let is_stable = found.samples.iter().any(|sample| !sample.attractors.is_empty());
            let runs = found.samples.iter().flat_map(|sample| &sample.irregular);
            let runs = runs.map(first).max_by(f64::total_cmp);
            let irregular = runs.filter(|_| !is_stable).map(|runs| ([from, to], runs)).into_iter().collect();
            return Self { largest, covered: f64::from(u8::from(is_stable)), irregular };
        }
        let [stable, irregular] = found.stable_and_irregular();
        let covered = stable.iter().map(|[low, high]| high - low).sum::<f64>() / (to - from) + 0.0; // an empty sum is -0
        let irregular = irregular.into_iter().filter(|[low, high]| high - low > NARROW * (to - from));
        let irregular = irregular.map(|[low, high]| {
            let within = |sample: &&Sample| sample.value >= low && sample.value <= high;
            let runs = found.samples.iter().filter(within).flat_map(|sample| &sample.irregular);
            ([low, high], runs.map(first).fold(0.0, f64::max))
        });
        Self { largest, covered, irregular: irregular.collect() }
    }
}

/// The width, as a share of a range, of a motion to which `share` of all starts lead, at which `starts` starts, independent and uniform
/// over the range, all miss it with the probability `missed`: `(1 - share width)^starts = missed`.
pub fn width_missed(starts: usize, share: f64, missed: f64) -> f64 {
    (1.0 - missed.powf(1.0 / starts as f64)) / share
}

impl Sample {
    /// The largest value at this sample.
    fn largest(&self, measure: Measure) -> Option<Largest> {
        let share = |ends: usize| Share { ends, starts: self.starts, within: [self.value; 2] };
        let periodic = self.attractors.iter().map(|Attractor { orbit, starts, from_rest, .. }| Largest {
            value: orbit.seen.largest(measure),
            at: self.value,
            start: orbit.seen.start,
            orbit: Some(orbit.clone()),
            from_rest: *from_rest,
            share: share(*starts),
        });
        let most = self.irregular.iter().max_by(|a, b| a.largest(measure).total_cmp(&b.largest(measure)));
        let irregular = most.map(|most| Largest {
            value: most.largest(measure),
            start: most.start,
            at: self.value,
            orbit: None,
            from_rest: self.rest_is_irregular,
            share: share(self.irregular.len()),
        });
        periodic.chain(irregular).max_by(|a, b| a.value.total_cmp(&b.value))
    }
}

impl Branches {
    /// The samples at which runs settle on a branch, each with the motion.
    pub fn on(&self, number: usize) -> impl Iterator<Item = (&Sample, &Attractor)> {
        let all =
            self.samples.iter().flat_map(|sample| sample.attractors.iter().map(move |one| (sample, one)));
        all.filter(move |(_, one)| one.branch == Some(number))
    }

    /// The share of starts over the range that end on a branch, of those where it has stable motions.
    pub fn share(&self, number: usize) -> Share {
        let ranges = stable_ranges(&self.branches[number]);
        let is_within = |value: f64| ranges.iter().any(|[low, high]| (*low..=*high).contains(&value));
        let all = self.samples.iter().filter(|sample| sample.number.is_some() && is_within(sample.value));
        let ends = |sample: &&Sample| sample.attractors.iter().any(|one| one.branch == Some(number));
        let within = ranges
            .iter()
            .fold([f64::MAX, f64::MIN], |[low, high], part| [low.min(part[0]), high.max(part[1])]);
        Share { ends: all.clone().filter(ends).count(), starts: all.count(), within }
    }

    /// Sets the share of an irregular motion: that of the runs that do not settle, over the part of the range without a stable motion
    /// around it.
    fn irregular_share(&self, one: Largest) -> Largest {
        let [_, irregular] = self.stable_and_irregular();
        let Some([low, high]) = irregular.into_iter().find(|[low, high]| (*low..=*high).contains(&one.at))
        else {
            return one;
        };
        let all = self.samples.iter().filter(|sample| (low..=high).contains(&sample.value));
        let ends = all.clone().map(|sample| sample.irregular.len()).sum();
        Largest {
            share: Share { ends, starts: all.map(|sample| sample.starts).sum(), within: [low, high] },
            ..one
        }
    }

    /// Whether any run from rest settles on a branch.
    pub fn is_reached_from_rest(&self, number: usize) -> bool {
        self.on(number).any(|(_, one)| one.from_rest)
    }

    /// The stable motion with the largest value of a measure on each branch; none for a branch without stable motions.
    pub fn largest_of_each(&self, measure: Measure) -> Vec<Option<Orbit>> {
        self.branches.iter().map(|branch| largest(branch, |orbit| orbit.seen.largest(measure))).collect()
    }

    /// The largest value of a measure over the range.
    pub fn largest(&self, measure: Measure) -> Option<Largest> {
        let all = self.largest_of_each(measure).into_iter().enumerate();
        let on_branches = all.filter_map(|(number, orbit)| {
            let orbit = orbit?;
            Some(Largest {
                value: orbit.seen.largest(measure),
                at: orbit.value,
                from_rest: self.is_reached_from_rest(number),
                share: self.share(number),
                start: orbit.seen.start,
                orbit: Some(orbit),
            })
        });
        let others = self.samples.iter().flat_map(|sample| {
            // Motions whose branch could not be followed, and irregular ones, count at the samples.
            let alone = sample.attractors.iter().any(|one| one.branch.is_none());
            (alone || !sample.irregular.is_empty()).then(|| sample.largest(measure)).flatten()
        });
        let others = others.map(|one| if one.orbit.is_none() { self.irregular_share(one) } else { one });
        on_branches.chain(others).max_by(|a, b| a.value.total_cmp(&b.value))
    }
}
