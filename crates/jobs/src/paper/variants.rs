//! Repeats the verdicts on all figures under settings that the paper leaves out: other radii R, other windows of the maxima, and contacts
//! that lose energy, as in every real damper.

use super::item::Item;
use super::plan::{Plan, RADII, Range};
use super::{cases, curves, energies, regimes, surfaces};
use crate::observer::Quiet;
use crate::{Error, Observer};
use retune_model::Parameter;
use retune_report::cells;
use retune_report::document::Verdict;
use retune_report::table::{Cell, Table};
use retune_study::{Settable, Setting, Study, joined, short};
use std::collections::BTreeMap;

/// Shares of a run before the window of its maxima, besides the study's.
const BEFORE: [f64; 2] = [0.0, 0.25];
/// A restitution of contacts as measured on steel and hard rubber.
const RESTITUTION: f64 = 0.7;
/// Most frequencies of worst cases and of motions, and most points of curves: fewer than on the rest of the page.
const LADDER: usize = 301;
const MOTIONS: usize = 41;
const POINTS: usize = 36;

type Figure = fn(&Plan) -> Result<Item, Error>;
const FIGURES: [(&str, Figure); 6] = [
    ("Figure 2", surfaces::figure2),
    ("Figure 3", curves::figure3),
    ("Figure 4", regimes::figure4),
    ("Figure 5", energies::figure5),
    ("Figure 6", energies::figure6),
    ("Figure 7", cases::figure7),
];

/// The verdicts on a statement under each of the settings.
struct Verdicts {
    figure: &'static str,
    paper: String,
    all: Vec<Verdict>,
}

pub fn figures(plan: &Plan) -> Result<Item, Error> {
    let mut item = Item::new(plan.made_by(&format!(
        "All figures again, with only what is named changed, on fewer points: worst cases on {LADDER} frequencies at most, maps with a quarter of the nodes, motions at {MOTIONS} frequencies."
    )));
    let quiet = Quiet(plan.watch);
    let end = plan.window().to;
    let radius = |radius| (format!("R = {} m", short(radius)), Setting::new(Parameter::R, radius));
    let window = |share| {
        let from = share * end;
        (format!("{} to {} s", short(from), short(end)), Setting::new(Settable::From, from))
    };
    let loss = (format!("e = {}", short(RESTITUTION)), Setting::new(Parameter::Restitution, RESTITUTION));
    let settings: Vec<(String, Setting)> =
        RADII.map(radius).into_iter().chain(BEFORE.map(window)).chain([loss]).collect();
    let bar = plan.watch.progress("figures, settings", (settings.len() * FIGURES.len()) as u64);
    let mut verdicts: Vec<Verdicts> = Vec::new();
    for (number, (_, change)) in settings.iter().enumerate() {
        let brief = brief(plan, change, &quiet)?;
        for (figure, make) in FIGURES {
            for statement in make(&brief)?.statements {
                let same = |other: &&mut Verdicts| other.figure == figure && other.paper == statement.paper;
                match verdicts.iter_mut().find(same) {
                    Some(known) => known.all.push(statement.verdict),
                    // A new statement is ignored here, since it was not made under the first settings.
                    None if number == 0 => {
                        let (paper, all) = (statement.paper, vec![statement.verdict]);
                        verdicts.push(Verdicts { figure, paper, all });
                    }
                    None => {}
                }
            }
            bar.inc(1);
        }
    }
    bar.finish();
    let names: Vec<&str> = settings.iter().map(|(name, _)| name.as_str()).collect();
    let mut table = Table::headed(&format!("figure | statement | {}", joined(&names, " | ")));
    for Verdicts { figure, paper, all } in &verdicts {
        let words = all.iter().map(|verdict| Cell::from(verdict.words())).collect();
        table.push([cells![*figure, paper.as_str()], words].concat());
    }
    let caption =
        "Verdicts under other radii, windows and losses of contacts: one at a time, the rest as in the study";
    item.table(caption, table);
    item.notes.push(summary(&verdicts));
    Ok(item)
}

/// The plan with some settings changed, on fewer points.
fn brief<'a>(plan: &Plan, change: &Setting, quiet: &'a dyn Observer) -> Result<Plan<'a>, Error> {
    let changed = |study: &Study| -> Result<Study, Error> { Ok(study.with(std::slice::from_ref(change))?) };
    let fewer = |range: Range, most: usize| Range { points: range.points.min(most), ..range };
    let mut file = plan.file.clone();
    let finest = file.ladder.iter().copied().rfind(|samples| *samples <= LADDER);
    file.ladder =
        vec![file.ladder.last().map_or(LADDER, |last| (*last).min(LADDER)).max(finest.unwrap_or(2))];
    (file.omega, file.motions) = (fewer(file.omega, LADDER), fewer(file.motions, MOTIONS));
    file.k1_range = fewer(file.k1_range, POINTS);
    Ok(Plan { file, ssvi: changed(&plan.ssvi)?, tmd: changed(&plan.tmd)?, watch: quiet, is_brief: true })
}

/// The number of verdicts that are the same under all settings, and the others, in words.
fn summary(verdicts: &[Verdicts]) -> String {
    let mut changing = Vec::new();
    for Verdicts { figure, paper, all } in verdicts {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        all.iter().for_each(|verdict| *counts.entry(verdict.words()).or_default() += 1);
        if counts.len() > 1 {
            let counts: Vec<String> =
                counts.iter().map(|(words, count)| format!("{count} × {words}")).collect();
            changing.push(format!("{figure}, \u{201c}{paper}\u{201d}: {}", joined(&counts, ", ")));
        }
    }
    let (count, same) = (verdicts.len(), verdicts.len() - changing.len());
    let others =
        if changing.is_empty() { "" } else { &format!(" These are not: {}.", joined(&changing, "; ")) };
    format!("Of {count} verdicts {same} are the same under all of these settings.{others}")
}
