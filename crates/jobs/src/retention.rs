//! `retention`: how long a tuning lasts. Dampers tuned for one stiffness k1 of the structure, for the worst over several, and anew for each; E1max
//! of each along k1; the range of k1 in which it still does its work, and what a wider range costs.
//!
//! Each damper is tuned for its study's own k1 first, then outwards from there: every search of the study is made again, and one
//! more refinement starts at the design of the neighbouring k1. Read `anew` (the searches), `tuned` (what they give), `curves`, `range`,
//! `trade`, `force`, then `page`.

mod again;
mod anew;
mod curves;
mod draw;
mod force;
mod page;
mod range;
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
use retune_study::{self as study, Setting};
use serde_json::json;
use tuned::{CURVES, DESIGNS, FORCES, RANGES};

/// The files of the retention of tuning.
pub static KIND: Kind = Kind {
    command: "retention",
    answer: DESIGNS,
    input: resolved::SEVERAL,
    rows: &[(DESIGNS, again::again), (CURVES, again::again), (RANGES, again::again), (FORCES, again::again)],
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

/// Tunes dampers anew for each stiffness of the primary structure, and for the worst over all, and computes how long each tuning lasts.
///
/// # Errors
/// A study or a stiffness is wrong, nothing can be computed, or the results cannot be written.
pub fn retention(
    request: &Request,
    stiffnesses: &[Setting],
    watch: &dyn Observer,
) -> Result<Done<Retained>, Error> {
    let (said, rows) = study::read_rows(&request.study)?;
    for setting in stiffnesses {
        rows.iter().try_for_each(|row| row.study.with(std::slice::from_ref(setting)).map(drop))?;
    }
    let mut others: Vec<f64> = stiffnesses.iter().map(Setting::value).collect();
    others.sort_by(f64::total_cmp);
    others.dedup();
    let mut k1 = others.clone();
    k1.extend(rows.iter().map(|row| row.study.scene.primary.stiffness.get()));
    k1.sort_by(f64::total_cmp);
    k1.dedup();
    let plan = json!({ "k1": k1, "k2_bounds": said.k2_bounds, "samples": said.samples });
    let studies = rows.iter().map(|row| (row.damper.as_str(), &row.study));
    let job = Job::of_studies(&KIND, request, plan, studies)?;
    job.run(request, watch, |directory| {
        let mut searches = Searches::new(directory, &job.order, watch);
        let (mut dampers, mut designs) = (Vec::new(), Vec::new());
        for row in &rows {
            let (tuned, rows) = anew::tune(row, &said, &others, &mut searches)?;
            designs.extend(given(&tuned));
            designs.extend(rows.into_iter().map(|row| on_common_samples(&tuned, row, &k1)));
            dampers.push(tuned.judged()?);
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
        let bounds = said.k2_bounds;
        let retained = Retained { dampers, bounds, curves, forced, kept, points, table };
        page::write(&retained, directory)?;
        let report = format!("\n{}\n\n{}", page::answer(&retained).join("\n"), retained.table.text());
        Ok(Made { report, answer: retained, parts: searches.results })
    })
}

/// A row with E1max on the common samples, so that designs are compared on the same frequencies.
fn on_common_samples(tuned: &Tuned, row: Row, k1: &[f64]) -> Row {
    let at = row.found.design_of(tuned.study().varied());
    let e1_max = tuned.energy_as_tuned(&row.label, &at, k1).unwrap_or(f64::NAN);
    Row { e1_max, ..row }
}

/// The row of the design that is given at the stiffness of its study. It has no certificate here.
fn given(tuned: &Tuned) -> Option<Row> {
    let (tuning, at) = *tuned.kept.iter().find(|(tuning, _)| Tuning::GIVEN.contains(tuning))?;
    let damper = tuned.study().scene.damper?;
    let whose = if tuning == Tuning::Paper { "the paper's design" } else { "the design of the study" };
    Some(Row {
        label: tuning.name().to_owned(),
        damper: tuned.name.clone(),
        found: TunedDamper::of(&at.on(damper), tuned.study().varied()),
        printed: None,
        e1_max: tuned.energy(&at, tuned.nominal()),
        none: tuned.study().energy_without_damper(),
        verdict: "",
        reason: format!("{whose} is not certified here"),
        needs: Largest::of(tuned.study(), &tuned.study().scene_at(&at)?),
    })
}
