//! The result of `branches`, and the margin of the force: how far it can rise before a motion appears that no run from rest leads to.
//!
//! To find the margin, the force is raised in steps until a branch of such motions is found. As the force falls again, each of them
//! vanishes at a fold; the branch is born, as an isola, at the least force of these folds over ω. The search is repeated just below, since
//! another isola may be born earlier.

use crate::Error;
use crate::certify::periodic;
use retune_dynamics::periodic::branches::{Control, branches};
use retune_dynamics::periodic::{Attractor, Basins, Branch, Branches, Onset, Orbit, Sample, onset};
use retune_model::{Measure, Parameter};
use retune_study::{Study, rounded, short};

/// The forces at which motions are searched for, as multiples of the scene's force.
const STEPS: [f64; 10] = [1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0];
/// Force of the repeated search as a share of the birth force, and the largest number of repetitions.
const BELOW: f64 = 0.995;
const ROUNDS: usize = 4;
/// A branch counts if its largest energy exceeds that of all branches reached from rest by this factor.
const NOTABLE: f64 = 1.05;

/// The motions of a study along a parameter.
#[derive(Debug)]
pub struct Motions {
    /// The study.
    pub study: Study,
    /// The motions.
    pub branches: Branches,
    /// The stable motion with the largest E1max of each branch; none for a branch without stable motions.
    pub largest: Vec<Option<Orbit>>,
    /// The margin of the force, if requested.
    pub margin: Option<Margin>,
    /// The basins of starts in a plane, if requested.
    pub basins: Option<Basins>,
}

/// Where the first isola begins.
#[derive(Clone, Debug)]
pub struct Margin {
    /// What the size of the forcing is.
    pub amplitude: Parameter,
    /// That of the scene, in its unit.
    pub own: f64,
    /// The birth of the isola as the amplitude rises; none up to the largest that was tried.
    pub birth: Option<Onset>,
    /// The largest that was tried.
    pub tried: f64,
}

impl Motions {
    /// The motions of a study, without margin and basins.
    pub(crate) fn new(study: Study, branches: Branches) -> Self {
        let largest = branches.largest_of_each(Measure::Energy);
        Self { study, largest, branches, margin: None, basins: None }
    }

    pub(super) fn over(&self) -> Parameter {
        self.branches.plan.parameter
    }

    /// A value of the parameter in words: `omega = 5.98 rad/s`.
    pub(super) fn at(&self, value: f64, digits: usize) -> String {
        let words = format!("{} = {} {}", self.over().symbol(), rounded(value, digits), self.over().unit());
        words.trim_end().to_owned()
    }

    /// The line below a figure.
    pub(super) fn made_by(&self) -> String {
        format!("{}; Retune {}", self.study.name(), env!("CARGO_PKG_VERSION"))
    }

    /// The branches that no run from rest leads to, with a stable motion of more than [`NOTABLE`] times the energy of any branch reached
    /// from rest.
    fn others(&self) -> impl Iterator<Item = &Branch> {
        let energy = |i: usize| self.largest[i].as_ref().map_or(0.0, energy);
        let from_rest = |i: &usize| self.branches.is_reached_from_rest(*i);
        let usual = (0..self.largest.len()).filter(from_rest).map(energy).fold(0.0, f64::max);
        let is_other = move |(i, _): &(usize, &Branch)| !from_rest(i) && energy(*i) > NOTABLE * usual;
        self.branches.branches.iter().enumerate().filter(is_other).map(|(_, branch)| branch)
    }
}

/// The outcome of runs at a sample.
pub(super) struct Settled<'a> {
    pub sample: &'a Sample,
    /// The periodic motion; none for irregular ones.
    pub on: Option<&'a Orbit>,
    pub branch: Option<usize>,
    pub starts: usize,
    pub from_rest: bool,
    /// The largest E1max, J.
    pub energy: f64,
}

