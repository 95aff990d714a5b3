//! Exports a place as a study, a command line, Python code, a table or a figure. The page offers them as files; nothing is written here.

use crate::protocol::{Answer, Place, What, Write};
use crate::refused::Refused;
use crate::response::Stale;
use crate::start::Start;
use crate::{report, sheets};
use retune_jobs::answer;
use retune_jobs::simulate::{simulate, write_rows};
use retune_report::svg;
use retune_study::{Settable, Study};

/// Time between two rows of a motion, s, as `retune simulate --trajectory` has it.
const INTERVAL: f64 = 0.005;
/// Most rows of a motion.
const MOST_ROWS: f64 = 200_000.0;

/// Exports a place in a form. The response and the report also contain the pinned designs.
///
/// # Errors
/// A study file could not have these numbers, the run fails, or the work has become stale.
pub fn written(
    start: &Start,
    Write { place, what, pins, quantity }: &Write,
    is_stale: &(dyn Fn() -> bool + Sync),
) -> Result<Answer, Refused> {
    let name = start.study().name();
    let gone = |Stale| Refused::whole("the page has gone");
    let pinned = || -> Result<[Option<Study>; 2], Refused> {
        let [a, b] = pins.each_ref().map(|pin| pin.as_ref().map(|place| start.at(place)).transpose());
        Ok([a?, b?])
    };
    let (file, text) = match what {
        What::Study => (saved(name), study(&start.file_at(place)?)?),
        What::Command => (String::new(), command(start, place)?),
        What::Python => (String::new(), python(start, place)?),
        What::Motion => (format!("{name}-motion.csv"), motion(&start.at(place)?)?),
        What::Picture => (format!("{name}-motion.svg"), svg(&sheets::motion(&start.at(place)?)?)),
        What::Response => {
            let study = start.at(place)?;
            let quantity = quantity.unwrap_or_else(|| study.quantity());
            let text = sheets::response(&study, &pinned()?, quantity, is_stale).map_err(gone)?;
            (format!("{name}-response.svg"), svg(&text))
        }
        What::Json => {
            // The file allows more steps than a page: first check that the run ends within a page's limit.
            simulate(&start.at(place)?, None).map_err(Refused::whole)?;
            let run = simulate(&start.file_at(place)?, None).map_err(Refused::whole)?;
            (format!("{name}-run.json"), answer::text(&run).map_err(Refused::whole)? + "\n")
        }
        What::Report => {
            let file = study(&start.file_at(place)?)?;
            let said = report::Said { command: command(start, place)?, file, quantity: *quantity };
            (format!("{name}-explored.html"), report::html(&start.at(place)?, &pinned()?, &said, is_stale)?)
        }
    };
    Ok(Answer::new("written").with("what", what).with("file", file).with("text", text))
}

/// The name of the file that a study is saved as.
fn saved(name: &str) -> String {
    format!("{name}-explored.json")
}

/// The text of a study file without a name, which then follows from its file name.
fn study(study: &Study) -> Result<String, Refused> {
    let study = Study { name: None, ..study.resolved() };
    serde_json::to_string_pretty(&study).map(|text| text + "\n").map_err(Refused::whole)
}

/// The file for a command, the numbers that differ from it, and a note. If no file has this damper, it is the one that the page saves.
struct Named {
    file: String,
    set: Vec<String>,
    note: &'static str,
}

fn named(start: &Start, place: &Place) -> Result<Named, Refused> {
    start.file_at(place)?;
    let differs = |(name, value): &(&String, &f64)| {
        name.parse().ok().and_then(|what: Settable| start.study().value_of(what)) != Some(**value)
    };
    match &start.file {
        Some(file) if start.damper_kind() == place.damper => {
            let set = place.set.iter().filter(differs).map(|(name, value)| format!("{name}={value}"));
            Ok(Named { file: file.clone(), set: set.collect(), note: "" })
        }
        _ => {
            let note = "  # the study, saved from this page";
            Ok(Named { file: saved(start.study().name()), set: Vec::new(), note })
        }
    }
}

fn command(start: &Start, place: &Place) -> Result<String, Refused> {
    let Named { file, set, note } = named(start, place)?;
    let set: String = set.iter().map(|set| format!(" --set {set}")).collect();
    Ok(format!("retune simulate {}{set}{note}", quoted(&file)))
}

fn python(start: &Start, place: &Place) -> Result<String, Refused> {
    let Named { file, set, note } = named(start, place)?;
    let at = if set.is_empty() { String::new() } else { format!(".at({})", set.join(", ")) };
    let file = serde_json::to_string(&file).map_err(Refused::whole)?;
    Ok(format!(
        "import retune as rt\n\nproblem = rt.Problem.from_study({file}){at}{note}\nrun = problem.simulate()\nprint(run.maxima)"
    ))
}

/// A word for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

fn motion(study: &Study) -> Result<String, Refused> {
    let window = study.window.window();
    let rows = (window.to - window.from) / INTERVAL;
    if rows > MOST_ROWS {
        let problem =
            format!("{rows:.0} rows are too many for this page: `retune simulate --trajectory` writes them");
        return Err(Refused::of("T", problem));
    }
    let mut text = String::new();
    write_rows(study, INTERVAL, &mut |row| {
        text.push_str(row);
        Ok(())
    })
    .map_err(Refused::whole)?;
    Ok(text)
}
