//! Recomputes the tables of `retention`: the designs, E1max along k1, the retention ranges, smaller forces.

use super::force::{amplitude, under};
use super::trade::{ENDS, Point};
use super::tuned::{BANDS, CURVES, DESIGNS, FORCES, RANGES, Tuned, Tuning, bare, energy, label, on_samples};
use crate::Error;
use crate::recompute::{Numbers, Row, Source, each_row};
use crate::resolved::Resolved;
use std::path::Path;

pub(super) fn rows(place: &Path, name: &str) -> Result<Source, Error> {
    let resolved = Resolved::read(place)?;
    let k1 = resolved.plan["k1"].as_array().map(|all| all.iter().filter_map(|k1| k1.as_f64()).collect());
    let k1: Vec<f64> = k1.unwrap_or_default();
    let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
    let tuned = |(name, study)| Tuned::new(name, study, samples);
    let mut dampers: Vec<Tuned> = resolved.studies()?.into_iter().map(tuned).collect();
    each_row(&place.join(DESIGNS), |_, row| {
        let damper = dampers.iter_mut().find(|damper| damper.name == row.text("damper"));
        let (Some(damper), Some(at)) = (damper, row.design()) else { return };
        let (tuning, nominal) = (row.text("tuning"), damper.nominal());
        let kept = Tuning::KEPT.into_iter().find(|kept| match kept {
            Tuning::Nominal => label(nominal) == tuning,
            _ => kept.name() == tuning,
        });
        damper.kept.extend(kept.map(|tuning| (tuning, at)));
        damper.anew.extend(k1.iter().filter(|k1| label(**k1) == tuning).map(|k1| (*k1, at)));
    })?;
    if name == RANGES {
        dampers = dampers.into_iter().map(Tuned::with_thresholds).collect::<Result<_, _>>()?;
    }
    let row: fn(&[Tuned], Row) -> Option<Numbers> = match name {
        DESIGNS => return Ok(Source::new(move |row| Some(vec![e1_max(design(&dampers, &k1, row)?)]))),
        CURVES => |dampers, row| Some(vec![e1_max(point(dampers, row)?)]),
        FORCES => forced,
        _ => range,
    };
    Ok(Source::new(move |of| row(&dampers, of)))
}

/// E1max; infinite where it cannot be computed.
fn e1_max(found: Option<f64>) -> (String, f64) {
    ("E1max".to_owned(), found.unwrap_or(f64::INFINITY))
}

/// The damper of a row, with its index.
fn damper<'a>(dampers: &'a [Tuned], row: Row) -> Option<(usize, &'a Tuned)> {
    dampers.iter().enumerate().find(|(_, damper)| damper.name == row.text("damper"))
}

/// E1max of a design under the conditions it was tuned for.
fn design(dampers: &[Tuned], k1: &[f64], row: Row) -> Option<Option<f64>> {
    let ((_, damper), at) = (damper(dampers, row)?, row.design()?);
    Some(damper.energy_as_tuned(row.text("tuning"), &at, k1))
}

/// E1max of a point of a curve.
fn point(dampers: &[Tuned], row: Row) -> Option<Option<f64>> {
    let (k1, tuning) = (row.number("k1"), row.text("tuning"));
    let band = BANDS.iter().position(|band| *band == row.text("band"))?;
    if tuning == Tuning::None.name() {
        return Some(bare(dampers.first()?.studies.get(band)?, k1));
    }
    let (_, damper) = damper(dampers, row)?;
    let kept = damper.kept.iter().find(|(kept, _)| kept.name() == tuning).map(|(_, at)| *at);
    let anew = damper.anew.iter().find(|(tuned_for, _)| tuning == Tuning::Anew.name() && *tuned_for == k1);
    let at = kept.or(anew.map(|(_, at)| *at))?;
    Some(energy(damper.studies.get(band)?, damper.samples, &at, k1))
}

/// E1max under a force, with the nominal design and without a damper.
fn forced(dampers: &[Tuned], row: Row) -> Option<Numbers> {
    let (_, damper) = damper(dampers, row)?;
    let at = damper.of(Tuning::Nominal)?;
    let force = row.number(amplitude(damper.study())?.symbol());
    let found = under(damper.study(), damper.samples, &at, row.text("gaps"), force)?;
    Some(["E1max", "none"].map(str::to_owned).into_iter().zip(found).collect())
}

/// E1max and the ends of the ranges of a design.
fn range(dampers: &[Tuned], row: Row) -> Option<Numbers> {
    let (damper, at) = (damper(dampers, row)?, row.design()?);
    on_samples(damper.1.study(), damper.1.samples, &at)?;
    let point = Point::new(damper, Tuning::Front, at);
    let ends = ENDS.map(str::to_owned).into_iter().zip(point.ends().map(|end| end.unwrap_or(f64::INFINITY)));
    let e1_max = e1_max(Some(point.e1_max).filter(|value| !value.is_nan()));
    Some([e1_max].into_iter().chain(ends).collect())
}
