//! The objective of a study as searches call it.

use crate::Observer;
use retune_model::{Design, Measure, Positive};
use retune_optim::{DesignObjective, Evaluation, Goal, Limit, Limits, Parameter};
use retune_solver::Settings;
use retune_store::Journal;
use retune_study::{Search, Study};

/// A search, with the journal that keeps its values under names that begin with `place`, and its observer.
#[derive(Clone, Copy)]
pub(crate) struct Task<'a> {
    pub study: &'a Study,
    pub search: &'a Search,
    pub journal: &'a Journal,
    pub place: &'a str,
    pub watch: &'a dyn Observer,
}

/// An objective as searches call it: values in the journal are reused, and `on_known` is called for each of them.
pub fn journaled<'a>(
    objective: &'a DesignObjective,
    journal: &'a Journal,
    stage: &'a str,
    on_known: impl Fn() + Sync + 'a,
) -> impl Fn(&[f64], f64) -> f64 + Sync + 'a {
    move |design, cutoff| {
        let known = |value| {
            on_known();
            objective.recall(value);
        };
        journal.value(stage, design, cutoff, || objective.value(design, cutoff), known)
    }
}

/// The objective of a study over some parameters of its damper.
pub fn objective(study: &Study, search: &Search, variables: &[Parameter]) -> DesignObjective {
    with(study, search, variables, study.goal(), study.solver.settings())
}

/// The objective at the tolerance of searches.
pub fn searched(study: &Study, search: &Search, variables: &[Parameter]) -> DesignObjective {
    with(study, search, variables, study.goal(), study.solver.searching()).following()
}

/// The objective at the relative tolerance `rtol`, or at that of searches where that is looser.
pub fn loose(study: &Study, search: &Search, variables: &[Parameter], rtol: f64) -> DesignObjective {
    let searching = study.solver.searching();
    let settings = Settings { rtol: searching.rtol.max(rtol), ..searching };
    with(study, search, variables, study.goal(), settings).following()
}

/// The objective as the grid uses it: at the tolerance of `optimize.coarse`, and without the peaks between samples if it says so.
pub(crate) fn coarse(study: &Study, search: &Search, variables: &[Parameter]) -> DesignObjective {
    let (grid, searching) = (study.coarse(), study.solver.searching());
    let settings = Settings { rtol: grid.rtol.unwrap_or(searching.rtol), ..searching };
    with(study, search, variables, Goal { peaks: grid.peaks, ..study.goal() }, settings).following()
}

fn with(
    study: &Study,
    search: &Search,
    variables: &[Parameter],
    goal: Goal,
    settings: Settings,
) -> DesignObjective {
    DesignObjective::new(study.scene, search.damper, variables.to_vec(), goal, settings)
}

/// A study with a design in its scene and its band on `samples` frequencies; none where the design is not valid.
pub(crate) fn with_samples(study: &Study, samples: usize, at: &Design) -> Option<Study> {
    let mut study = study.clone();
    study.scene = study.scene_at(at)?;
    if let Some(band) = study.optimize.as_mut().and_then(|optimize| optimize.objective.omega.as_mut()) {
        band.samples = samples;
    }
    Some(study)
}

/// The worst case of a study's scene over its band; none where it cannot be run.
pub(crate) fn worst(study: &Study) -> Option<Evaluation> {
    // Limits that every run breaks, so that the largest stroke and force are evaluated, peaks between samples included.
    let mut goal = study.goal();
    let least = Positive::new(f64::MIN_POSITIVE).ok()?;
    let none = Limits::default().since(goal.limits.from);
    goal.limits =
        Measure::OF_DAMPER.into_iter().fold(none, |limits, measure| limits.with(Limit::Of(measure), least));
    goal.evaluate(&study.scene, &study.solver.settings(), f64::INFINITY).ok()
}
