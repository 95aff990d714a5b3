//! The descent of one design under a bound.

use retune_model::{Design, Variable};
use retune_optim::{Side, Space, minimax};
use retune_store::Journal;
use retune_study::{Optimize, PerVariable, Study, Sweep};
use retune_workbench::Error;
use retune_workbench::tune::objective::searched;
use std::cell::OnceCell;

/// What is done under one bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Under {
    /// The number of the damper.
    pub damper: usize,
    /// The bounded quantity.
    pub sweep: Sweep,
    /// The bound, in the unit of the sweep.
    pub bound: f64,
}

/// Share of E1max below which a step of a descent is not worth its runs.
const EXACT: f64 = 1e-5;
/// Where a side of the box ends that has no upper bound: so many times the start, or at one unit.
const WIDE: f64 = 4.0;

/// The design at the foot of the slope from `start` by the objective and within the bounds of a study; none where there is no way down. The
/// journal keeps it.
///
/// # Errors
/// The study breaks a rule.
pub(super) fn descend(
    study: &Study,
    start: &PerVariable<f64>,
    under: Under,
    journal: &Journal,
) -> Result<Option<Design>, Error> {
    let mut study = study.clone();
    let mut samples = 0;
    if let Some(optimize) = &mut study.optimize {
        (optimize.global, optimize.surf) = (None, None);
        optimize.starts = vec![*start];
        samples = optimize.objective.omega.map_or(0, |band| band.samples);
    }
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let Some(at) = search.given.first() else { return Ok(None) };
    let side = |(bounds, at): (&retune_optim::Bounds, &f64)| {
        Side::natural(bounds.lower.unwrap_or(0.0), bounds.upper.unwrap_or((WIDE * at).max(1.0)))
    };
    let space = Space(search.options.bounds.iter().zip(at).map(side).collect());
    let of = searched(&study, &search, &search.variables);
    let found = OnceCell::new();
    let go = || {
        found.get_or_init(|| {
            minimax(|x, most| of.look(x, most), |x, runs| of.pieces(x, runs), &space, at, EXACT)
        })
    };
    let Under { damper, sweep, bound } = under;
    let end = (0..at.len()).map(|i| {
        let stage = format!("{damper} {} {bound} {samples} {i}", sweep.name());
        journal.value(&stage, at, f64::INFINITY, || go().0[i], |_| ())
    });
    let end: Vec<f64> = end.collect();
    let at = of.damper(&end).ok();
    Ok(at.map(|damper| Design::of(&damper)))
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

/// The starts about a design: itself, and each copy with a gap at its lower bound that is this near to it, as a share of the side.
pub(super) fn starts(at: &Design, optimize: &Optimize) -> Vec<PerVariable<f64>> {
    const NEAR: f64 = 0.05;
    let own = clipped(at, optimize);
    let at_bound = |variable: Variable| {
        let value = own.get(variable)?;
        let (low, high) = optimize.bounds.get(variable).unwrap_or((0.0, None));
        let is_near = value > low && value - low < NEAR * (high.unwrap_or(f64::INFINITY) - low).min(1.0);
        let mut start = own;
        *start.get_mut(variable) = Some(low);
        is_near.then_some(start)
    };
    [own].into_iter().chain([Variable::D, Variable::C].into_iter().filter_map(at_bound)).collect()
}

/// Places about a design: along each parameter by a twentieth of its side of the box, where it has two ends, or of its value.
pub(super) fn about(at: &Design, optimize: &Optimize) -> Vec<Design> {
    const FAR: f64 = 0.05;
    let moved = |variable: Variable, sign: f64| {
        let value = at.get(variable);
        let (low, high) = optimize.bounds.get(variable).unwrap_or((0.0, None));
        let side = high.map_or(value, |high| (high - low).min(value.max(1.0)));
        Design::new(
            |other| if other == variable { (value + sign * FAR * side).max(low) } else { at.get(other) },
        )
        .ok()
    };
    optimize
        .vary
        .iter()
        .flat_map(|&variable| [-1.0, 1.0].into_iter().filter_map(move |sign| moved(variable, sign)))
        .collect()
}

/// Sets the samples of the band of a study.
pub(super) fn set_samples(study: &mut Study, samples: usize) {
    if let Some(band) = study.optimize.as_mut().and_then(|optimize| optimize.objective.omega.as_mut()) {
        band.samples = samples;
    }
}
