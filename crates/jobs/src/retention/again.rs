//! The tables of `retention`, computed again: the designs, E1max along k1, the retention ranges, smaller forces.

use super::anew::label;
use super::curves::{ANEW, BANDS};
use super::force::under;
use super::range::{Criterion, range};
use super::tuned::{CURVES, DESIGNS, FORCES, Tuning, bare, energy, on_samples, over, still};
use crate::Error;
use crate::again::{Numbers, Row, Source, each_row};
use crate::resolved::Resolved;
use retune_model::Design;
use retune_study::Study;
use std::collections::BTreeMap;
use std::path::Path;

/// The results in a directory.
struct Results {
    studies: Vec<(String, Study)>,
    samples: Option<usize>,
    k1: Vec<f64>,
    /// By the names of a damper and of its tuning.
    designs: BTreeMap<(String, String), Option<Design>>,
    /// By the name of a damper, what counts as half of its work; of the ranges alone.
    criteria: BTreeMap<String, Criterion>,
}

/// A row of one of the tables.
///
/// # Errors
/// The input of the results or the table of designs cannot be read, or a threshold not be computed.
pub(super) fn again(place: &Path, name: &str) -> Result<Source, Error> {
    let resolved = Resolved::read(place)?;
    let k1 = resolved.plan["k1"].as_array().map(|all| all.iter().filter_map(|k1| k1.as_f64()).collect());
    let studies = resolved.studies()?;
    let criterion = |(damper, study): &(String, Study)| Ok((damper.clone(), Criterion::of(study)?));
    let (row, criteria): (fn(&Results, Row) -> Option<Numbers>, _) = match name {
        DESIGNS => (Results::design, BTreeMap::new()),
        CURVES => (Results::point, BTreeMap::new()),
        FORCES => (Results::forced, BTreeMap::new()),
        _ => (Results::range, studies.iter().map(criterion).collect::<Result<_, Error>>()?),
    };
    let mut designs = BTreeMap::new();
    each_row(&place.join(DESIGNS), |_, row| {
        let own = (row.text("damper").to_owned(), row.text("tuning").to_owned());
        designs.entry(own).or_insert_with(|| row.design());
    })?;
    let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
    let results = Results { criteria, studies, samples, k1: k1.unwrap_or_default(), designs };
    Ok(Source::new(move |of| row(&results, of)))
}

/// A number of a row; infinite where it cannot be computed.
fn number(name: &str, found: Option<f64>) -> (String, f64) {
    (name.to_owned(), found.unwrap_or(f64::INFINITY))
}

impl Results {
    fn study(&self, row: Row) -> Option<&Study> {
        self.studies.iter().find(|(name, _)| name == row.text("damper")).map(|(_, study)| study)
    }

    /// E1max of a design for what it was tuned for.
    fn design(&self, row: Row) -> Option<Numbers> {
        let (study, at) = (self.study(row)?, row.design()?);
        let own = study.scene.primary.stiffness.get();
        let tuning = row.text("tuning");
        let found = if tuning == Tuning::Robust.name() {
            energy(&over(study, &self.k1), self.samples, &at, own)
        } else {
            // The paper's design is taken at the study's own k1.
            let k1 = self.k1.iter().copied().find(|k1| label(*k1) == tuning).unwrap_or(own);
            energy(study, self.samples, &at, k1)
        };
        Some(vec![number("E1max", found)])
    }

    /// E1max of a point of a curve.
    fn point(&self, row: Row) -> Option<Numbers> {
        let k1 = row.number("k1");
        let banded = |study: &Study| match row.text("band") {
            band if band == BANDS[0] => Some(study.clone()),
            band if band == BANDS[1] => still(study),
            _ => None,
        };
        let found = if row.text("tuning") == "none" {
            bare(&banded(&self.studies.first()?.1)?, k1)
        } else {
            let at = self.at(row.text("damper"), row.text("tuning"), k1)?;
            energy(&banded(self.study(row)?)?, self.samples, &at, k1)
        };
        Some(vec![number("E1max", found)])
    }

    /// The design of a curve at a stiffness, N/m.
    fn at(&self, damper: &str, tuning: &str, k1: f64) -> Option<Design> {
        let nominal = self.studies.iter().find(|(name, _)| name == damper)?.1.scene.primary.stiffness.get();
        let tuning = match tuning {
            ANEW => label(k1),
            other if other == Tuning::Nominal.name() => label(nominal),
            other => other.to_owned(),
        };
        *self.designs.get(&(damper.to_owned(), tuning))?
    }

    /// E1max with the nominal design and without a damper under a force.
    fn forced(&self, row: Row) -> Option<Numbers> {
        let at = self.at(row.text("damper"), Tuning::Nominal.name(), f64::NAN)?;
        let found = under(self.study(row)?, self.samples, &at, row.text("gaps"), row.number("P"))?;
        Some(["E1max", "none"].map(str::to_owned).into_iter().zip(found).collect())
    }

    /// E1max and both ends of the ranges of a design, where it has one.
    fn range(&self, row: Row) -> Option<Numbers> {
        let (study, at) = (self.study(row)?, row.design()?);
        let own = study.scene.primary.stiffness.get();
        let Criterion { threshold, still } = self.criteria.get(row.text("damper"))?;
        on_samples(study, self.samples, &at)?;
        let found = range(study, self.samples, &at, threshold);
        let kept = still.as_ref().and_then(|of| range(&of.study, self.samples, &at, &of.threshold));
        let mut numbers = vec![number("E1max", energy(study, self.samples, &at, own))];
        for (names, found) in [(["from", "to"], found), (["still_from", "still_to"], kept)] {
            numbers.push(number(names[0], found.map(|of| of.from)));
            numbers.push(number(names[1], found.map(|of| of.to)));
        }
        Some(numbers)
    }
}
