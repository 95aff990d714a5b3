//! The objective of a study as searches call it.

use crate::Observer;
use retune_model::{Design, Measure, Positive};
use retune_optim::{DesignObjective, Evaluation, Goal, Limit, Limits, Parameter};
use retune_solver::Settings;
use retune_store::Journal;
use retune_study::{Search, Study};

/// A search, with the journal that keeps its values under names that begin with `place`, and who hears of it.
#[derive(Clone, Copy)]
pub(crate) struct Task<'a> {
    pub study: &'a Study,
    pub search: &'a Search,
    pub journal: &'a Journal,
    pub place: &'a str,
    pub watch: &'a dyn Observer,
}

/// An objective as searches call it: values in the journal are not computed again; `on_known` is called for each of them.
pub fn kept<'a>(
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

/// The same at the tolerance of searches.
pub fn searched(study: &Study, search: &Search, variables: &[Parameter]) -> DesignObjective {
    with(study, search, variables, study.goal(), study.solver.searching()).following()
}

/// The same at a relative tolerance, or at that of searches where it is looser.
pub fn loose(study: &Study, search: &Search, variables: &[Parameter], rtol: f64) -> DesignObjective {
    let own = study.solver.searching();
    let settings = Settings { rtol: own.rtol.max(rtol), ..own };
    with(study, search, variables, study.goal(), settings).following()
}

/// The same as exact as the study wants its grid: at the tolerance of `optimize.coarse`, and on samples alone if it says so.
pub(crate) fn coarse(study: &Study, search: &Search, variables: &[Parameter]) -> DesignObjective {
    let (said, own) = (study.coarse(), study.solver.searching());
    let settings = Settings { rtol: said.rtol.unwrap_or(own.rtol), ..own };
    with(study, search, variables, Goal { peaks: said.peaks, ..study.goal() }, settings).following()
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

/// A study with a design in its scene, its band on so many samples; none where there is no such scene.
pub(crate) fn finer(study: &Study, samples: usize, at: &Design) -> Option<Study> {
    let mut study = study.clone();
    study.scene = study.scene_at(at)?;
    if let Some(band) = study.optimize.as_mut().and_then(|optimize| optimize.objective.omega.as_mut()) {
        band.samples = samples;
    }
    Some(study)
}

/// The worst of the scene of a study over its band; none where it cannot be run.
pub(crate) fn worst(study: &Study) -> Option<Evaluation> {
    // Limits that every run breaks: they have the largest stroke and force searched for, peaks between samples included.
    let mut goal = study.goal();
    let least = Positive::new(f64::MIN_POSITIVE).ok()?;
    let none = Limits::default().since(goal.limits.from);
    goal.limits =
        Measure::OF_DAMPER.into_iter().fold(none, |limits, measure| limits.with(Limit::Of(measure), least));
    goal.evaluate(&study.scene, &study.solver.settings(), f64::INFINITY).ok()
}
