//! `retention`, computed again: the designs, E1max along k1, the retention ranges.

use super::anew::label;
use super::curves::{ANEW, BANDS};
use super::force::under;
use super::range::{Still, Threshold, range};
use super::tuned::{CURVES, DESIGNS, FORCES, Tuning, bare, energy, on_samples, over, still};
use crate::Error;
use crate::resolved::Resolved;
use crate::verify::table::{Row, Sample};
use crate::verify::{Check, Report};
use retune_model::Design;
use retune_study::Study;
use std::collections::BTreeMap;
use std::path::Path;

/// The results in a directory.
struct Results {
    studies: Vec<(String, Study)>,
    samples: Option<usize>,
    k1: Vec<f64>,
    designs: Sample,
    /// By the name of a damper, what counts as half of its work; of the ranges alone.
    thresholds: BTreeMap<String, (Threshold, Option<Still>)>,
}

/// Checks at most `most` rows of a table.
///
/// # Errors
/// A file cannot be read, as of all checks; or a threshold cannot be computed.
pub fn again(place: &Path, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let resolved = Resolved::read(place)?;
    let k1 = resolved.plan["k1"].as_array().map(|all| all.iter().filter_map(|k1| k1.as_f64()).collect());
    let studies = resolved.studies()?;
    let threshold =
        |(damper, study): &(String, Study)| Ok((damper.clone(), (Threshold::of(study)?, Still::of(study)?)));
    let thresholds = match name {
        DESIGNS | CURVES | FORCES => BTreeMap::new(),
        _ => studies.iter().map(threshold).collect::<Result<_, Error>>()?,
    };
    let results = Results {
        thresholds,
        studies,
        samples: resolved.plan["samples"].as_u64().map(|samples| samples as usize),
        k1: k1.unwrap_or_default(),
        designs: Sample::read(&place.join(DESIGNS), usize::MAX)?,
    };
    let sample = Sample::read(&place.join(name), most)?;
    let check = |row: Row| match name {
        DESIGNS => vec![results.design(row)],
        CURVES => vec![results.point(row)],
        FORCES => results.forced(row),
        _ => results.range(row),
    };
    let checks: Vec<Vec<Option<Check>>> = sample.rows().map(check).collect();
    let rows = checks.len();
    let checks: Vec<Check> =
        checks.into_iter().flatten().map(|check| check.unwrap_or_else(Check::never)).collect();
    report.look(name, &sample.of(rows), &checks)
}

impl Results {
    fn study(&self, row: Row) -> Option<&Study> {
        self.studies.iter().find(|(name, _)| name == row.text("damper")).map(|(_, study)| study)
    }

    /// E1max of a design for what it was tuned for.
    fn design(&self, row: Row) -> Option<Check<'_>> {
        let (study, at) = (self.study(row)?, row.design()?);
        let tuning = row.text("tuning");
        let again: Box<dyn Fn() -> f64 + Sync> = if tuning == Tuning::Robust.name() {
            let study = over(study, &self.k1);
            let own = study.scene.primary.stiffness.get();
            Box::new(move || energy(&study, self.samples, &at, own).unwrap_or(f64::INFINITY))
        } else {
            // The paper's design is taken at the study's own k1.
            let own = study.scene.primary.stiffness.get();
            let k1 = self.k1.iter().copied().find(|k1| label(*k1) == tuning).unwrap_or(own);
            Box::new(move || energy(study, self.samples, &at, k1).unwrap_or(f64::INFINITY))
        };
        Some(Check { said: row.number("E1max"), again })
    }

    /// E1max of a point of a curve.
    fn point(&self, row: Row) -> Option<Check<'_>> {
        let k1 = row.number("k1");
        let banded = |study: &Study| match row.text("band") {
            band if band == BANDS[0] => Some(study.clone()),
            band if band == BANDS[1] => still(study),
            _ => None,
        };
        let again: Box<dyn Fn() -> f64 + Sync> = if row.text("tuning") == "none" {
            let study = banded(&self.studies.first()?.1)?;
            Box::new(move || bare(&study, k1).unwrap_or(f64::INFINITY))
        } else {
            let at = self.at(row.text("damper"), row.text("tuning"), k1)?;
            let study = banded(self.study(row)?)?;
            Box::new(move || energy(&study, self.samples, &at, k1).unwrap_or(f64::INFINITY))
        };
        Some(Check { said: row.number("E1max"), again })
    }

    /// The design of a curve at a stiffness, N/m.
    fn at(&self, damper: &str, tuning: &str, k1: f64) -> Option<Design> {
        let nominal = self.studies.iter().find(|(name, _)| name == damper)?.1.scene.primary.stiffness.get();
        let wanted = match tuning {
            ANEW => label(k1),
            other if other == Tuning::Nominal.name() => label(nominal),
            other => other.to_owned(),
        };
        let is_it = |row: &Row| row.text("damper") == damper && row.text("tuning") == wanted;
        self.designs.rows().find(is_it)?.design()
    }

    /// E1max with the nominal design and without a damper under a force.
    fn forced(&self, row: Row) -> Vec<Option<Check<'_>>> {
        let both = || {
            let at = self.at(row.text("damper"), Tuning::Nominal.name(), f64::NAN)?;
            let study = self.study(row)?;
            let found = under(study, self.samples, &at, row.text("gaps"), row.number("P"))?;
            Some(
                ["E1max", "none"]
                    .into_iter()
                    .zip(found)
                    .map(|(name, again)| Check { said: row.number(name), again: Box::new(move || again) }),
            )
        };
        both().map_or_else(|| vec![None], |checks| checks.map(Some).collect())
    }

    /// E1max and both ends of the ranges of a design, where it has one.
    fn range(&self, row: Row) -> Vec<Option<Check<'_>>> {
        let check = || {
            let (study, at) = (self.study(row)?, row.design()?);
            let own = study.scene.primary.stiffness.get();
            let e1_max = move || energy(study, self.samples, &at, own).unwrap_or(f64::INFINITY);
            let mut checks = vec![Check { said: row.number("E1max"), again: Box::new(e1_max) }];
            let (threshold, still) = self.thresholds.get(row.text("damper"))?;
            on_samples(study, self.samples, &at)?;
            let found = range(study, self.samples, &at, threshold);
            let kept = still.as_ref().and_then(|of| range(&of.study, self.samples, &at, &of.threshold));
            for (names, found) in [(["from", "to"], found), (["still_from", "still_to"], kept)] {
                for (name, end) in names.into_iter().zip([found.map(|of| of.from), found.map(|of| of.to)]) {
                    if !row.text(name).is_empty() || end.is_some() {
                        let end = end.unwrap_or(f64::INFINITY);
                        checks.push(Check { said: row.number(name), again: Box::new(move || end) });
                    }
                }
            }
            Some(checks)
        };
        check().map_or_else(|| vec![None], |checks| checks.into_iter().map(Some).collect())
    }
}
