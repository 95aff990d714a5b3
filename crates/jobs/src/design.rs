//! `design`: from a structure and requirements on its damper to a recommendation. First in closed form: no damper, the formulas for the
//! goal, the best TMD. Then an SSVI NES, searched from known good designs. All are compared in every quantity over the band, or under a
//! shock or a record, and the better damper is certified.

mod answer;
mod candidate;
mod comparison;
mod driving;
mod history;
mod modes;
mod motion;
mod page;
mod reading;
mod requirements;
mod resonance;
mod settled;
mod ssvi;
mod table;
mod tmd;
mod trust;
mod typed;
mod words;

use comparison::Comparison;
pub use driving::Driving;
pub use modes::structure;
use requirements::Dampers;
pub use requirements::Requirements;
use tmd::Formula;
pub use typed::{Specification, Typed};

use crate::artefact::Kind;
use crate::job::{Done, Job, Made};
use crate::{Error, Observer, Request, pages, resolved};
use serde_json::json;
use std::path::{Path, PathBuf};

/// The files of a design; `band.svg` for a harmonic, `motion.svg` for a shock or a record.
pub static KIND: Kind = Kind {
    command: "design",
    answer: "design.json",
    input: resolved::SEVERAL,
    rows: &[("comparison.csv", table::recompute)],
    whole: &[],
    derived: &[
        "design.json",
        "answer.txt",
        "studies-*.json",
        "band.svg",
        "motion.svg",
        "damper.svg",
        "README.md",
        "report.html",
    ],
};

/// The directory for the results of a design: `results/<name>`, or, if it holds other results or unfinished work, the first free one of
/// `results/<name>-2`, `-3`, …, so that nothing is discarded. With `resume`, the last one with unfinished work.
pub fn place(requirements: &Requirements, name: &str, resume: bool) -> PathBuf {
    let of = |number: u32| {
        let ending = if number == 1 { String::new() } else { format!("-{number}") };
        Path::new("results").join(format!("{name}{ending}"))
    };
    let is_unfinished = |place: &Path| place.join("unfinished").exists();
    let all = || (1..).map(of);
    if resume {
        let begun = all().take_while(|place| place.exists()).filter(|place| is_unfinished(place)).last();
        return begun.unwrap_or_else(|| of(1));
    }
    let is_ours = |place: &PathBuf| {
        let same = resolved::Resolved::read(place).is_ok_and(|known| known.plan == json!(requirements));
        !place.exists() || same && !is_unfinished(place)
    };
    all().find(is_ours).unwrap_or_else(|| of(1))
}

/// Designs dampers for a structure, and compares them.
///
/// # Errors A number is out of range, nothing can be computed, or the results cannot be written.
pub fn design(
    requirements: &Requirements,
    request: &Request,
    watch: &dyn Observer,
) -> Result<Done<Comparison>, Error> {
    requirements.check_mode()?;
    let (tmd, ssvi) = (requirements.tmd()?, requirements.ssvi()?);
    let mut studies = vec![("TMD", &tmd)];
    if requirements.dampers != Dampers::Tmd {
        studies.push(("SSVI NES", &ssvi));
    }
    let job = Job::of_studies(&KIND, request, json!(requirements), studies.iter().copied())?;
    job.run(request, watch, |directory| {
        let compared = comparison::compare(requirements, [&tmd, &ssvi], directory.journal(), watch)?;
        directory.journal().check()?;
        directory.write("comparison.csv", &table::table(&compared).csv())?;
        directory.write_json("design.json", &compared)?;
        for candidate in compared.dampers() {
            let study = &candidate.study;
            directory.write_json(&format!("studies-{}.json", study.name()), &study.resolved())?;
        }
        let answer = answer::answer(requirements, &compared, &job.out);
        let question = words::question(requirements).join("\n");
        directory.write("answer.txt", &format!("{question}\n\n{answer}\n"))?;
        pages::write(&page::page(requirements, &compared), directory)?;
        Ok(Made { answer: compared, report: format!("\n{answer}"), parts: Vec::new() })
    })
}
