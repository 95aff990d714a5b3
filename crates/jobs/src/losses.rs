//! `losses`: the performance of dampers whose contacts lose energy. One is tuned for lossless contacts, one for each restitution, one for
//! the worst of all restitutions, and one is kept as it is: the paper's for the paper's structure, else the study's. Each is evaluated at
//! every restitution, with its energy balance.

mod page;
mod points;

pub use points::{Losses, Point, Tuning};

use crate::artefact::Kind;
use crate::job::{Done, Job, Made};
use crate::paper::TABLE_2;
use crate::resolved;
use crate::rows::of_each;
use crate::searches::Searches;
use crate::{Error, Observer, Request, Silent};
use points::{FILE, at};
use retune_model::{Design, Parameter};
use retune_optim::Unusable;
use retune_study::{Rule, Study, clipped, is_papers_structure, read};
use serde_json::json;

/// The files of the job.
pub static KIND: Kind = Kind {
    command: "losses",
    answer: FILE,
    input: resolved::SEVERAL,
    rows: &[(FILE, points::recompute)],
    whole: &[],
    derived: &["losses.svg", "dashpot.svg", "powers.svg", "README.md", "report.html"],
};

/// Tunes dampers for the restitutions of the objective of a study, and compares them.
///
/// # Errors
/// The study is wrong or has no restitutions, nothing can be computed, or the results cannot be written.
pub fn losses(request: &Request, watch: &dyn Observer) -> Result<Done<Losses>, Error> {
    let study = read(&request.study)?;
    let restitutions = restitutions(&study)?;
    let job = Job::of_studies(&KIND, request, json!({}), [(study.name(), &study)].into_iter())?;
    job.run(request, watch, |directory| {
        let mut searches = Searches::new(directory, &job.order, watch);
        let mut designs: Vec<(Tuning, f64, Design)> = Vec::new();
        for e in &restitutions {
            watch.log(&format!("\nrestitution {e}"))?;
            let mut alone = at(&study, *e)?;
            if let (Some(optimize), Some((.., before))) = (&mut alone.optimize, designs.last()) {
                optimize.starts.push(clipped(before, optimize));
            }
            let found = searches.tune(&alone, &format!("restitution-{e}"))?.damper.design;
            designs.push((Tuning::Anew, *e, found));
        }
        let lossless = designs[0].2; // the first restitution is 1
        watch.log("\nall restitutions at once")?;
        let known: Vec<Design> = designs.iter().map(|(.., design)| *design).collect();
        let hedged = searches.tune_from_known(&study, "all", &known)?.damper.design;
        for (tuning, design) in [untuned(&study)?, (Tuning::Lossless, lossless), (Tuning::Hedged, hedged)] {
            designs.extend(restitutions.iter().map(|e| (tuning, *e, design)));
        }
        let points = of_each(&designs, &Silent, |(tuning, e, design)| {
            Ok((*tuning, Point::new(&study, *e, *design)?))
        })?;
        let losses = Losses { points, study: study.clone() };
        directory.write(FILE, &losses.table().csv())?;
        let report = page::write(&losses, directory)?;
        Ok(Made { report: format!("\n{report}"), answer: losses, parts: searches.results })
    })
}

/// The restitutions of the objective of a study, and 1, from the largest.
fn restitutions(study: &Study) -> Result<Vec<f64>, Error> {
    let set = study.objective().restitution.filter(|_| study.optimize.is_some());
    let set = set.ok_or_else(|| Error::rule(study)(Rule::NoRestitutions))?;
    let mut all: Vec<f64> = set.into_iter().map(|e| e.get()).chain([1.0]).collect();
    all.sort_by(|a, b| b.total_cmp(a));
    all.dedup();
    Ok(all)
}

/// The damper that is not tuned: the paper's on the paper's structure, else the study's.
fn untuned(study: &Study) -> Result<(Tuning, Design), Error> {
    let damper = study.scene.damper.ok_or_else(|| Error::rule(study)(Rule::NoDamper))?;
    if is_papers_structure(&study.scene) {
        Ok((Tuning::Paper, papers()?))
    } else {
        Ok((Tuning::Study, Design::of(&damper)))
    }
}

/// The paper's SSVI NES.
fn papers() -> Result<Design, Error> {
    let value = |parameter| Parameter::PAPER.iter().position(|known| *known == parameter).map(|i| TABLE_2[i]);
    let design = Design::new(|parameter| value(parameter).unwrap_or(f64::NAN));
    design.map_err(|(parameter, source)| Unusable::Value { parameter, source: source.into() }.into())
}
