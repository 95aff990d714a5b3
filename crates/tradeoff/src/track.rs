//! `track`: both dampers tuned anew for each stiffness k1 of the structure, and E1max of each tuning at other stiffnesses.
//!
//! Each damper is tuned for its study's own k1 first, then outwards from there: every search of the study is made again, and one
//! more refinement starts at the design of the neighbouring k1.

mod again;
mod draw;
mod tuned;

pub use again::again;
pub use tuned::{Curves, Tuned, column, energy};

use retune_study::{self as study, PaperStudy, PerVariable, Setting, Study, short};
use retune_workbench::artefact::{Content, Kind, artefact};
use retune_workbench::designs::{Designs, Row};
use retune_workbench::job::{Done, Job, Made};
use retune_workbench::resolved;
use retune_workbench::searches::Searches;
use retune_workbench::tune::Found;
use retune_workbench::{Error, Observer, Request};
use serde_json::json;
use tuned::{csv, retention};

/// The files of the retention of tuning.
pub static KIND: Kind = Kind {
    command: "track",
    answer: tuned::DESIGNS,
    artefacts: &[
        artefact(resolved::SEVERAL, Content::Input),
        artefact(tuned::DESIGNS, Content::Designs),
        artefact("retention.csv", Content::Own),
        artefact("retune.txt", Content::Derived),
        artefact("retention.svg", Content::Derived),
        artefact("path.svg", Content::Derived),
    ],
};

/// The dampers tuned for several stiffnesses of the primary structure.
#[derive(Debug)]
pub struct Tracked {
    /// Each damper with its designs.
    pub tuned: Vec<Tuned>,
    /// E1max along k1.
    pub curves: Curves,
    /// All designs as a table.
    pub table: Designs,
}

/// Tunes both dampers anew for each stiffness of the primary structure, and computes how each tuning does at other stiffnesses.
///
/// # Errors
/// A study or a stiffness is wrong, nothing can be computed, or the results cannot be written.
pub fn track(
    request: &Request,
    stiffnesses: &[Setting],
    watch: &dyn Observer,
) -> Result<Done<Tracked>, Error> {
    let rows = study::read_table2(&request.study)?;
    for setting in stiffnesses {
        rows.iter().try_for_each(|row| row.study.with(std::slice::from_ref(setting)).map(drop))?;
    }
    let k1: Vec<f64> = stiffnesses.iter().map(Setting::value).collect();
    let studies = rows.iter().map(|row| (row.damper.as_str(), &row.study));
    let job = Job::of_studies(&KIND, request, json!({ "k1": k1 }), studies)?;
    job.run(request, watch, |directory| {
        let mut searches = Searches::new(directory, &job.order, watch);
        let mut designs: Vec<(f64, Row)> = Vec::new();
        let tuned = rows
            .iter()
            .map(|row| tune(row, stiffnesses, &mut searches, &mut designs, watch))
            .collect::<Result<Vec<Tuned>, Error>>()?;
        designs.sort_by(|a, b| a.0.total_cmp(&b.0)); // stable: the dampers in their order under each stiffness
        let Searches { results: parts, infeasible, .. } = searches;
        let table =
            Designs { column: "k1", rows: designs.into_iter().map(|(_, row)| row).collect(), infeasible };
        let curves = retention(&tuned);
        directory.write("retention.csv", &csv(&tuned, &curves))?;
        directory.write("retention.svg", &draw::retention(&tuned, &curves))?;
        directory.write("path.svg", &draw::path(&tuned))?;
        table.write("retune", directory)?;
        Ok(Made { report: format!("\n{}", table.text()), answer: Tracked { tuned, curves, table }, parts })
    })
}

/// Tunes one damper for the stiffness of its study, then for each of `others`: upwards from there, then downwards.
fn tune(
    PaperStudy { damper: name, study, .. }: &PaperStudy,
    others: &[Setting],
    searches: &mut Searches,
    rows: &mut Vec<(f64, Row)>,
    watch: &dyn Observer,
) -> Result<Tuned, Error> {
    let nominal = study.scene.primary.stiffness.get();
    let sorted = |wanted: &dyn Fn(f64) -> bool| {
        let mut stiffnesses: Vec<f64> = others.iter().map(Setting::value).filter(|k1| wanted(*k1)).collect();
        stiffnesses.sort_by(f64::total_cmp);
        stiffnesses.dedup();
        stiffnesses
    };
    let mut at = |k1: f64, neighbour: Option<Found>| -> Result<Found, Error> {
        let study = warm(study, k1, neighbour)?;
        let warm = if neighbour.is_some() { ", and from the design of the k1 beside it" } else { "" };
        let natural = short(study.scene.primary.natural_frequency());
        watch.log(&format!(
            "\n{name} at k1 = {k1} N/m (natural frequency {natural} rad/s), {}{warm}",
            study::over(&study.objective(), study.scene.forcing.frequency.get())
        ))?;
        let optimum = searches.tune(&study, &format!("k1-{k1}"))?;
        watch.log(&optimum.report())?;
        rows.push((k1, Row::of_optimum(&k1.to_string(), name, &study, &optimum)));
        Ok(optimum.found())
    };
    let nominal_design = at(nominal, None)?;
    let (above, mut below) = (sorted(&|k1| k1 > nominal), sorted(&|k1| k1 < nominal));
    below.reverse();
    let mut designs = vec![(nominal, nominal_design)];
    for outwards in [above, below] {
        let mut neighbour = nominal_design;
        for k1 in outwards {
            neighbour = at(k1, Some(neighbour))?;
            designs.push((k1, neighbour));
        }
    }
    designs.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(Tuned { name: name.clone(), study: study.clone(), nominal, nominal_design, designs })
}

/// The study at another stiffness, with one more start.
fn warm(study: &Study, k1: f64, from: Option<Found>) -> Result<Study, Error> {
    let mut study = study.with(&[Setting::new("k1", k1)])?;
    if let (Some(optimize), Some(Found { damper, .. })) = (&mut study.optimize, from) {
        optimize.starts.push(PerVariable::of_design(&damper.design, &optimize.vary));
    }
    Ok(study)
}
