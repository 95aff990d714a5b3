//! The refinement of one design under a bound.

use retune_model::{Design, Variable};
use retune_optim::minimize;
use retune_study::{Optimize, PerVariable, Study, Sweep};
use retune_workbench::Error;
use retune_workbench::searches::Searches;
use retune_workbench::tune::objective::{kept, objective};
use std::ops::ControlFlow;

/// `fminsearch` starts again where it ended, with a whole simplex, at most so often,
const RESTARTS: usize = 2;
/// and as long as it gains this share: where motions are irregular, it often ends early.
const GAIN: f64 = 3e-3;

/// What is done under one bound.
#[derive(Clone, Copy)]
pub(super) struct Under {
    /// The number of the damper.
    pub damper: usize,
    /// The bounded quantity.
    pub sweep: Sweep,
    /// The bound, in the unit of the sweep.
    pub bound: f64,
}

/// The end of a refinement by the rules of a study, and its value; with one parameter held at a value, if asked for.
pub(super) fn minimum(
    study: &Study,
    start: &PerVariable<f64>,
    held: Option<(Variable, f64)>,
    Under { damper, sweep, bound }: Under,
    searches: &Searches,
) -> Result<Option<(Design, f64)>, Error> {
    let mut study = study.clone();
    let mut start = *start;
    if let (Some((variable, value)), Some(optimize)) = (held, &mut study.optimize) {
        optimize.vary.retain(|other| *other != variable);
        *optimize.bounds.get_mut(variable) = None;
        *start.get_mut(variable) = None;
        let design = study.scene.damper.map(|damper| Design::of(&damper));
        let moved = |design: Design| {
            Design::new(|other| if other == variable { value } else { design.get(other) }).ok()
        };
        if let Some(scene) = design.and_then(moved).and_then(|design| study.scene_at(&design)) {
            study.scene = scene;
        }
    }
    let samples = if let Some(optimize) = &mut study.optimize {
        (optimize.global, optimize.surf) = (None, None);
        optimize.starts = vec![start];
        optimize.objective.omega.map_or(0, |band| band.samples)
    } else {
        0
    };
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let of = objective(&study, &search, &search.variables);
    let limit = if sweep == Sweep::K2 { 0.0 } else { bound };
    let held = held.map_or(String::new(), |(variable, _)| format!(" {variable}"));
    // The stage names the objective in the journal: a bound on k2 does not change it, a limit does.
    let stage = format!("{damper} {} {limit} {samples}{held}", sweep.name());
    let value = kept(&of, searches.journal(), &stage, || ());
    let Some(at) = search.given.first() else { return Ok(None) };
    if !value(at, f64::INFINITY).is_finite() {
        return Ok(None);
    }
    let (mut x, mut least) = (at.clone(), f64::INFINITY);
    for _ in 0..RESTARTS {
        let found = minimize(&value, &x, search.options.clone(), |_| ControlFlow::Continue(()))
            .map_err(|source| Error::Search { source, failures: of.failures() })?;
        searches.journal().check()?;
        let gains = found.value < (1.0 - GAIN) * least;
        (x, least) = (found.x, found.value);
        if !gains {
            break;
        }
    }
    Ok(Some((Design::of(&of.damper(&x)?), least)))
}

/// A design moved into the bounds of a search.
pub(super) fn clipped(at: &Design, optimize: &Optimize) -> PerVariable<f64> {
    let mut start = PerVariable::default();
    for &variable in &optimize.vary {
        let (low, high) = optimize.bounds.get(variable).unwrap_or((0.0, None));
        let value = at.get(variable);
        *start.get_mut(variable) = Some(value.min(high.unwrap_or(value)).max(low));
    }
    start
}

/// Sets the samples of the band of a study.
pub(super) fn set_samples(study: &mut Study, samples: usize) {
    if let Some(band) = study.optimize.as_mut().and_then(|optimize| optimize.objective.omega.as_mut()) {
        band.samples = samples;
    }
}

/// Refines the samples of the band of a study, those that it has among them.
pub(super) fn scale_samples(study: &mut Study, by: usize) {
    if let Some(band) = study.objective().omega {
        set_samples(study, by * (band.samples - 1) + 1);
    }
}
