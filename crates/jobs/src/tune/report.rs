//! The page of a search, `report.html`: the answer first, then how sure it is and how it was found. One file that needs no network and no
//! script. Every number on it is computed or read from the results of the search.
//!
//! Read `findings` (what a page is made of), `answer`, then the sections in their order on the page: `response`,
//! `motion`, `sensitivity`, `course`. `numbers` has how numbers are written, `retune_report::html` the elements.

mod answer;
mod course;
mod findings;
mod motion;
pub(super) mod numbers;
mod response;
mod sensitivity;

use crate::{Error, resolved};
use answer::objective;
pub(crate) use findings::Findings;
use maud::html;
use retune_report::document::{Block, Document, Section};
use retune_report::html::{Table, link};
use retune_store::{Directory, Identity, manifest};
use retune_study::joined;

pub const FILE: &str = "report.html";

/// Writes the page. It lists the other files, so only the input and the manifest are written after it.
pub(crate) fn write(findings: &Findings, results: &Directory) -> Result<(), Error> {
    let flags = findings.optimum.flags();
    let compared = findings.compared();
    // A motion without a frequency has no response over frequencies.
    let over_frequency =
        || (!findings.study.scene.forcing.is_transient()).then(|| response::section(findings, &compared));
    let (response, motion) = rayon::join(over_frequency, || motion::section(findings));
    let mut files = results.whole()?;
    files.retain(|name| name != FILE); // left by an interrupted run
    let answer = answer::section(findings, &compared, &flags);
    let mut sections: Vec<_> = [answer].into_iter().chain(response).collect();
    sections.extend([
        motion?,
        sensitivity::section(findings),
        course::place(findings, &files, results),
        course::section(findings, results),
        origin(findings, &files, &resolved::study_text(findings.study)?),
    ]);
    let name = findings.study.name();
    let title = format!("{name}: {}", answer::title(findings));
    let page = Document { title, command: "retune optimize", opening: Vec::new(), sections };
    Ok(results.write(FILE, &page.html())?)
}

/// The section; `study` is the text of `study.json`.
fn origin(findings: &Findings, files: &[String], study: &str) -> Section {
    let solver = findings.study.solver;
    let window = findings.study.window;
    let Identity { study: sha, version, arithmetic } = Identity::of(study);
    let mut table = Table::wrapping("Study, program and method", "what | value");
    let mut row = |what: &str, value: String| table.row([what, &value]);
    row("study", findings.study.name().to_owned());
    row("SHA-256 of study.json", sha);
    row("Retune", version);
    row("arithmetic of the machine", arithmetic);
    row("tuned parameters", joined(&findings.search.variables, ", "));
    row("objective", format!("{}, {}", findings.quantity().name(), objective(findings)));
    row("window", format!("{} s to {} s", window.t0.get(), window.end.get()));
    row("method", format!("{}, relative tolerance {:e}", solver.method.name(), solver.rtol));
    row("rule of the certificate", findings.optimum.certificate.rule.clone());
    let mut names: Vec<&str> = files.iter().map(String::as_str).collect();
    names.extend([resolved::ONE, manifest::NAME]);
    names.sort_unstable();
    names.dedup();
    let body = html! {
        (table.markup())
        p { "Files beside this page: " @for (i, name) in names.iter().enumerate() { @if i > 0 { ", " } (link(name)) } "." }
    };
    ("origin", "What made this page", vec![Block::Elements(body)])
}
