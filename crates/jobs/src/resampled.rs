//! A design on other samples of the band than those of its search.

use retune_model::{Design, Measure, Positive};
use retune_optim::{Evaluation, Limit, Limits};
use retune_study::Study;

/// The value of a design as it stands in the tables: the worst over the band of its study on so many samples.
pub fn value(study: &Study, samples: usize, at: &Design) -> Option<f64> {
    Some(worst(&finer(study, samples, at)?)?.value)
}

/// A study with a design in its scene, its band on so many samples; none where there is no such scene.
pub fn finer(study: &Study, samples: usize, at: &Design) -> Option<Study> {
    let mut study = study.clone();
    study.scene = study.scene_at(at)?;
    if let Some(band) = study.optimize.as_mut().and_then(|optimize| optimize.objective.omega.as_mut()) {
        band.samples = samples;
    }
    Some(study)
}

/// The worst of the scene of a study over its band; none where it cannot be run.
pub fn worst(study: &Study) -> Option<Evaluation> {
    // Limits that every run breaks: they have the largest stroke and force searched for, peaks between samples included.
    let mut goal = study.goal();
    let least = Positive::new(f64::MIN_POSITIVE).ok()?;
    let none = Limits::default().since(goal.limits.from);
    goal.limits =
        Measure::OF_DAMPER.into_iter().fold(none, |limits, measure| limits.with(Limit::Of(measure), least));
    goal.evaluate(&study.scene, &study.solver.settings(), f64::INFINITY).ok()
}
