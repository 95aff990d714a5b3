//! What made the page: the study, the version, the solver, and the files beside it.

use super::answer::objective;
use super::findings::Findings;
use crate::resolved;
use maud::html;
use retune_report::document::{Block, Section};
use retune_report::html::{Table, link};
use retune_store::{Identity, manifest};
use retune_study::joined;

/// The section; `study` is the text of `study.json`.
pub fn section(findings: &Findings, files: &[String], study: &str) -> Section {
    let solver = findings.study.solver;
    let window = findings.study.window;
    let Identity { study: sha, version, arithmetic } = Identity::of(study);
    let mut table = Table::wrapping("Study, program and method", &["what", "value"]);
    let mut row = |what: &str, value: String| table.row([what.to_owned(), value]);
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
