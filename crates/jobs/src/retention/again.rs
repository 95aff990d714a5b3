//! The tables of `retention`, computed again: the designs, E1max along k1, the retention ranges, smaller forces.

use super::curves::{ANEW, BANDS};
use super::force::under;
use super::range::Criterion;
use super::trade::Point;
use super::tuned::{CURVES, DESIGNS, FORCES, Kept, Tuned, Tuning, bare, energy, label, on_samples, still};
use crate::Error;
use crate::again::{Numbers, Row, Source, each_row};
use crate::resolved::Resolved;
use retune_model::Design;
use retune_study::Study;
use std::path::Path;

/// The results in a directory.
struct Results {
    k1: Vec<f64>,
    /// With the designs that stand in their table.
    dampers: Vec<Tuned>,
    /// Of each damper what counts as half of its work; of the ranges alone.
    criteria: Vec<Criterion>,
}

/// A row of one of the tables.
///
/// # Errors
/// The input of the results or the table of designs cannot be read, or a threshold not be computed.
pub(super) fn again(place: &Path, name: &str) -> Result<Source, Error> {
    let resolved = Resolved::read(place)?;
    let k1 = resolved.plan["k1"].as_array().map(|all| all.iter().filter_map(|k1| k1.as_f64()).collect());
    let k1: Vec<f64> = k1.unwrap_or_default();
    let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
    let tuned = |(name, study)| Tuned { name, study, samples, kept: Vec::new(), anew: Vec::new() };
    let mut dampers: Vec<Tuned> = resolved.studies()?.into_iter().map(tuned).collect();
    each_row(&place.join(DESIGNS), |_, row| {
        let damper = dampers.iter_mut().find(|damper| damper.name == row.text("damper"));
        let (Some(damper), Some(at)) = (damper, row.design()) else { return };
        let (tuning, nominal) = (row.text("tuning"), damper.nominal());
        let kept = Tuning::ALL.into_iter().find(|kept| match kept {
            Tuning::Nominal => label(nominal) == tuning,
            Tuning::Paper | Tuning::Robust => kept.name() == tuning,
        });
        damper.kept.extend(kept.map(|tuning| Kept { tuning, at }));
        damper.anew.extend(k1.iter().filter(|k1| label(**k1) == tuning).map(|k1| (*k1, at)));
    })?;
    let row: fn(&Results, Row) -> Option<Numbers> = match name {
        DESIGNS => Results::design,
        CURVES => Results::point,
        FORCES => Results::forced,
        _ => Results::range,
    };
    let of_criteria = dampers.iter().filter(|_| ![DESIGNS, CURVES, FORCES].contains(&name));
    let criteria = of_criteria.map(|damper| Criterion::of(&damper.study)).collect::<Result<_, _>>()?;
    let results = Results { k1, dampers, criteria };
    Ok(Source::new(move |of| row(&results, of)))
}

/// A number of a row; infinite where it cannot be computed.
fn number(name: &str, found: Option<f64>) -> (String, f64) {
    (name.to_owned(), found.unwrap_or(f64::INFINITY))
}

impl Results {
    /// The damper of a row, with its number.
    fn damper(&self, row: Row) -> Option<(usize, &Tuned)> {
        self.dampers.iter().enumerate().find(|(_, damper)| damper.name == row.text("damper"))
    }

    /// E1max of a design for what it was tuned for.
    fn design(&self, row: Row) -> Option<Numbers> {
        let ((_, damper), at) = (self.damper(row)?, row.design()?);
        Some(vec![number("E1max", damper.energy_as_tuned(row.text("tuning"), &at, &self.k1))])
    }

    /// E1max of a point of a curve.
    fn point(&self, row: Row) -> Option<Numbers> {
        let (k1, tuning) = (row.number("k1"), row.text("tuning"));
        let banded = |study: &Study| match row.text("band") {
            band if band == BANDS[0] => Some(study.clone()),
            band if band == BANDS[1] => still(study),
            _ => None,
        };
        if tuning == "none" {
            return Some(vec![number("E1max", bare(&banded(&self.dampers.first()?.study)?, k1))]);
        }
        let (_, damper) = self.damper(row)?;
        let kept = |kept: &Kept| (kept.tuning.name() == tuning).then_some(kept.at);
        let anew = |(own, at): &(f64, Design)| (tuning == ANEW && *own == k1).then_some(*at);
        let at = damper.kept.iter().find_map(kept).or_else(|| damper.anew.iter().find_map(anew))?;
        Some(vec![number("E1max", energy(&banded(&damper.study)?, damper.samples, &at, k1))])
    }

    /// E1max with the nominal design and without a damper under a force.
    fn forced(&self, row: Row) -> Option<Numbers> {
        let (_, damper) = self.damper(row)?;
        let at = damper.of(Tuning::Nominal)?;
        let found = under(&damper.study, damper.samples, &at, row.text("gaps"), row.number("P"))?;
        Some(["E1max", "none"].map(str::to_owned).into_iter().zip(found).collect())
    }

    /// E1max and both ends of the ranges of a design, where it has one.
    fn range(&self, row: Row) -> Option<Numbers> {
        let (damper, at) = (self.damper(row)?, row.design()?);
        on_samples(&damper.1.study, damper.1.samples, &at)?;
        let point = Point::new(damper, None, at, self.criteria.get(damper.0)?);
        let e1_max = Some(point.e1_max).filter(|value| !value.is_nan());
        let mut numbers = vec![number("E1max", e1_max)];
        for (names, range) in [(["from", "to"], point.range), (["still_from", "still_to"], point.still)] {
            numbers.push(number(names[0], range.map(|of| of.from)));
            numbers.push(number(names[1], range.map(|of| of.to)));
        }
        Some(numbers)
    }
}
