//! What `branches` finds.

use retune_dynamics::periodic::{Basins, Branches, Onset, Orbit};
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
    /// How much more force it bears, where that was asked for.
    pub margin: Option<Margin>,
    /// Where starts in a plane end, where that was asked for.
    pub basins: Option<Basins>,
}

impl Found {
    /// Of the motions of a study.
    pub(crate) fn new(study: Study, branches: Branches) -> Self {
        Self {
            study,
            largest: branches.largest_of_each(|seen| seen.e1_max),
            branches,
            margin: None,
            basins: None,
        }
    }
}

/// Where the first isola begins.
#[derive(Clone, Debug)]
pub struct Margin {
    /// The scene's own force, N.
    pub own: f64,
    /// Where it is born as the force rises; none up to the largest that was tried.
    pub birth: Option<Onset>,
    /// The largest that was tried.
    pub tried: f64,
}
