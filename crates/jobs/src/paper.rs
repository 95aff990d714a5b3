//! Reproduces every table and figure of the paper, with a verdict on each of its statements.

mod cases;
mod curves;
mod detuning;
mod diagrams;
mod energies;
mod family;
mod item;
mod measures;
mod motions;
mod page;
mod plan;
mod regimes;
mod surfaces;
mod table1;
mod table2;
mod variants;

pub use plan::PaperPlan;
pub(crate) use table1::TABLE_2;

use crate::artefact::Kind;
use crate::job::{Job, Made};
use crate::observer::Quiet;
use crate::recompute::{Recomputed, broken, design, json, text};
use crate::resolved::{Resolved, SEVERAL};
use crate::searches::Searches;
use crate::tune::OPTIMUM;
use crate::{
    Done, Error, Observer, Request, Silent, describe as words, fronts, retention, table2 as rows, tune,
};
use item::Item;
use page::{ENTRIES, Entry, page, statements};
use plan::Plan;
use retune_store::Directory;
use retune_study::{self as study, Study};
use serde_json::{Map, Value};
use std::path::Path;

/// The directory of the searches of Table 2.
const SEARCHES: &str = "table2";

/// The files of the reproduction.
pub static KIND: Kind = Kind {
    command: "reproduce",
    answer: "index.html",
    input: SEVERAL,
    rows: &[],
    whole: &[
        ("table1-statements.json", recompute),
        ("table2-statements.json", recompute),
        ("figure*-statements.json", recompute),
    ],
    derived: &["study.json", "table1-*", "table2-*", "figure*", "index.html"],
};

/// Makes every item of the paper and their page, or only the item `only` (`table1`, `figure4`).
///
/// # Errors
/// The study is wrong, nothing can be computed, or the results cannot be written.
pub fn reproduce(request: &Request, only: Option<&str>, watch: &dyn Observer) -> Result<Done<()>, Error> {
    if let Some(unknown) = only.filter(|only| ENTRIES.iter().all(|entry| entry.name != *only)) {
        let all: Vec<&str> = ENTRIES.iter().map(|entry| entry.name).collect();
        let problem =
            format!("\"{unknown}\" is no table or figure of the paper: give one of {}", all.join(", "));
        return Err(Error::Requirement { place: "only".to_owned(), problem });
    }
    let plan = Plan::read(&request.study, watch)?;
    if !study::is_papers_structure(&plan.ssvi.scene) {
        watch.warn("the structure is not the paper's, of which the statements speak; some stiffnesses and frequencies are the paper's all the same");
    }
    let dampers = [("SSVI NES", &plan.ssvi), ("TMD", &plan.tmd)];
    let mut job = Job::of_studies(&KIND, request, serde_json::json!(plan.file), dampers.into_iter())?;
    if let Some(only) = only {
        job.answer = statements(only);
        job.only = Some(only.to_owned());
    }
    job.run(request, watch, |results| {
        results.write_json("study.json", &plan.file)?;
        let quiet = Quiet(watch); // the page has the answers of the searches, which have their own logs
        let mut searches = Searches::new(results, &job.order, &quiet);
        let mut made = Vec::new();
        for entry in ENTRIES.iter().filter(|entry| only.is_none_or(|only| only == entry.name)) {
            let item = kept_or_made(entry, &plan, results, &mut searches)?;
            write(entry, &item, results)?;
            watch.result(&report(entry, &item))?;
            made.push((entry, item));
        }
        if only.is_none() {
            results.write("index.html", &page(&made))?;
        }
        Ok(Made { answer: (), report: String::new(), parts: searches.results })
    })
}

/// An item kept by an interrupted run, or made now and kept in case this run is interrupted. Items with searches are always made, since
/// their searches can be resumed.
fn kept_or_made(
    entry: &Entry,
    plan: &Plan,
    results: &Directory,
    searches: &mut Searches,
) -> Result<Item, Error> {
    let (file, journal) = (format!("{}.item", entry.name), results.journal());
    if journal.is_marked(entry.name) {
        let kept = results.read(&file).and_then(|text| serde_json::from_str(&text).ok());
        if let Some(item) = kept {
            return Ok(item);
        }
    }
    let before = searches.results.len();
    let item = (entry.make)(plan, &mut |study| Ok(searches.tune(study, SEARCHES)?.damper.design))?;
    if searches.results.len() > before {
        return Ok(item);
    }
    results.write_json(&file, &item)?;
    journal.mark(entry.name);
    journal.check()?;
    Ok(item)
}

