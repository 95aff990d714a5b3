//! `fronts`: the least E1max of a damper under ever looser bounds on the spring and on the stroke, and the trade between them.

mod candidate;
mod draw;
mod fronts;
mod page;

pub use candidate::{energy, finer};

use crate::request::{open, where_results_are};
use crate::resolved::{self, Resolved};
use crate::{Error, Observer, Request};
use fronts::{Certified, Fronts};
use retune_store::{Directory, Extent, Identity, manifest};
use retune_study::{self as study, Sweep};
use serde_json::json;

/// Tunes each damper under each bound, and shows what it is good for.
///
/// # Errors
/// A study is wrong, nothing can be computed, or the results cannot be written.
pub fn pareto(request: &Request, watch: &dyn Observer) -> Result<(), Error> {
    let plan = study::read_fronts(&request.study)?;
    let (out, order) = (request.out_of_file()?, request.order("fronts"));
    let dampers = plan.dampers.iter().map(|(name, study)| (name.as_str(), study));
    let resolved = Resolved::new(json!(plan.said), dampers).text()?;
    let solvers: Vec<_> = plan.dampers.iter().map(|(_, study)| study.solver).collect();
    let identity = Identity::of(&resolved);
    let directory = open(&out, &order, &identity, Extent::Whole, is_ours, watch)?;
    request.on_threads(|| {
        let (fronts, parts) = Fronts::search(plan, &directory, &order, watch)?;
        for sweep in Sweep::ALL {
            directory.write(&format!("{}.csv", sweep.name()), &fronts.csv(sweep))?;
            directory.write(&format!("{}.svg", sweep.name()), &draw::sweep(&fronts, sweep))?;
        }
        directory.write("front.csv", &fronts.front_csv())?;
        directory.write("front.svg", &draw::front(&fronts))?;
        let certified = fronts.certify()?;
        for Certified { file, certificate, .. } in &certified {
            directory.write_json(file, certificate)?;
        }
        directory.write("README.md", &page::page(&fronts, &certified))?;
        directory.write(resolved::NAME, &resolved)?;
        manifest::write(identity, solvers, &directory)?;
        directory.publish()?;
        parts.into_iter().try_for_each(Directory::finish)?;
        directory.finish()?;
        watch.result(&format!("\n{}", page::answer(&fronts)))?;
        watch.result(&where_results_are(&out)?)
    })
}

fn is_ours(name: &str) -> bool {
    const NAMES: [&str; 9] = [
        "k2.csv",
        "k2.svg",
        "stroke.csv",
        "stroke.svg",
        "front.csv",
        "front.svg",
        "README.md",
        resolved::NAME,
        manifest::NAME,
    ];
    NAMES.contains(&name) || (name.starts_with("certificate-") && name.ends_with(".json"))
}
