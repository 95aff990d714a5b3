//! The results of several studies: tables of designs (`table2`, `track`, `fronts`) and curves along k1.

use super::input::json;
use super::one::{self, certificate, energy};
use super::report::{Check, Report};
use super::table::{Row, Sample};
use crate::Error;
use crate::pareto;
use crate::resolved::Resolved;
use crate::track;
use retune_study::{Setting, Study};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The results of several studies.
pub struct Several {
    place: PathBuf,
    studies: Vec<(String, Study)>,
    /// The samples of the bands, where the plan says so.
    samples: Option<usize>,
}

impl Several {
    /// Reads the plan and the studies of the results in a directory.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn read(place: &Path) -> Result<Self, Error> {
        let resolved = Resolved::read(place)?;
        let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
        Ok(Self { place: place.to_owned(), studies: resolved.studies()?, samples })
    }

    /// Checks at most `most` rows of designs.
    ///
    /// # Errors
    /// The file cannot be read, as of all checks.
    pub fn designs(&self, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
        let sample = Sample::read(&self.place.join(name), most)?;
        let checks: Vec<Check> =
            sample.rows().filter_map(|row| design(&self.studies, self.samples, row)).collect();
        report.look(name, &sample.of(checks.len()), &checks)
    }

    /// Checks at most `most` stiffnesses of the curves along k1, whose designs are those of `retune.csv`.
    ///
    /// # Errors
    /// As [`Self::designs`].
    pub fn retention(&self, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
        let sample = Sample::read(&self.place.join(name), most)?;
        let designs = Sample::read(&self.place.join(track::KIND.answer), usize::MAX)?;
        let (columns, checks) = curves(&self.studies, &designs, &sample);
        report.look(name, &sample.of(checks.len() / columns.max(1)), &checks)
    }

    /// Checks the certificate of a design.
    ///
    /// # Errors
    /// As [`Self::designs`].
    pub fn certificate(&self, name: &str, report: &mut Report<'_>) -> Result<(), Error> {
        let said = json(&self.place, name)?;
        match certified(&self.studies, self.samples, &said) {
            Some(study) => certificate(&study, &said, name, report),
            None => report.fail(name, "is of none of the studies"),
        }
    }
}

/// The study with the design that a certificate of `fronts` is of.
fn certified(studies: &[(String, Study)], samples: Option<usize>, said: &Value) -> Option<Study> {
    let (_, study) = studies.iter().find(|(_, study)| said["study"] == study.name())?;
    pareto::finer(study, samples?, &one::design(&said["design"])?)
}

/// The check of a row with a design; none where the row says that it has none.
fn design<'a>(studies: &[(String, Study)], samples: Option<usize>, row: Row) -> Option<Check<'a>> {
    let Some((_, study)) = studies.iter().find(|(name, _)| name == row.text("damper")) else {
        return Some(Check::never());
    };
    let (at, said) = (row.design(), row.number("E1max"));
    if ["k2", "c2", "D", "C", "E1max"].iter().all(|name| row.text(name).is_empty()) {
        return None; // no design keeps this bound
    }
    let Some(at) = at.filter(|_| !said.is_nan()) else { return Some(Check::never()) };
    let k1 = row.number("k1");
    let study = if k1.is_nan() { study.clone() } else { study.with(&[Setting::new("k1", k1)]).ok()? };
    let again = move || match samples {
        Some(samples) => pareto::energy(&study, samples, &at).unwrap_or(f64::INFINITY),
        None => energy(&study, &at),
    };
    Some(Check { said, again: Box::new(again) })
}

/// The number of curves along k1, and their checks: without damper, and with each damper as tuned for its own k1.
fn curves<'a>(studies: &'a [(String, Study)], designs: &Sample, sample: &Sample) -> (usize, Vec<Check<'a>>) {
    let mut columns = Vec::new();
    if let Some((_, first)) = studies.first() {
        let bare = retune_model::Scene { damper: None, ..first.scene };
        columns.push(("none".to_owned(), first, bare));
    }
    for (name, study) in studies {
        let nominal = study.scene.primary.stiffness.get();
        let own = designs.rows().find(|row| row.text("damper") == name && row.number("k1") == nominal);
        let scene = own.and_then(|row| study.scene_at(&row.design()?));
        if let Some(scene) = scene {
            columns.push((track::column(name, nominal), study, scene));
        }
    }
    let mut checks = Vec::new();
    for row in sample.rows() {
        let k1 = row.number("k1");
        for &(ref column, study, scene) in &columns {
            let again = move || track::energy(study, scene, k1).unwrap_or(f64::INFINITY);
            checks.push(Check { said: row.number(column), again: Box::new(again) });
        }
    }
    (columns.len(), checks)
}