impl<'a> Settled<'a> {
    /// The outcomes of a sample: each periodic motion, then all irregular runs together, if any.
    pub fn of(sample: &'a Sample) -> impl Iterator<Item = Self> {
        let periodic = sample.attractors.iter().map(move |one| {
            let Attractor { branch, orbit, starts, from_rest } = one;
            let (on, energy) = (Some(orbit), energy(orbit));
            Self { sample, on, branch: *branch, starts: *starts, from_rest: *from_rest, energy }
        });
        let (starts, from_rest) = (sample.irregular.len(), sample.rest_is_irregular);
        let energy = most_irregular(sample);
        let irregular = Self { sample, on: None, branch: None, starts, from_rest, energy };
        periodic.chain((starts > 0).then_some(irregular))
    }
}

/// [`Settled::of`] all samples.
pub(super) fn settled(motions: &Motions) -> impl Iterator<Item = Settled<'_>> {
    motions.branches.samples.iter().flat_map(Settled::of)
}

/// The largest E1max of the runs of a sample that settle on no periodic motion, J; 0 where there are none.
pub(super) fn most_irregular(sample: &Sample) -> f64 {
    sample.irregular.iter().map(|seen| seen.largest(Measure::Energy)).fold(0.0, f64::max)
}

/// E1max of a motion, J.
pub(super) fn energy(orbit: &Orbit) -> f64 {
    orbit.seen.largest(Measure::Energy)
}

pub(super) fn kind(orbit: &Orbit) -> String {
    periodic(orbit.periods, &orbit.seen.impacts)
}

/// An energy, J, to five digits.
pub(super) fn joule(value: f64) -> String {
    rounded(value, 5)
}

/// The margin of the force; none unless the parameter is ω and the forcing has an amplitude. If such a motion exists at the scene's force
/// already, no larger force is tried.
pub fn margin(motions: &Motions) -> Result<Option<Margin>, Error> {
    let plan = motions.branches.plan;
    let amplitude = motions.study.scene.forcing.amplitude().map(|(amplitude, own)| (amplitude, own.get()));
    let amplitude = amplitude.filter(|(_, own)| *own > 0.0 && plan.parameter == Parameter::Omega);
    let Some((amplitude, own)) = amplitude else { return Ok(None) };
    if motions.others().next().is_some() {
        return Ok(Some(Margin { amplitude, own, birth: None, tried: own }));
    }
    let first_birth = |force: f64| -> Result<Option<Onset>, Error> {
        let scene = amplitude.at(motions.study.scene, force).map_err(retune_dynamics::Error::from)?;
        let there = branches(&scene, plan, &motions.study.solver.settings(), Control::default())?;
        let there = Motions::new(motions.study.clone(), there);
        let births =
            there.others().filter_map(|branch| onset(&branch.seeds(|_| true), amplitude, own, &|_| true));
        Ok(births.min_by(|a, b| a.value.total_cmp(&b.value)))
    };
    for step in STEPS {
        let Some(mut born) = first_birth(step * own)? else { continue };
        for _ in 0..ROUNDS {
            let below = BELOW * born.value;
            match if below > own { first_birth(below)? } else { None } {
                Some(earlier) => born = earlier,
                None => break,
            }
        }
        return Ok(Some(Margin { amplitude, own, birth: Some(born), tried: step * own }));
    }
    Ok(Some(Margin { amplitude, own, birth: None, tried: STEPS[STEPS.len() - 1] * own }))
}

impl Margin {
    /// In words.
    pub fn words(&self) -> String {
        let Self { amplitude, own, birth, tried } = self;
        let unit = amplitude.unit();
        match birth {
            None if tried == own => {
                "A motion that no run from rest leads to, with much more energy, is there at the scene's own force already: it has no margin."
                    .to_owned()
            }
            None => {
                let [times, force] = [tried / own, *tried].map(short);
                format!("No isola was found up to {times} times {amplitude}, {force} {unit}.")
            }
            Some(Onset { value, omega, orbit }) => format!(
                "Up to {} times {amplitude}, {} {unit}, no isola was found; with more, one begins at omega = {} rad/s, {} J ({} \
                 periods, impacts {}).",
                rounded(value / own, 6),
                rounded(*value, 8),
                rounded(*omega, 6),
                joule(energy(orbit)),
                orbit.periods,
                orbit.seen.impacts
            ),
        }
    }
}
