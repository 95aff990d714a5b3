//! What `branches` finds.

use retune_dynamics::periodic::branches::{Attractor, Sample};
use retune_dynamics::periodic::{Branches, Orbit, largest};
use retune_study::Study;

/// The motions of a study along a parameter.
#[derive(Debug)]
pub struct Found {
    /// The study.
    pub study: Study,
    /// The motions.
    pub branches: Branches,
    /// The stable motion with the largest E1max of each branch; none of a branch without stable motions.
    pub largest: Vec<Option<Orbit>>,
}

impl Found {
    /// Of the motions of a study.
    pub(crate) fn new(study: Study, branches: Branches) -> Self {
        let largest = branches.branches.iter().map(|branch| largest(branch, |orbit| orbit.seen.e1_max));
        Self { study, largest: largest.collect(), branches }
    }

    /// The samples at which runs settle on a branch, each with the motion.
    pub(crate) fn on(&self, number: usize) -> impl Iterator<Item = (&Sample, &Attractor)> {
        let samples = self.branches.samples.iter();
        let all = samples.flat_map(|sample| sample.attractors.iter().map(move |one| (sample, one)));
        all.filter(move |(_, one)| one.branch == Some(number))
    }

    /// Whether a run from rest that was made settles on a branch.
    pub(crate) fn is_reached_from_rest(&self, number: usize) -> bool {
        self.on(number).any(|(_, one)| one.from_rest)
    }
}
