//! The results of one study: the rows of its search, its band, the design it found, its certificate.

use super::input::json;
use super::report::{Check, Report};
use super::table::{Row, Sample};
use crate::Error;
use crate::certify::{self, certify};
use crate::summary::Summary;
use crate::tune::band;
use crate::tune::objective::objective;
use retune_model::{Design, NonNegative, Scene};
use retune_optim::{Evaluation, Limit, PeakEnergy, Variable};
use retune_study::{self as study, Study};
use serde_json::{Value, json};
use std::path::Path;

/// The curves of a band: without damper, with that of the study, with the best.
const CURVES: usize = 3;

/// Tables of designs with the values that the search gave them.
const TABLES: [&str; 4] = ["surf.csv", "fminsearch.csv", "fminsearch-starts.csv", "basins.csv"];

/// Checks the results of a study, at most `most` rows of each table.
///
/// # Errors
/// They cannot be read.
pub fn verify(place: &Path, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let study = study::read(&place.join("study.json"))?;
    let has = |name: &str| place.join(name).exists();
    let searched = has("optimum.json") || TABLES.into_iter().any(has) || has("band.csv");
    if searched {
        search(place, &study, most, report)?;
    }
    if has(certify::FILE) {
        let said = json(place, certify::FILE)?;
        let study = if has("optimum.json") {
            certify::read(&place.join("optimum.json"))?.0
        } else if searched {
            let found = design(&said["design"]).and_then(|found| study.scene_at(&found)); // it stands nowhere else
            Study { scene: found.unwrap_or(study.scene), ..study }
        } else {
            study
        };
        certificate(&study, &said, certify::FILE, report)?;
    } else if !searched {
        report.unchecked("no row of these results can be run again by itself")?;
    }
    Ok(())
}

/// Checks the tables of a search, and the design that it found.
fn search(place: &Path, study: &Study, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let objective = objective(study, &search, &Variable::ALL);
    for name in TABLES {
        if place.join(name).exists() {
            let sample = Sample::read(&place.join(name), most)?;
            let checks: Vec<Check> = sample.rows().map(|row| value(&objective, row)).collect();
            report.look(name, &sample.of(checks.len()), &checks)?;
        }
    }
    if !place.join("optimum.json").exists() {
        return report.unchecked("there is no optimum.json: the design that was found");
    }
    let optimum = json(place, "optimum.json")?;
    let Some(tuned) = design(&optimum).and_then(|found| study.scene_at(&found)) else {
        return report.fail("optimum.json", "its design cannot be run");
    };
    if place.join("band.csv").exists() {
        let sample = Sample::read(&place.join("band.csv"), most)?;
        let checks = curves(study, tuned, &sample);
        report.look("band.csv", &sample.of(checks.len() / CURVES), &checks)?;
    }
    match objective.evaluate(&tuned, f64::INFINITY) {
        Err(error) => report.fail("optimum.json", &format!("its design cannot be run: {error}")),
        Ok(found) => {
            let again = again(study, &objective, tuned, &found, &optimum)?;
            report.compare("optimum.json", "its design", &optimum, &again)
        }
    }
}

/// The contents of `optimum.json` about its design, made again.
fn again(
    study: &Study,
    objective: &PeakEnergy,
    tuned: Scene,
    found: &Evaluation,
    optimum: &Value,
) -> Result<Value, Error> {
    let scene = found.worst_run(tuned, objective.goal());
    let response = retune_solver::simulate(&scene, study.window.window(), &study.solver.settings())?;
    let mut again = json!({ "E1max": found.energy, "simulation": Summary::new(study, scene, &response) });
    if !objective.goal().limits.is_empty() {
        let [stroke, force, cavity] = Limit::ALL.map(|limit| found.reached.get(limit));
        let (violation, feasible) = (found.violation, found.violation == 0.0);
        again["limits"] = json!({
            "stroke": stroke, "force": force, "cavity": cavity, "violation": violation, "feasible": feasible
        });
    }
    if optimum.get("certificate").is_some() {
        let certificate = certify(&Study { scene: tuned, ..study.clone() })?;
        again["certificate"] = json!(certificate.short());
    }
    Ok(again)
}

/// Checks the certificate of the design in the scene of a study by making it again.
///
/// # Errors
/// Standard output cannot be written.
pub fn certificate(study: &Study, said: &Value, name: &str, report: &mut Report<'_>) -> Result<(), Error> {
    match certify(study) {
        Ok(again) => report.compare(name, "all of it", said, &json!(again)),
        Err(error) => report.fail(name, &format!("cannot be made again: {error}")),
    }
}

/// E1max by the objective of a study for a design, J; infinite where it has none.
pub fn energy(study: &Study, design: &Design) -> f64 {
    study.scene_at(design).and_then(|scene| study.energy(&scene)).unwrap_or(f64::INFINITY)
}

/// The check of a row of a search: the minimised value, or the E1max of a basin, which is empty where the design breaks a limit.
fn value<'a>(objective: &'a PeakEnergy, row: Row) -> Check<'a> {
    let text = row.text("E1max");
    let basin = !row.text("basin").is_empty();
    if !(basin && text.is_empty()) && row.number("E1max").is_nan() {
        return Check::never();
    }
    let design = row.design();
    let again = move || {
        let scene = design.and_then(|design| objective.scene(&design.values()).ok());
        let found = scene.and_then(|scene| objective.evaluate(&scene, f64::INFINITY).ok());
        let value = found.map_or(f64::INFINITY, |found| found.value);
        if basin { retune_optim::energy(value) } else { value }
    };
    Check { said: row.number("E1max"), again: Box::new(again) }
}

/// The checks of the curves over the band: without damper, with that of the study, with the best.
fn curves<'a>(study: &'a Study, tuned: Scene, sample: &Sample) -> Vec<Check<'a>> {
    let mut checks = Vec::new();
    for row in sample.rows() {
        let scenes: [_; CURVES] = [
            ("E1max_none", Scene { damper: None, ..tuned }),
            ("E1max_study", study.scene),
            ("E1max_tuned", tuned),
        ];
        for (column, mut scene) in scenes {
            checks.push(match NonNegative::new(row.number("omega")) {
                Ok(omega) => {
                    scene.forcing.frequency = omega;
                    let again = move || band::at_its_own(study, scene);
                    Check { said: row.number(column), again: Box::new(again) }
                }
                Err(_) => Check::never(),
            });
        }
    }
    checks
}

/// The design in a JSON object; none where a number is missing or none of a damper.
pub fn design(of: &Value) -> Option<Design> {
    Design::new(|variable| of[variable.symbol()].as_f64().unwrap_or(f64::NAN)).ok()
}
