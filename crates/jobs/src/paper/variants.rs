//! What the paper leaves out, for the statements on all figures: each verdict again under other radii R and other windows of the maxima.

use super::item::{Grid, Item, Verdict};
use super::plan::{Plan, Range};
use super::{cases, curves, energies, ratios, regimes, surfaces};
use crate::observer::Quiet;
use crate::{Error, Observer};
use retune_model::Parameter;
use retune_study::{Settable, Setting, Study, short};
use std::collections::BTreeMap;

/// The name of the item.
pub const NAME: &str = "figures";
/// Radii, m.
const RADII: [f64; 5] = [0.1, 0.5, 2.0, 5.0, 10.0];
/// The shares of a run that pass before a window of its maxima, beside that of the study.
const BEFORE: [f64; 2] = [0.0, 0.25];
/// Frequencies on which worst cases are looked at, and of motions and curves at most: fewer than on the rest of the page.
const LADDER: usize = 301;
const MOTIONS: usize = 41;
const POINTS: usize = 36;

/// A figure of the paper.
type Figure = fn(&Plan) -> Result<Item, Error>;
const FIGURES: [Figure; 6] = [
    surfaces::figure2,
    curves::figure3,
    regimes::figure4,
    ratios::figure5,
    energies::figure6,
    cases::figure7,
];

/// Makes the table.
///
/// # Errors
/// A run fails.
pub fn figures(plan: &Plan) -> Result<Item, Error> {
    let mut item = Item::new(
        NAME,
        "What hangs on R and on the window",
        "Neither the radius R of the damper's surfaces nor the window of the maxima.",
        plan.made_by(&format!(
            "All figures again, with only what is named changed, on fewer points: worst cases on {LADDER} frequencies at most, maps with a quarter of the nodes, motions at {MOTIONS} frequencies."
        )),
    );
    let quiet = Quiet(plan.watch);
    let own = plan.window();
    let mut settings: Vec<(String, Vec<Setting>)> = RADII
        .iter()
        .map(|radius| (format!("R = {} m", short(*radius)), vec![Setting::new(Parameter::R, *radius)]))
        .collect();
    for share in BEFORE {
        let from = share * own.to;
        settings.push((
            format!("{} to {} s", short(from), short(own.to)),
            vec![Setting::new(Settable::From, from)],
        ));
    }
    let bar = plan.watch.progress("figures, settings", (settings.len() * FIGURES.len()) as u64);
    let mut head = vec!["figure".to_owned(), "statement".to_owned()];
    let mut verdicts: Vec<(String, String, Vec<Verdict>)> = Vec::new();
    for (number, (name, changes)) in settings.iter().enumerate() {
        head.push(name.clone());
        let brief = brief(plan, changes, &quiet)?;
        for figure in FIGURES {
            let made = figure(&brief)?;
            bar.inc(1);
            for statement in made.statements {
                let place =
                    verdicts.iter().position(|(of, paper, _)| *of == made.name && *paper == statement.paper);
                match place {
                    Some(place) => verdicts[place].2.push(statement.verdict),
                    // A statement that is new here was not made under the settings before.
                    None if number == 0 => {
                        verdicts.push((made.name.clone(), statement.paper, vec![statement.verdict]));
                    }
                    None => {}
                }
            }
        }
    }
    bar.finish();
    let mut grid = Grid {
        head,
        ..Grid::new(
            "Verdicts under other radii (the window of the study) and windows (the radius of the study)",
            &[],
        )
    };
    for (figure, paper, all) in &verdicts {
        let mut row = vec![figure.replace("figure", "Figure "), paper.clone()];
        row.extend(all.iter().map(|verdict| verdict.words().to_owned()));
        grid.rows.push(row);
    }
    item.grids.push(grid);
    item.notes.push(summary(&verdicts));
    Ok(item)
}

/// The plan with some settings changed, on fewer points.
fn brief<'a>(plan: &Plan, changes: &[Setting], quiet: &'a dyn Observer) -> Result<Plan<'a>, Error> {
    let changed = |study: &Study| -> Result<Study, Error> { Ok(study.with(changes)?) };
    let fewer = |range: Range, most: usize| Range { points: range.points.min(most), ..range };
    let mut file = plan.file.clone();
    let finest = file.ladder.iter().copied().rfind(|samples| *samples <= LADDER);
    file.ladder =
        vec![file.ladder.last().map_or(LADDER, |last| (*last).min(LADDER)).max(finest.unwrap_or(2))];
    (file.omega, file.motions) = (fewer(file.omega, LADDER), fewer(file.motions, MOTIONS));
    file.k1_range = fewer(file.k1_range, POINTS);
    Ok(Plan { file, ssvi: changed(&plan.ssvi)?, tmd: changed(&plan.tmd)?, watch: quiet, is_brief: true })
}

/// How many verdicts are the same under all settings, and which are not.
fn summary(verdicts: &[(String, String, Vec<Verdict>)]) -> String {
    let same = |all: &[Verdict]| all.iter().all(|verdict| verdict == &all[0]);
    let changing: Vec<String> = verdicts
        .iter()
        .filter(|(_, _, all)| !same(all))
        .map(|(figure, paper, all)| {
            let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
            all.iter().for_each(|verdict| *counts.entry(verdict.words()).or_default() += 1);
            let counts: Vec<String> =
                counts.iter().map(|(words, count)| format!("{count} × {words}")).collect();
            format!("{}, \u{201c}{paper}\u{201d}: {}", figure.replace("figure", "Figure "), counts.join(", "))
        })
        .collect();
    let whole = format!(
        "Of {} verdicts {} are the same under all of these settings.",
        verdicts.len(),
        verdicts.len() - changing.len()
    );
    if changing.is_empty() { whole } else { format!("{whole} These are not: {}.", changing.join("; ")) }
}
