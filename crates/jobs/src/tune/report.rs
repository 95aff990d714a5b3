//! The page of a search, `report.html`: the answer first, then how sure it is and how it was found. One file that needs no network
//! and no script. Every number on it is computed or read from what the search has found; nothing is stated that was not.
//!
//! Read `findings` (what a page is made of), `answer` and `flags`, then the sections in their order on the page: `response`,
//! `motion`, `sensitivity`, `place`, `course`, `origin`. `numbers` has how numbers are written, `retune_report::html` the elements.

mod answer;
mod course;
mod curves;
mod findings;
mod flags;
mod motion;
mod numbers;
mod origin;
mod place;
mod response;
mod sensitivity;

pub(crate) use findings::Findings;

use crate::Error;
use crate::resolved::study_text;
use retune_report::document::Document;
use retune_store::Directory;

pub const FILE: &str = "report.html";

/// Writes the page, after all other files of the results but those that say what made them.
pub(crate) fn write(findings: &Findings, results: &Directory) -> Result<(), Error> {
    let flags = flags::flags(findings);
    let compared = findings.compared();
    // A motion without a frequency has no response over frequencies.
    let over_frequency =
        || (!findings.study.scene.forcing.is_transient()).then(|| response::section(findings, &compared));
    let (response, motion) = rayon::join(over_frequency, || motion::section(findings));
    let mut files = results.whole()?;
    files.retain(|name| name != FILE); // that of a run that was cut off
    let answer = answer::section(findings, &compared, &flags);
    let mut sections: Vec<_> = [answer].into_iter().chain(response).collect();
    sections.extend([
        motion?,
        sensitivity::section(findings),
        place::section(findings, &files, results),
        course::section(findings, results),
        origin::section(findings, &files, &study_text(findings.study)?),
    ]);
    let name = findings.study.name();
    let title = format!("{name}: {}", answer::title(findings));
    let page = Document { title, command: "retune optimize", opening: Vec::new(), sections };
    Ok(results.write(FILE, &page.html())?)
}
