//! The largest value of a quantity over all motions of a scene in a range of a parameter: exact on branches of stable periodic motions, and of
//! runs where none is known.

use super::branches::{Branches, Interval, Plan, Watch, branches, sample};
use super::largest::largest;
use super::look::{Attractor, Sample};
use super::orbit::Orbit;
use super::seen::Seen;
use crate::parameter::Error;
use retune_model::{Measure, Scene};
use retune_solver::Settings;

/// A range without a stable motion is named if it is wider than this share of the range.
const NARROW: f64 = 1e-3;

/// The motion with the largest value.
#[derive(Clone, Debug, PartialEq)]
pub struct Largest {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// Where it is, in the parameter's unit.
    pub at: f64,
    /// The motion; none of a run that did not settle.
    pub orbit: Option<Orbit>,
    /// Whether runs from rest that were made end on its branch, or did not settle either.
    pub from_rest: bool,
    /// The largest share of the starts at one value of the parameter that end on its branch.
    pub share: f64,
}

/// What motions there are in a range.
#[derive(Clone, Debug, PartialEq)]
pub struct Motions {
    /// The largest value of each quantity asked for; none where nothing was found.
    pub largest: Vec<Option<Largest>>,
    /// The share of the range over which a stable periodic motion is known.
    pub covered: f64,
    /// The parts over which none is, and the largest value of the first quantity in the runs that were made there.
    pub irregular: Vec<(Interval, f64)>,
}

/// How a motion has a quantity.
pub fn quantity(measure: Measure) -> fn(&Seen) -> f64 {
    match measure {
        Measure::Energy => |seen| seen.e1_max,
        Measure::Displacement => |seen| seen.displacement,
        Measure::Velocity => |seen| seen.velocity,
        Measure::Acceleration => |seen| seen.acceleration,
        Measure::GroundForce => |seen| seen.ground_force,
        Measure::Stroke => |seen| seen.stroke,
        Measure::ContactForce => |seen| seen.force,
    }
}

/// Finds the motions of a scene in the range of a plan, which may be one value, and the largest values of some quantities over them.
///
/// # Errors
/// A scene in the range cannot be run.
pub fn motions(
    scene: &Scene,
    plan: Plan,
    settings: &Settings,
    quantities: &[fn(&Seen) -> f64],
) -> Result<Motions, Error> {
    let [from, to] = plan.range;
    if from == to {
        let found = sample(scene, plan, settings, from)?;
        let covered = if found.attractors.is_empty() { 0.0 } else { 1.0 };
        let of = |quantity: &fn(&Seen) -> f64| found.largest(*quantity);
        let largest: Vec<_> = quantities.iter().map(of).collect();
        let runs = largest.first().cloned().flatten().filter(|_| covered == 0.0);
        let irregular = runs.map(|runs| ([from, to], runs.value)).into_iter().collect();
        return Ok(Motions { largest, covered, irregular });
    }
    let found = branches(scene, plan, settings, Watch::default())?;
    let [stable, irregular] = found.stable_and_irregular();
    let covered = stable.iter().map(|[low, high]| high - low).sum::<f64>() / (to - from);
    let irregular = irregular.into_iter().filter(|[low, high]| high - low > NARROW * (to - from));
    let irregular = irregular.map(|[low, high]| {
        let within = |sample: &&Sample| sample.value >= low && sample.value <= high;
        let runs = found.samples.iter().filter(within).flat_map(|sample| &sample.irregular);
        ([low, high], quantities.first().map_or(0.0, |quantity| runs.map(quantity).fold(0.0, f64::max)))
    });
    Ok(Motions {
        largest: quantities.iter().map(|quantity| found.largest(*quantity)).collect(),
        covered,
        irregular: irregular.collect(),
    })
}

impl Sample {
    /// The largest value at this sample.
    fn largest(&self, quantity: fn(&Seen) -> f64) -> Option<Largest> {
        let share = |starts: usize| starts as f64 / self.starts as f64;
        let periodic = self.attractors.iter().map(|Attractor { orbit, starts, from_rest, .. }| Largest {
            value: quantity(&orbit.seen),
            at: self.value,
            orbit: Some(orbit.clone()),
            from_rest: *from_rest,
            share: share(*starts),
        });
        periodic.chain(self.irregular(quantity)).max_by(|a, b| a.value.total_cmp(&b.value))
    }

    /// The largest value of the runs that did not settle.
    fn irregular(&self, quantity: fn(&Seen) -> f64) -> Option<Largest> {
        let most = self.irregular.iter().map(quantity).max_by(f64::total_cmp)?;
        Some(Largest {
            value: most,
            at: self.value,
            orbit: None,
            from_rest: self.rest_is_irregular,
            share: self.irregular.len() as f64 / self.starts as f64,
        })
    }
}

impl Branches {
    /// The samples at which runs settle on a branch, each with the motion.
    pub fn on(&self, number: usize) -> impl Iterator<Item = (&Sample, &Attractor)> {
        let all =
            self.samples.iter().flat_map(|sample| sample.attractors.iter().map(move |one| (sample, one)));
        all.filter(move |(_, one)| one.branch == Some(number))
    }

    /// Whether a run from rest that was made settles on a branch.
    pub fn is_reached_from_rest(&self, number: usize) -> bool {
        self.on(number).any(|(_, one)| one.from_rest)
    }

    /// The stable motion with the largest value of a quantity on each branch; none of a branch without stable motions.
    pub fn largest_of_each(&self, quantity: fn(&Seen) -> f64) -> Vec<Option<Orbit>> {
        self.branches.iter().map(|branch| largest(branch, |orbit| quantity(&orbit.seen))).collect()
    }

    /// The largest value of a quantity over the range.
    pub fn largest(&self, quantity: fn(&Seen) -> f64) -> Option<Largest> {
        let all = self.largest_of_each(quantity).into_iter().enumerate();
        let on_branches = all.filter_map(|(number, orbit)| {
            let orbit = orbit?;
            let shares = self.on(number).map(|(sample, one)| one.starts as f64 / sample.starts as f64);
            Some(Largest {
                value: quantity(&orbit.seen),
                at: orbit.value,
                from_rest: self.is_reached_from_rest(number),
                share: shares.fold(0.0, f64::max),
                orbit: Some(orbit),
            })
        });
        let others = self.samples.iter().flat_map(|sample| {
            // A motion whose branch could not be followed counts where it was met.
            let alone = sample.attractors.iter().any(|one| one.branch.is_none());
            [if alone { sample.largest(quantity) } else { None }, sample.irregular(quantity)]
        });
        on_branches.chain(others.flatten()).max_by(|a, b| a.value.total_cmp(&b.value))
    }
}
