//! The results of several studies: tables of designs.

use super::one::energy;
use super::report::{Check, Report};
use super::table::{Row, Sample};
use crate::Error;
use crate::look;
use crate::resolved::Resolved;
use retune_model::Parameter;
use retune_study::{Setting, Study};
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
    let study =
        if k1.is_nan() { study.clone() } else { study.with(&[Setting::new(Parameter::K1, k1)]).ok()? };
    let again = move || match samples {
        Some(samples) => look::energy(&study, samples, &at).unwrap_or(f64::INFINITY),
        None => energy(&study, &at),
    };
    Some(Check { said, again: Box::new(again) })
}
