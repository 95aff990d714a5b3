//! The searches of `retention`: a damper tuned for the nominal k1, for other k1, and for the worst over all.

use super::tuned::{Tuned, Tuning, energy, label, over};
use crate::Error;
use crate::designs::Row;
use crate::fronts::SAME;
use crate::pages::over as over_band;
use crate::searches::Searches;
use crate::tune::Optimum;
use retune_model::{Design, Parameter};
use retune_study::{PaperStudy, Setting, SpringBounds, Study, Table2, is_of_paper, short};

/// Tunes one damper for the nominal stiffness, then for each of `others`, first upwards, then downwards, and last for the worst over all.
/// Returns a row for each search.
pub(super) fn tune(
    PaperStudy { damper: name, study, .. }: &PaperStudy,
    options: &Table2,
    others: &[f64],
    searches: &mut Searches,
) -> Result<(Tuned, Vec<Row>), Error> {
    let nominal = study.scene.primary.stiffness.get();
    let mut found: Vec<(f64, Design, Row)> = Vec::new();
    let mut at = |k1: f64, neighbour: Option<(f64, Design)>| -> Result<Design, Error> {
        let study = anew(study, k1, neighbour, options.k2_bounds)?;
        let warm = if neighbour.is_some() { ", and from the design of the k1 beside it" } else { "" };
        let natural = short(study.scene.primary.natural_frequency());
        searches.watch.log(&format!(
            "\n{name} at k1 = {k1} N/m (natural frequency {natural} rad/s), {}{warm}",
            over_band(&study)
        ))?;
        let optimum = searched(study.clone(), options.samples, &format!("k1-{k1}"), searches)?;
        let design = optimum.damper.design_of(study.varied());
        found.push((k1, design, Row::of_optimum(&label(k1), name, &study, &optimum)));
        Ok(design)
    };
    let first = at(nominal, None)?;
    let (mut below, above): (Vec<f64>, Vec<f64>) = others.iter().partition(|k1| **k1 < nominal);
    below.reverse();
    for outwards in [above, below] {
        let mut neighbour = (nominal, first);
        for k1 in outwards.into_iter().filter(|k1| *k1 != nominal) {
            neighbour = (k1, at(k1, Some(neighbour))?);
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (designs, mut rows): (Vec<_>, Vec<_>) =
        found.into_iter().map(|(k1, design, row)| ((k1, design), row)).unzip();
    let mut tuned = Tuned::new(name.clone(), study.clone(), options.samples);
    tuned.kept.extend(study.scene.damper.map(|damper| {
        let tuning = if is_of_paper(&damper) { Tuning::Paper } else { Tuning::Study };
        (tuning, Design::of_varied(&damper, study.varied()))
    }));
    tuned.kept.push((Tuning::Nominal, first));
    if designs.len() > 1 {
        let (study, name) = (robust(study, &designs)?, Tuning::Robust.name());
        searches.watch.log(&format!("\n{} for all k1, {}", tuned.name, over_band(&study)))?;
        let optimum = searched(study.clone(), options.samples, name, searches)?;
        rows.push(Row::of_optimum(name, &tuned.name, &study, &optimum));
        tuned.kept.push((Tuning::Robust, optimum.damper.design_of(study.varied())));
    }
    Ok((Tuned { anew: designs, ..tuned }, rows))
}

/// Runs the search of a study. If E1max of its design is larger on the common samples, the search exploited a gap between its own samples,
/// and the design is refined on the common ones.
fn searched(
    mut study: Study,
    samples: Option<usize>,
    place: &str,
    searches: &mut Searches,
) -> Result<Optimum, Error> {
    let optimum = searches.tune(&study, place)?;
    searches.watch.log(&optimum.report())?;
    let (damper, e1_max) = (optimum.damper, optimum.value());
    let nominal = study.scene.primary.stiffness.get();
    let is_larger = |finer: f64| finer > (1.0 + SAME) * e1_max;
    let at = damper.design_of(study.varied());
    if !energy(&study, samples, &at, nominal).is_some_and(is_larger) {
        return Ok(optimum);
    }
    if let Some(optimize) = &mut study.optimize {
        (optimize.global, optimize.surf) = (None, None);
        optimize.starts = vec![at.only(&optimize.vary)];
        if let Some(band) = &mut optimize.objective.omega {
            band.samples = samples.unwrap_or(band.samples);
        }
    }
    searches
        .watch
        .log(&format!("refined on {} frequencies, on which it rises", samples.unwrap_or_default()))?;
    let optimum = searches.tune(&study, &format!("{place}-finer"))?;
    searches.watch.log(&optimum.report())?;
    Ok(optimum)
}

/// The study at another stiffness, with bounds on k2 scaled or fixed. One more refinement starts at the design of the neighbouring
/// stiffness.
fn anew(study: &Study, k1: f64, from: Option<(f64, Design)>, bounds: SpringBounds) -> Result<Study, Error> {
    let ratio = match bounds {
        SpringBounds::Scaled => k1 / study.scene.primary.stiffness.get(),
        SpringBounds::Fixed => 1.0,
    };
    let mut scaled = study.clone();
    if let Some(optimize) = &mut scaled.optimize {
        if let Some((low, high)) = optimize.bounds.get_mut(Parameter::K2) {
            (*low, *high) = (ratio * *low, high.map(|high| ratio * high));
        }
        let side = optimize.global.as_mut().and_then(|global| global.sides.get_mut(Parameter::K2));
        if let Some(side) = side {
            (side.from, side.to) = (ratio * side.from, ratio * side.to);
        }
        if let Some(axis) = optimize.surf.as_mut().and_then(|axes| axes.get_mut(Parameter::K2)) {
            (axis.from, axis.to) = (ratio * axis.from, ratio * axis.to);
        }
        for start in &mut optimize.starts {
            start.get_mut(Parameter::K2).into_iter().for_each(|k2| *k2 *= ratio);
        }
        if let Some((neighbouring, design)) = from {
            // A spring in proportion to k1 keeps its tuning, within the bounds.
            let bounds = optimize.bounds.get(Parameter::K2).unwrap_or((0.0, None));
            let k2 = design.get(Parameter::K2) * k1 / neighbouring;
            let mut start = design.only(&optimize.vary);
            if let Some(start) = start.get_mut(Parameter::K2) {
                *start = k2.min(bounds.1.unwrap_or(k2)).max(bounds.0);
            }
            optimize.starts.push(start);
        }
    }
    Ok(scaled.with(&[Setting::new(Parameter::K1, k1)])?)
}

/// The study for the worst over all stiffnesses. One more refinement starts at the nominal design.
fn robust(study: &Study, designs: &[(f64, Design)]) -> Result<Study, Error> {
    let all: Vec<f64> = designs.iter().map(|(k1, _)| *k1).collect();
    let nominal = study.scene.primary.stiffness.get();
    let mut study = over(study, &all);
    if let Some(optimize) = &mut study.optimize {
        let nominal_design = designs.iter().find(|(k1, _)| *k1 == nominal);
        optimize.starts.extend(nominal_design.map(|(_, design)| design.only(&optimize.vary)));
    }
    let refuse = Error::rule(&study);
    study.check().map_err(refuse)?;
    Ok(study)
}
