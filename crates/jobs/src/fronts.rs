//! `fronts`: the least E1max of dampers under ever looser bounds on the spring, the stroke and the contact force, and the trade-off between
//! them.

mod candidate;
mod descents;
mod designs;
mod draw;
mod page;
mod places;
mod search;

pub(crate) use candidate::SAME;

use crate::artefact::Kind;
use crate::job::{Done, Job, Made};
use crate::resolved;
use crate::searches::Searches;
use crate::{Error, Observer, Request};
use retune_study as study;
use serde_json::json;

/// The files of Pareto fronts.
pub static KIND: Kind = Kind {
    command: "fronts",
    answer: "front.csv",
    input: resolved::SEVERAL,
    rows: &[
        ("k2.csv", crate::designs::recompute),
        ("stroke.csv", crate::designs::recompute),
        ("contact_force.csv", crate::designs::recompute),
        ("front.csv", crate::designs::recompute),
    ],
    whole: &[("certificate-*.json", designs::recompute)],
    derived: &["k2.svg", "stroke.svg", "contact_force.svg", "front.svg", "README.md", "report.html"],
};

/// Tunes each damper under each bound and compares them.
///
/// # Errors
/// A study is wrong, nothing can be computed, or the results cannot be written.
pub fn fronts(request: &Request, watch: &dyn Observer) -> Result<Done<()>, Error> {
    let plan = study::read_fronts(&request.study)?;
    let dampers = plan.dampers.iter().map(|(name, study)| (name.as_str(), study));
    let job = Job::of_studies(&KIND, request, json!(plan.said), dampers)?;
    job.run(request, watch, |directory| {
        let searches = Searches::new(directory, &job.order, watch);
        let fronts = search::search(plan, &searches)?;
        for sweep in fronts.plan.sweeps() {
            directory.write(&format!("{}.csv", sweep.name()), &fronts.table(sweep).csv())?;
        }
        directory.write("front.csv", &fronts.front_table().csv())?;
        for one in &fronts.certified {
            directory.write_json(&one.file, &one.certificate)?;
        }
        page::write(&fronts, directory)?;
        let report = format!("\n{}", page::answer(&fronts).join("\n"));
        Ok(Made { report, answer: (), parts: searches.results })
    })
}
