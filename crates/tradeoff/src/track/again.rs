//! `track`, computed again: E1max along k1.

use super::tuned::{DESIGNS, column, energy};
use retune_model::Scene;
use retune_study::Study;
use retune_workbench::Error;
use retune_workbench::resolved::Resolved;
use retune_workbench::verify::table::Sample;
use retune_workbench::verify::{Check, Report};
use std::path::Path;

/// Checks at most `most` stiffnesses of the curves along k1, whose designs are those of `retune.csv`.
///
/// # Errors
/// The file cannot be read, as of all checks.
pub fn again(place: &Path, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let studies = Resolved::read(place)?.studies()?;
    let sample = Sample::read(&place.join(name), most)?;
    let designs = Sample::read(&place.join(DESIGNS), usize::MAX)?;
    let (columns, checks) = curves(&studies, &designs, &sample);
    report.look(name, &sample.of(checks.len() / columns.max(1)), &checks)
}
/// The number of curves along k1, and their checks: without damper, and with each damper as tuned for its own k1.
fn curves<'a>(studies: &'a [(String, Study)], designs: &Sample, sample: &Sample) -> (usize, Vec<Check<'a>>) {
    let mut columns = Vec::new();
    if let Some((_, first)) = studies.first() {
        let bare = Scene { damper: None, ..first.scene };
        columns.push(("none".to_owned(), first, bare));
    }
    for (name, study) in studies {
        let nominal = study.scene.primary.stiffness.get();
        let own = designs.rows().find(|row| row.text("damper") == name && row.number("k1") == nominal);
        let scene = own.and_then(|row| study.scene_at(&row.design()?));
        if let Some(scene) = scene {
            columns.push((column(name, nominal), study, scene));
        }
    }
    let mut checks = Vec::new();
    for row in sample.rows() {
        let k1 = row.number("k1");
        for &(ref column, study, scene) in &columns {
            let again = move || energy(study, scene, k1).unwrap_or(f64::INFINITY);
            checks.push(Check { said: row.number(column), again: Box::new(again) });
        }
    }
    (columns.len(), checks)
}
