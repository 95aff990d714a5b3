//! `retention`: how well a tuning holds as the stiffness k1 of the structure changes. Dampers are tuned for one k1, for the worst over
//! several, and for each; the results are E1max along k1, the range of k1 in which a design stays effective, and the cost of a wider range.
//!
//! Each damper is tuned for the nominal k1 of its study first, then outwards from there: the study's search is repeated, with one more
//! refinement from the design of the neighbouring k1. Read `anew` (the searches), `tuned` (their results), `curves`, `range`, `trade`,
//! `force`, then `page`.

mod anew;
mod curves;
mod draw;
mod force;
mod page;
mod range;
mod recompute;
mod retained;
mod trade;
mod tuned;

pub use curves::Curve;
pub use force::Forced;
pub use range::{Range, Threshold, best_tmd};
pub use retained::Retained;
pub use trade::Point;
pub use tuned::{Tuned, Tuning};

use crate::artefact::Kind;
use crate::designs::{Designs, Row};
use crate::job::{Done, Job, Made};
use crate::needs::Largest;
use crate::resolved;
use crate::searches::Searches;
use crate::summary::TunedDamper;
use crate::{Error, Observer, Request};
use retune_model::Positive;
use retune_study::{self as study, Setting, SettingError};
use serde_json::json;
use tuned::{CURVES, DESIGNS, FORCES, RANGES};

/// The files of the retention of tuning.
pub static KIND: Kind = Kind {
    command: "retention",
    answer: DESIGNS,
    input: resolved::SEVERAL,
    rows: &[
        (DESIGNS, recompute::rows),
        (CURVES, recompute::rows),
        (RANGES, recompute::rows),
        (FORCES, recompute::rows),
    ],
    whole: &[],
    derived: &[
        "retune.txt",
        "retention.svg",
        "still.svg",
        "force.svg",
        "path.svg",
        "range.svg",
        "README.md",
        "report.html",
    ],
};

/// Tunes dampers for each stiffness of the primary structure and for the worst over all, and computes the retention of each tuning.
///
/// # Errors
/// A study or a stiffness is wrong, nothing can be computed, or the results cannot be written.
pub fn retention(
    request: &Request,
    stiffnesses: &[Setting],
    watch: &dyn Observer,
) -> Result<Done<Retained>, Error> {
    let (options, rows) = study::read_rows(&request.study)?;
    for setting in stiffnesses {
        let refused = |source| SettingError::OutOfRange { name: setting.what(), source };
        Positive::new(setting.value()).map_err(refused)?;
        rows.iter().try_for_each(|row| row.study.with(std::slice::from_ref(setting)).map(drop))?;
    }
    let mut others: Vec<f64> = stiffnesses.iter().map(Setting::value).collect();
    others.sort_by(f64::total_cmp);
    others.dedup();
    let mut k1 = others.clone();
    k1.extend(rows.iter().map(|row| row.study.scene.primary.stiffness.get()));
    k1.sort_by(f64::total_cmp);
    k1.dedup();
    let plan = json!({ "k1": k1, "k2_bounds": options.k2_bounds, "samples": options.samples });
    let studies = rows.iter().map(|row| (row.damper.as_str(), &row.study));
    let job = Job::of_studies(&KIND, request, plan, studies)?;
    job.run(request, watch, |directory| {
        let mut searches = Searches::new(directory, &job.order, watch);
        let (mut dampers, mut designs) = (Vec::new(), Vec::new());
        for row in &rows {
            let (tuned, rows) = anew::tune(row, &options, &others, &mut searches)?;
            designs.extend(given(&tuned));
            designs.extend(rows.into_iter().map(|row| on_common_samples(&tuned, row, &k1)));
            dampers.push(tuned.with_thresholds()?);
        }
        let table = Designs { column: "tuning", rows: designs, infeasible: searches.infeasible.take() };
        let (curves, forced) = (curves::curves(&dampers), force::forced(&dampers));
        let (mut kept, mut points) = (Vec::new(), Vec::new());
        for (number, damper) in dampers.iter().enumerate() {
            kept.extend(damper.kept.iter().map(|(tuning, at)| Point::new((number, damper), *tuning, *at)));
            points.extend(trade::trade(number, damper, &searches)?);
        }
        directory.write(FORCES, &force::table(&dampers, &forced).csv())?;
        directory.write(CURVES, &curves::table(&dampers, &curves).csv())?;
        directory.write(RANGES, &trade::table(&dampers, kept.iter().chain(&points)).csv())?;
        table.write("retune", directory)?;
        let bounds = options.k2_bounds;
        let retained = Retained { dampers, bounds, curves, forced, kept, points, table };
        page::write(&retained, directory)?;
        let report = format!("\n{}\n\n{}", page::answer(&retained).join("\n"), retained.table.text());
        Ok(Made { report, answer: retained, parts: searches.results })
    })
}

/// The row with E1max on the common samples, so that designs are compared on the same frequencies.
fn on_common_samples(tuned: &Tuned, row: Row, k1: &[f64]) -> Row {
    let at = row.found.design_of(tuned.study().varied());
    let e1_max = tuned.energy_as_tuned(&row.label, &at, k1).unwrap_or(f64::NAN);
    Row { e1_max, ..row }
}

/// The row of the given design at the nominal stiffness. It is not certified here.
fn given(tuned: &Tuned) -> Option<Row> {
    let (tuning, at) = *tuned.kept.iter().find(|(tuning, _)| Tuning::GIVEN.contains(tuning))?;
    let damper = tuned.study().scene.damper?;
    let origin = if tuning == Tuning::Paper { "the paper's design" } else { "the design of the study" };
    Some(Row {
        label: tuning.name().to_owned(),
        damper: tuned.name.clone(),
        found: TunedDamper::of(&at.on(damper), tuned.study().varied()),
        printed: None,
        e1_max: tuned.energy(&at, tuned.nominal()),
        none: tuned.study().energy_without_damper(),
        verdict: "",
        reason: format!("{origin} is not certified here"),
        needs: Largest::of(tuned.study(), &tuned.study().scene_at(&at)?),
    })
}
