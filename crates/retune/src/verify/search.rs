//! The results of one study: the rows of its search, its band, the design it found, its certificate.

use super::table::Sample;
use super::{Check, Report, text};
use crate::error::Error;
use crate::optimize::{band, objective};
use crate::study::{self, Setting, Study};
use retune_model::{NonNegative, Scene};
use retune_optim::{PeakEnergy, Variable};
use serde_json::Value;
use std::path::Path;

/// The curves of a band: without damper, with that of the study, with the best.
const CURVES: usize = 3;

/// Looks at the results of a search again, at `most` rows of a table.
///
/// # Errors
/// They cannot be read.
pub fn verify(place: &Path, most: usize, report: &mut Report) -> Result<(), Error> {
    let study = study::read(&place.join("study.json"))?;
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let objective = objective(&study, &search, &Variable::ALL);
    let optimum = json(place, "optimum.json")?;
    for name in ["surf.csv", "fminsearch.csv", "fminsearch-starts.csv"] {
        if place.join(name).exists() {
            let sample = Sample::read(&place.join(name), most)?;
            let checks: Vec<Check> = sample
                .rows()
                .filter_map(|row| value(&objective, &row.design(), row.number("E1max")))
                .collect();
            report.look(name, &sample.of(checks.len()), &checks)?;
        }
    }
    let found = design(&optimum);
    if place.join("band.csv").exists() {
        let sample = Sample::read(&place.join("band.csv"), most)?;
        let tuned = objective.scene(&found).ok();
        let checks = tuned.map(|tuned| curves(&study, tuned, &sample)).unwrap_or_default();
        report.look("band.csv", &sample.of(checks.len() / CURVES), &checks)?;
    }
    match value(&objective, &found, number(&optimum["E1max"])) {
        Some(best) => report.look("optimum.json", "its design", &[best]),
        None => report.fail("optimum.json", "its design cannot be run"),
    }
}

/// Looks at a certificate again that stands by itself.
///
/// # Errors
/// It cannot be read.
pub fn certificate(place: &Path, report: &mut Report) -> Result<(), Error> {
    let study = study::read(&place.join("study.json"))?;
    let certificate = json(place, "certificate.json")?;
    let again = || energy(&study, &design(&certificate["design"]));
    let check = Check { said: number(&certificate["E1max"]), again: Box::new(again) };
    report.look("certificate.json", "its design", &[check])
}

/// E1max by the objective of a study for a design (k2, c2, D, C in SI units), J; infinite where it has none.
pub fn energy(study: &Study, design: &[f64; 4]) -> f64 {
    let scene = study.scene_with(&Setting::design(*design)).ok();
    scene.and_then(|scene| study.energy(&scene)).unwrap_or(f64::INFINITY)
}

/// The check of the value that a search saw at a design.
fn value<'a>(objective: &'a PeakEnergy, design: &[f64; 4], said: f64) -> Option<Check<'a>> {
    let scene = objective.scene(design).ok()?;
    let again = move || {
        let found = objective.evaluate(&scene, f64::INFINITY);
        found.map_or(f64::INFINITY, |found| found.value)
    };
    Some(Check { said, again: Box::new(again) })
}

/// The checks of the curves over the band: without damper, with that of the study, with the best.
fn curves<'a>(study: &'a Study, tuned: Scene, sample: &Sample) -> Vec<Check<'a>> {
    let mut checks = Vec::new();
    for row in sample.rows() {
        let Ok(omega) = NonNegative::new(row.number("omega")) else { continue };
        let scenes: [_; CURVES] = [
            ("E1max_none", Scene { damper: None, ..tuned }),
            ("E1max_study", study.scene),
            ("E1max_tuned", tuned),
        ];
        for (column, mut scene) in scenes {
            scene.forcing.frequency = omega;
            let again = move || band::at_its_own(study, scene);
            checks.push(Check { said: row.number(column), again: Box::new(again) });
        }
    }
    checks
}

fn json(place: &Path, name: &str) -> Result<Value, Error> {
    let refuse = |error: serde_json::Error| Error::Input { path: place.join(name), source: error.into() };
    serde_json::from_str(&text(place, name)?).map_err(refuse)
}

fn design(of: &Value) -> [f64; 4] {
    Variable::ALL.map(|variable| number(&of[variable.symbol()]))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}
