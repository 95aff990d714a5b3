//! The page's contents as a report to keep: figures, curves, motion, summary of the run and study, in the style of all results.

use crate::kind::kind;
use crate::motion::{figures, look_up};
use crate::refused::Refused;
use crate::response::{Stale, worst};
use crate::sheets;
use maud::html;
use retune_jobs::simulate::{Simulation, simulate};
use retune_model::Measure;
use retune_report::document::{Block, Document, Section};
use retune_report::html::figure;
use retune_report::{Sheet, drawing};
use retune_study::{Study, rounded};
use serde_json::Value;

/// The parts of a report that are not computed for it.
pub struct Said {
    /// The command line that makes the same run.
    pub command: String,
    /// The text of the study file with all changes.
    pub file: String,
    /// The quantity of its curves; what the study minimises if left out.
    pub quantity: Option<Measure>,
}

/// The page.
///
/// # Errors
/// A run fails, or the work has become stale.
pub fn html(
    study: &Study,
    pins: &[Option<Study>; 2],
    said: &Said,
    is_stale: &(dyn Fn() -> bool + Sync),
) -> Result<String, Refused> {
    let gone = |Stale| Refused::whole("the page has gone");
    let run = simulate(study, None).map_err(Refused::whole)?;
    let quantity = said.quantity.unwrap_or_else(|| study.quantity());
    let mut sections = vec![numbers(study, &run, pins, is_stale).map_err(gone)?];
    if !study.scene.forcing.is_transient() {
        let sheet = sheets::response(study, pins, quantity, is_stale).map_err(gone)?;
        sections.push(("response", "Response over frequency", vec![drawn(&sheet)]));
    }
    sections.push(("motion", "Motion", vec![drawn(&sheets::motion(study)?)]));
    sections.push(("run", "The run", vec![verbatim(&run.to_string())]));
    let folded = Block::Folded("The study as a file".to_owned(), vec![verbatim(&said.file)]);
    sections.push(("study", "The study", vec![folded]));
    let document = Document {
        title: format!("{}, as explored", study.name()),
        command: "retune explore",
        opening: vec![
            Block::About("The damper", sheets::words(study)),
            Block::About("The same run", said.command.clone()),
        ],
        sections,
    };
    Ok(document.html())
}

/// The figures of the run, beside the worst over the band and those of the pinned designs.
fn numbers(
    study: &Study,
    run: &Simulation,
    pins: &[Option<Study>; 2],
    is_stale: &(dyn Fn() -> bool + Sync),
) -> Result<Section, Stale> {
    let omega = study.scene.forcing.frequency.get();
    let here =
        if omega > 0.0 { format!("at ω = {} rad/s", rounded(omega, 5)) } else { "this run".to_owned() };
    let mut columns = vec![(here, figures(run))];
    let over_band = !study.scene.forcing.is_transient();
    let all = [
        ("worst of the band, from rest on", Some(study)),
        ("A, worst", pins[0].as_ref()),
        ("B, worst", pins[1].as_ref()),
    ];
    for (name, study) in all {
        let Some(study) = study.filter(|_| over_band) else { continue };
        let found = worst(study, "now", is_stale)?;
        columns.push((name.to_owned(), found.get("figures").cloned().unwrap_or(Value::Null)));
    }
    let head: Vec<String> = ["largest value".to_owned()]
        .into_iter()
        .chain(columns.iter().map(|(name, _)| name.clone()))
        .collect();
    let row = |measure: Measure| {
        let heading = format!("{}, {}", measure.words().trim_start_matches("the largest "), measure.unit());
        [heading].into_iter().chain(columns.iter().map(|(_, of)| look_up(of, measure))).collect()
    };
    let label = kind(study).0.get("label").and_then(Value::as_str).unwrap_or("unknown").to_owned();
    let blocks = vec![
        Block::About("Motion", label),
        Block::table("The largest values", head, Measure::ALL.map(row).to_vec()),
    ];
    Ok(("figures", "Figures", blocks))
}

fn drawn(sheet: &Sheet) -> Block {
    Block::Elements(figure(&drawing(sheet), html! { (sheet.title) "." }))
}

fn verbatim(text: &str) -> Block {
    Block::Elements(html! { pre tabindex="0" { (text) } })
}
