//! The job `branches`: the periodic motions that runs of a scene settle on along a parameter, and those that branch off; their stability,
//! bifurcations and coexistence, and the largest E1max of all.
//!
//! The motions are found by `retune_dynamics::periodic`. Read `options` (the request), `motions` (the result), `tables` (the files, and how
//! their rows are recomputed), `draw`, `page`.

mod draw;
mod motions;
mod options;
mod page;
mod tables;

pub use motions::{Margin, Motions};
pub use options::Options;
pub use tables::summary;

use crate::artefact::Kind;
use crate::job::{Done, Job, Made};
use crate::{Error, Observer, Request, resolved};
use options::plan_json;
use retune_dynamics::periodic::Plane;
use retune_dynamics::periodic::basins::SIDE;
use retune_dynamics::periodic::branches::{Control, branches as follow};
use retune_study::read;

/// The files of `branches`.
pub static KIND: Kind = Kind {
    command: "branches",
    answer: "branches.json",
    input: resolved::SEVERAL,
    rows: &[
        (tables::BRANCHES, tables::recompute),
        (tables::BIFURCATIONS, tables::recompute),
        (tables::ATTRACTORS, tables::recompute),
        (tables::STARTS, tables::recompute),
    ],
    whole: &[],
    derived: &[tables::STATES, "branches.json", "branches.svg", "basins.svg", "README.md", "report.html"],
};

/// Follows the branches of the scene of a study, or of the design that a search found, along a parameter.
///
/// # Errors
/// The study or what is asked for is wrong, a scene in the range cannot be run, or the results cannot be written.
pub fn branches(request: &Request, options: &Options, watch: &dyn Observer) -> Result<Done<Motions>, Error> {
    let study = read(&request.study)?;
    let (plan, basins_at) = options.plan(&study)?;
    let request = request.placed(KIND.command, &study, plan.parameter.symbol())?;
    let mut plan_values = plan_json(&plan);
    if options.margin {
        plan_values["margin"] = true.into();
    }
    if let Some(value) = basins_at {
        plan_values["basins"] = value.into();
    }
    let job = Job::of_studies(&KIND, &request, plan_values, [(study.name(), &study)].into_iter())?;
    job.run(&request, watch, |directory| {
        let bar = watch.progress("runs from many starts", plan.samples as u64);
        let count = Control { done: &|| bar.inc(1), ..Control::default() };
        let branches = follow(&study.scene, plan, &study.solver.settings(), count)?;
        bar.finish();
        let mut motions = Motions::new(study.clone(), branches);
        if options.margin {
            motions.margin = motions::margin(&motions)?;
        }
        if let Some(value) = basins_at {
            let bar = watch.progress("rows of starts in a plane", SIDE as u64);
            let known = Some(&motions.branches);
            let plane = Plane::new(&study.scene, plan, &study.solver.settings(), value, known)?;
            motions.basins = Some(plane.basins(|| bar.inc(1))?);
            bar.finish();
        }
        for (name, table) in tables::tables(&motions) {
            directory.write(name, &table.csv())?;
        }
        directory.write_json("branches.json", &summary(&motions))?;
        page::write(&motions, directory)?;
        let report = format!("\n{}", page::answer(&motions).join("\n"));
        Ok(Made { report, answer: motions, parts: Vec::new() })
    })
}