fn write(entry: &Entry, item: &Item, results: &Directory) -> Result<(), Error> {
    for picture in &item.pictures {
        results.write(&picture.file, &picture.drawing.wide)?;
    }
    for (name, text) in item.files(entry.name) {
        results.write(&name, &text)?;
    }
    Ok(results.write_json(&statements(entry.name), &item.statements)?)
}

/// The verdicts of an item, for the screen.
fn report(entry: &Entry, item: &Item) -> String {
    let lines = item.statements.iter().map(|one| {
        let ours = if one.conjecture { "our conjecture: " } else { "" };
        format!("\n  {:<14} {ours}{} ({})", one.verdict.words(), one.paper, one.found)
    });
    format!("{}{}", entry.title, lines.collect::<String>())
}

/// Recomputes the statements of an item with its tables and data, from the designs that its searches found.
fn recompute(place: &Path, name: &str) -> Result<Recomputed, Error> {
    let stored = json(place, name)?;
    let Some(entry) = ENTRIES.iter().find(|entry| statements(entry.name) == name) else {
        return Ok(Recomputed::Failed("is of no item of the page".to_owned()));
    };
    let resolved = Resolved::read(place)?;
    let file = serde_json::from_value::<PaperPlan>(resolved.plan.clone());
    let studies = resolved.studies()?.into_iter().map(|(_, study)| study).collect::<Vec<Study>>();
    let (Ok(file), Ok([ssvi, tmd])) = (file, <[Study; 2]>::try_from(studies)) else {
        return Err(broken(place, SEVERAL, "it is no plan of the paper with its two dampers"));
    };
    let plan = Plan { file, ssvi, tmd, watch: &Silent, is_brief: false };
    let item = (entry.make)(&plan, &mut |study| {
        let place = place.join(SEARCHES).join(study.name());
        design(&json(&place, OPTIMUM)?)
            .ok_or_else(|| broken(&place, OPTIMUM, "it holds no design of a damper"))
    });
    let item = match item {
        Ok(item) => item,
        Err(error) => return Ok(Recomputed::Failed(format!("cannot be made again: {error}"))),
    };
    let (mut files, mut made) = (Map::new(), Map::new());
    for (name, content) in item.files(entry.name) {
        files.insert(name.clone(), text(place, &name).map_or(Value::Null, Value::from));
        made.insert(name, content.into());
    }
    Ok(Recomputed::Part {
        what: "with its tables and data",
        stored: serde_json::json!({ "statements": stored, "files": files }),
        recomputed: serde_json::json!({ "statements": item.statements, "files": made }),
    })
}

/// Checks a study file of any kind, and describes it: the request in words, and the jobs that can be run on it.
///
/// # Errors The file, or one that it names, is wrong.
pub fn describe(path: &Path) -> Result<Described, Error> {
    let kind = study::kind_of(path)?;
    let (words, jobs) = match kind {
        study::Kind::Table2 => {
            (words::table2(&study::read_table2(path)?), vec![&rows::KIND, &retention::KIND])
        }
        study::Kind::Fronts => (words::fronts(&study::read_fronts(path)?), vec![&fronts::KIND]),
        study::Kind::Paper => {
            Plan::read(path, &Silent)?;
            ("every table and figure of the paper".to_owned(), vec![&KIND])
        }
        study::Kind::Study => {
            let study = study::read(path)?;
            let jobs = if study.optimize.is_some() { vec![&tune::KIND] } else { Vec::new() };
            (words::study(&study), jobs)
        }
    };
    Ok(Described { kind, words, jobs })
}

/// The description of a study file.
#[derive(Debug)]
pub struct Described {
    /// Its kind.
    pub kind: study::Kind,
    /// The request in words.
    pub words: String,
    /// The jobs that can be run on it.
    pub jobs: Vec<&'static Kind>,
}

impl Described {
    /// The description as JSON.
    pub fn json(&self, path: &Path) -> Value {
        let lines: Vec<&str> = self.words.lines().map(str::trim).collect();
        let files = |job: &&Kind| job.files().map(|(name, _)| name).collect::<Vec<_>>();
        let jobs: Map<String, Value> =
            self.jobs.iter().map(|job| (job.command.to_owned(), files(job).into())).collect();
        serde_json::json!({ "file": path.display().to_string(), "kind": self.kind.name(), "words": lines, "files": jobs })
    }
}
