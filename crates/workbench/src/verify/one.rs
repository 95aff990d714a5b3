//! The results of one study: the rows of its search, its band, the design it found, its certificate.

use super::input::json;
use super::report::{Check, Report};
use super::table::{Row, Sample};
use crate::Error;
use crate::artefact::Artefact;
use crate::certify::certify;
use crate::needs::Needs;
use crate::resolved;
use crate::summary::Summary;
use crate::tune::objective::{coarse, objective, searched};
use crate::tune::{self, OPTIMUM, band};
use retune_model::{Design, NonNegative, Scene};
use retune_optim::{DesignObjective, Evaluation, Parameter};
use retune_study::{self as study, Search, Study};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The curves of a band: without damper, with that of the study, with the best.
const CURVES: usize = 3;

/// The results of one study.
pub struct One {
    place: PathBuf,
    study: Study,
}

impl One {
    /// Reads the study of the results in a directory.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn read(place: &Path) -> Result<Self, Error> {
        Ok(Self { place: place.to_owned(), study: study::read(&place.join(resolved::ONE))? })
    }

    /// Checks at most `most` rows of designs with the values that the search gave them.
    ///
    /// # Errors
    /// The file cannot be read, as of all checks.
    pub fn searched(&self, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
        self.designs(self.objective(searched)?, f64::INFINITY, name, most, report)
    }

    /// The same of rows of a grid.
    ///
    /// # Errors
    /// As [`Self::searched`].
    pub fn grid(&self, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
        let up_to = self.study.coarse().up_to();
        self.designs(self.objective(coarse)?, up_to, name, most, report)
    }

    fn designs(
        &self,
        objective: DesignObjective,
        up_to: f64,
        name: &str,
        most: usize,
        report: &mut Report<'_>,
    ) -> Result<(), Error> {
        let sample = Sample::read(&self.place.join(name), most)?;
        let checks: Vec<Check> =
            sample.rows().map(|row| value(&objective, &self.study, up_to, row)).collect();
        report.look(name, &sample.of(checks.len()), &checks)
    }

    /// Checks at most `most` frequencies of a band.
    ///
    /// # Errors
    /// As [`Self::searched`].
    pub fn band(&self, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
        let Some(tuned) = self.tuned()? else { return Ok(()) }; // reported with optimum.json
        let sample = Sample::read(&self.place.join(name), most)?;
        let checks = curves(&self.study, tuned, &sample);
        report.look(name, &sample.of(checks.len() / CURVES), &checks)
    }

    /// Checks the design that was found.
    ///
    /// # Errors
    /// As [`Self::searched`].
    pub fn optimum(&self, name: &str, report: &mut Report<'_>) -> Result<(), Error> {
        let Some(tuned) = self.tuned()? else { return report.fail(name, "its design cannot be run") };
        let objective = self.objective(objective)?;
        let optimum = json(&self.place, name)?;
        match objective.evaluate(&tuned, f64::INFINITY) {
            Err(error) => report.fail(name, &format!("its design cannot be run: {error}")),
            Ok(found) => {
                let again = again(&self.study, &objective, tuned, &found, &optimum)?;
                report.compare(name, "its design", &optimum, &again)
            }
        }
    }

    /// Checks the certificate: of the design of `optimum.json`, of its own where a search left no other, or of the study's.
    ///
    /// # Errors
    /// As [`Self::searched`].
    pub fn certificate(&self, name: &str, report: &mut Report<'_>) -> Result<(), Error> {
        let said = json(&self.place, name)?;
        let scene = if self.place.join(OPTIMUM).exists() {
            self.tuned()?
        } else if self.is_of_a_search() {
            design(&said["design"]).and_then(|found| self.study.scene_at(&found))
        } else {
            Some(self.study.scene)
        };
        match scene {
            Some(scene) => certificate(&Study { scene, ..self.study.clone() }, &said, name, report),
            None => report.fail(name, "its design cannot be run"),
        }
    }

    /// The scene with the design that was found; none where there is none, or it cannot be run.
    fn tuned(&self) -> Result<Option<Scene>, Error> {
        let missing = !self.place.join(OPTIMUM).exists();
        if missing {
            return Ok(None);
        }
        Ok(design(&json(&self.place, OPTIMUM)?).and_then(|found| self.study.scene_at(&found)))
    }

    fn is_of_a_search(&self) -> bool {
        let made_by_search = |of: &&Artefact| of.content.is_of_a_search();
        let mut files = tune::KIND.artefacts.iter().filter(made_by_search);
        files.any(|file| self.place.join(file.name).exists())
    }

    fn objective(
        &self,
        of: fn(&Study, &Search, &[Parameter]) -> DesignObjective,
    ) -> Result<DesignObjective, Error> {
        let refuse = |rule| Error::Rule { name: self.study.name().to_owned(), rule };
        Ok(of(&self.study, &self.study.search().map_err(refuse)?, &Parameter::VARIED))
    }
}

/// The contents of `optimum.json` about its design, made again.
fn again(
    study: &Study,
    objective: &DesignObjective,
    tuned: Scene,
    found: &Evaluation,
    optimum: &Value,
) -> Result<Value, Error> {
    let scene = found.worst_run(tuned, objective.goal());
    let response = retune_solver::simulate(&scene, study.window.window(), &study.solver.settings())?;
    let name = study.quantity().name();
    let mut again = json!({
        name: found.value,
        format!("{name}_none"): study.energy_without_damper(),
        format!("{name}_study"): study.energy(&study.scene),
        "simulation": Summary::new(study, scene, &response) });
    if let (Some(_), Ok(search)) = (optimum.get("needs"), study.search()) {
        again["needs"] = json!(Needs::new(study, &search, &tuned, found.value));
    }
    if !objective.goal().limits.is_empty() {
        again["limits"] = json!({ "violation": found.violation, "feasible": found.violation == 0.0 });
        for limit in objective.goal().limits.set() {
            again["limits"][limit.name()] = json!(found.reached.get(limit));
        }
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

/// The value by the objective of a study for a design; infinite where it has none.
pub fn energy(study: &Study, design: &Design) -> f64 {
    study.scene_at(design).and_then(|scene| study.energy(&scene)).unwrap_or(f64::INFINITY)
}

/// The check of a row of a search: the minimised value, `up_to` if it is above that, or the value of a basin, which is empty where the design
/// breaks a limit.
fn value<'a>(objective: &'a DesignObjective, study: &'a Study, up_to: f64, row: Row) -> Check<'a> {
    let name = objective.goal().objective.quantity().name();
    let text = row.text(name);
    let basin = !row.text("basin").is_empty();
    if !(basin && text.is_empty()) && row.number(name).is_nan() {
        return Check::never();
    }
    let design = row.design();
    let again = move || {
        let scene = design.and_then(|design| study.scene_at(&design));
        let found = scene.and_then(|scene| objective.evaluate(&scene, up_to).ok());
        let value = found.map_or(f64::INFINITY, |found| found.ranked.min(up_to));
        if basin { retune_optim::value_of(value) } else { value }
    };
    Check { said: row.number(name), again: Box::new(again) }
}

/// The checks of the curves over the band: without damper, with that of the study, with the best.
fn curves<'a>(study: &'a Study, tuned: Scene, sample: &Sample) -> Vec<Check<'a>> {
    let mut checks = Vec::new();
    for row in sample.rows() {
        let scenes: [_; CURVES] = [Scene { damper: None, ..tuned }, study.scene, tuned];
        for (column, mut scene) in band::columns(study.quantity()).iter().zip(scenes) {
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
