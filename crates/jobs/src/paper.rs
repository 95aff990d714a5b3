//! Every table and figure of the paper, reproduced beside its statements, with a verdict on each.

mod again;
mod begins;
mod cases;
mod curves;
mod describe;
mod detuning;
mod diagrams;
mod energies;
mod family;
mod item;
mod items;
mod judgement;
mod kind;
mod ladder;
mod measures;
mod motions;
mod page;
mod plan;
mod protocols;
mod ratios;
mod regimes;
mod stiff;
mod surfaces;
mod table1;
mod table2;
mod variants;

pub use describe::describe;
use items::{ITEMS, Maker, SEARCHES, statements};

pub use item::{Grid, Item, Picture, Statement, Verdict};
pub use kind::KIND;
pub use plan::{PaperPlan, Plan};

use crate::job::{Job, Made};
use crate::observer::Quiet;
use crate::searches::Searches;
use crate::{Done, Error, Observer, Request};
use retune_store::Directory;

/// Makes every item of the paper and the page that holds them, or only the item `only` (`table1`, `figure4`).
///
/// # Errors
/// The study is wrong, nothing can be computed, or the results cannot be written.
pub fn reproduce(
    request: &Request,
    only: Option<&str>,
    watch: &dyn Observer,
) -> Result<Done<Vec<Item>>, Error> {
    let plan = Plan::read(&request.study, watch)?;
    let dampers = [("SSVI NES", &plan.ssvi), ("TMD", &plan.tmd)];
    let mut job = Job::of_studies(&KIND, request, serde_json::json!(plan.file), dampers.into_iter())?;
    if let Some(only) = only {
        job.answer = statements(only);
        job.only = Some(only.to_owned());
    }
    job.run(request, watch, |results| {
        results.write_json("study.json", &plan.file)?;
        let quiet = Quiet(watch); // the page has the answers of its searches, and they their own logs
        let mut searches = Searches::new(results, &job.order, &quiet);
        let mut made = Vec::new();
        for (name, make) in ITEMS.into_iter().filter(|(name, _)| only.is_none_or(|only| only == *name)) {
            let item = kept_or_made(name, make, &plan, results, &mut searches)?;
            write(&item, results)?;
            watch.result(&report(&item))?;
            made.push(item);
        }
        if only.is_none() {
            results.write("index.html", &page::page(&made))?;
        }
        Ok(Made { answer: made, report: String::new(), parts: searches.results })
    })
}

/// An item kept by an interrupted run, or made now and kept in case this run is interrupted. One that makes searches is made again:
/// they are resumed.
fn kept_or_made(
    name: &str,
    make: Maker,
    plan: &Plan,
    results: &Directory,
    searches: &mut Searches,
) -> Result<Item, Error> {
    let (file, journal) = (format!("{name}.item"), results.journal());
    if journal.is_marked(name) {
        let kept = results.read(&file).and_then(|text| serde_json::from_str(&text).ok());
        if let Some(item) = kept {
            return Ok(item);
        }
    }
    let before = searches.results.len();
    let item = make(plan, &mut |study| Ok(searches.tune(study, SEARCHES)?.found().damper.design))?;
    if searches.results.len() > before {
        return Ok(item);
    }
    results.write_json(&file, &item)?;
    journal.mark(name);
    journal.check()?;
    Ok(item)
}

fn write(item: &Item, results: &Directory) -> Result<(), Error> {
    for picture in &item.pictures {
        results.write(&format!("{}.svg", picture.name), &picture.drawing.wide)?;
    }
    for (name, text) in item.files() {
        results.write(&name, &text)?;
    }
    Ok(results.write_json(&statements(&item.name), &item.statements)?)
}

/// The verdicts of an item, for the screen.
fn report(item: &Item) -> String {
    let lines = item.statements.iter().map(|s| {
        let whose = if s.conjecture { "our conjecture: " } else { "" };
        format!("\n  {:<14} {whose}{} ({})", s.verdict.words(), s.paper, s.found)
    });
    format!("{}{}", item.title, lines.collect::<String>())
}
