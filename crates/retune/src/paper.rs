//! `reproduce`, `figure`, `table`: the whole paper, made again beside what it says.

mod cases;
mod curves;
mod energies;
mod item;
mod motions;
mod page;
mod plan;
mod ratios;
mod surfaces;
mod table1;
mod table2;

pub use plan::{PaperPlan, Plan};

use crate::cli::Reproduce;
use crate::error::Error;
use crate::optimize::{where_results_are, with_threads};
use crate::results::Directory;
use crate::screen::Screen;
use item::Item;
use std::path::PathBuf;

/// What makes an item.
type Maker = fn(&Plan) -> Result<Item, Error>;

/// Every item, in the order of the page.
const ITEMS: [(&str, Maker); 8] = [
    ("table1", table1::table1),
    ("table2", table2::table2),
    ("figure2", surfaces::figure2),
    ("figure3", curves::figure3),
    ("figure4", motions::figure4),
    ("figure5", ratios::figure5),
    ("figure6", energies::figure6),
    ("figure7", cases::figure7),
];

/// Makes every item and the page that holds them.
///
/// # Errors
/// The study is wrong, nothing can be computed, or the results cannot be written.
pub fn reproduce(arguments: &Reproduce) -> Result<(), Error> {
    run(arguments, |_| true, true)
}

/// Makes the item `name`.
///
/// # Errors
/// As [`reproduce`].
pub fn one(name: &str, arguments: &Reproduce) -> Result<(), Error> {
    run(arguments, |other| other == name, false)
}

fn run(arguments: &Reproduce, wanted: impl Fn(&str) -> bool + Sync, page: bool) -> Result<(), Error> {
    let running = &arguments.running;
    let screen = Screen::new(running.quiet);
    let plan = Plan::read(&arguments.study, screen)?;
    let out = running.out.clone().unwrap_or_else(|| PathBuf::from("results/paper"));
    let results =
        Directory::create(&out, |file| ITEMS.iter().any(|(name, _)| wanted(name) && is_of(file, name)))?;
    with_threads(running.threads, || {
        results.write_json("study.json", &plan.file)?;
        let mut items = Vec::new();
        for (_, make) in ITEMS.iter().filter(|(name, _)| wanted(name)) {
            let item = make(&plan)?;
            write(&item, &results)?;
            screen.line(report(&item))?;
            items.push(item);
        }
        if page {
            results.write("index.html", &page::page(&items))?;
        }
        screen.line(where_results_are(&out)?)
    })
}

fn is_of(file: &str, name: &str) -> bool {
    file.strip_prefix(name).is_some_and(|rest| rest.starts_with(['.', '-']))
}

fn write(item: &Item, results: &Directory) -> Result<(), Error> {
    for picture in &item.pictures {
        results.write(&format!("{}.svg", picture.name), &picture.svg)?;
    }
    for (i, grid) in item.grids.iter().enumerate() {
        results.write(&format!("{}-table-{}.csv", item.name, i + 1), &grid.csv())?;
    }
    for (name, content) in &item.data {
        results.write(name, content)?;
    }
    results.write_json(&format!("{}-statements.json", item.name), &item.statements)
}

/// The verdicts of an item, for the screen.
fn report(item: &Item) -> String {
    let lines =
        item.statements.iter().map(|s| format!("\n  {:<14} {} ({})", s.verdict.words(), s.paper, s.found));
    format!("{}{}", item.title, lines.collect::<String>())
}
