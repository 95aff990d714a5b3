//! Every table and figure of the paper, reproduced beside its statements, with a verdict on each.

mod cases;
mod curves;
mod detuning;
mod diagrams;
mod energies;
mod family;
mod item;
mod judgement;
mod motions;
mod page;
mod plan;
mod ratios;
mod regimes;
mod surfaces;
mod table1;
mod table2;

pub use plan::{PaperPlan, Plan};

use item::Item;
use retune_store::{Directory, Extent, Identity, manifest};
use retune_workbench::request::{open, where_results_are};
use retune_workbench::{Error, Observer, Request, resolved};

/// The function that makes an item.
type Maker = fn(&Plan) -> Result<Item, Error>;

/// Every item, in the order of the page.
const ITEMS: [(&str, Maker); 8] = [
    ("table1", table1::table1),
    ("table2", table2::table2),
    ("figure2", surfaces::figure2),
    ("figure3", curves::figure3),
    ("figure4", regimes::figure4),
    ("figure5", ratios::figure5),
    ("figure6", energies::figure6),
    ("figure7", cases::figure7),
];

/// Makes every item of the paper and the page that holds them, or only the item `only` (`table1`, `figure4`).
///
/// # Errors
/// The study is wrong, nothing can be computed, or the results cannot be written.
pub fn reproduce(request: &Request, only: Option<&str>, watch: &dyn Observer) -> Result<(), Error> {
    let plan = Plan::read(&request.study, watch)?;
    let (out, order) = (request.out_of_file()?, request.order("reproduce"));
    let is_page = only.is_none();
    let only = only.map(str::to_owned);
    let wanted = move |name: &str| only.as_deref().is_none_or(|only| only == name);
    let items: Vec<_> = ITEMS.into_iter().filter(|(name, _)| wanted(name)).collect();
    let is_ours = move |file: &str| {
        [manifest::NAME, resolved::NAME, "study.json"].contains(&file)
            || file == "index.html" && is_page
            || ITEMS.iter().any(|(name, _)| wanted(name) && is_of(file, name))
    };
    let extent = if is_page { Extent::Whole } else { Extent::Share };
    let resolved = plan.resolved().text()?;
    let identity = Identity::of(&resolved);
    let results = open(&out, &order, &identity, extent, is_ours, watch)?;
    request.on_threads(|| {
        results.write_json("study.json", &plan.file)?;
        let mut made = Vec::new();
        for (name, make) in items {
            let item = kept_or_made(name, make, &plan, &results)?;
            write(&item, &results)?;
            watch.result(&report(&item))?;
            made.push(item);
        }
        if is_page {
            results.write("index.html", &page::page(&made))?;
        }
        results.write(resolved::NAME, &resolved)?;
        manifest::write(identity, [plan.ssvi.solver, plan.tmd.solver], &results)?;
        results.finish()?;
        watch.result(&where_results_are(&out)?)
    })
}

/// An item kept by an interrupted run, or made now and kept in case this run is interrupted.
fn kept_or_made(name: &str, make: Maker, plan: &Plan, results: &Directory) -> Result<Item, Error> {
    let (file, journal) = (format!("{name}.item"), results.journal());
    if journal.is_marked(name) {
        let kept = results.read(&file).and_then(|text| serde_json::from_str(&text).ok());
        if let Some(item) = kept {
            return Ok(item);
        }
    }
    let item = make(plan)?;
    results.write_json(&file, &item)?;
    journal.mark(name);
    journal.check()?;
    Ok(item)
}

fn is_of(file: &str, name: &str) -> bool {
    file.strip_prefix(name).is_some_and(|rest| rest.starts_with(['.', '-']))
}

fn write(item: &Item, results: &Directory) -> Result<(), Error> {
    for picture in &item.pictures {
        results.write(&format!("{}.svg", picture.name), &picture.drawing.wide)?;
    }
    for (i, grid) in item.grids.iter().enumerate() {
        results.write(&format!("{}-table-{}.csv", item.name, i + 1), &grid.csv())?;
    }
    for (name, content) in &item.data {
        results.write(name, content)?;
    }
    Ok(results.write_json(&format!("{}-statements.json", item.name), &item.statements)?)
}

/// The verdicts of an item, for the screen.
fn report(item: &Item) -> String {
    let lines =
        item.statements.iter().map(|s| format!("\n  {:<14} {} ({})", s.verdict.words(), s.paper, s.found));
    format!("{}{}", item.title, lines.collect::<String>())
}
