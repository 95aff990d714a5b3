//! `just lab accuracy`: every method on every scene at every tolerance, into `results/accuracy/`. `just lab accuracy draw` rewrites text,
//! charts and manifest from its tables; `just lab accuracy check` reruns every row and compares everything but its time.
#![allow(clippy::print_stderr)]

use rayon::prelude::*;
use retune_jobs::methods;
use retune_lab::curves::{Cost, Measure, work_precision};
use retune_lab::reference::{REFERENCE, Reference};
use retune_lab::runs::{self, Row, csv, external, of_table, parse};
use retune_lab::scenes::{Case, cases, in_json};
use retune_lab::{Any, comparison, machine, savings, sealed, statistics, text};
use std::fs;
use std::path::Path;

const SCENES: &str = "tests/reference/external/scenes.json";

fn main() -> Any<()> {
    let folder = Path::new("results/accuracy");
    let cases = cases();
    let references = cases.iter().map(Reference::of).collect::<Result<Vec<_>, _>>()?;
    match std::env::args().nth(1).as_deref() {
        None => measure(folder, &cases, &references)?,
        Some("draw") => {}
        Some("check") => return check(folder, &cases, &references),
        Some(other) => return Err(format!("accuracy {other}: nothing, draw or check").into()),
    }
    draw(folder, &cases, &references)
}

/// Writes the tables.
fn measure(folder: &Path, cases: &[Case], references: &[Reference]) -> Any<()> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join(machine::NAME), format!("{:#}\n", machine::this()))?;
    fs::write(SCENES, in_json(cases.iter())?)?;
    let cvode = runs::cvode(SCENES).unwrap_or_else(|| {
        eprintln!("CVODE is left out: it is not built");
        String::new()
    });
    let interpreted = external()?;
    let mut rows = Vec::new();
    for (case, reference) in cases.iter().zip(references) {
        eprintln!("{}", case.name);
        rows.extend(comparison::rows(case, &reference.found));
        rows.extend(
            [&cvode, &interpreted].into_iter().flat_map(|table| of_table(table, case, &reference.found)),
        );
    }
    fs::write(folder.join("runs.csv"), csv(&rows))?;
    Ok(fs::write(folder.join("models.csv"), savings::csv(&savings::savings(cases)?))?)
}

/// The rows of the table.
fn rows(folder: &Path, cases: &[Case]) -> Any<Vec<Row>> {
    let names: Vec<&'static str> = cases.iter().map(|case| case.name).collect();
    Ok(parse(&fs::read_to_string(folder.join("runs.csv"))?, &names))
}

/// Writes text, charts and manifest from the tables.
fn draw(folder: &Path, cases: &[Case], references: &[Reference]) -> Any<()> {
    let (rows, savings) =
        (rows(folder, cases)?, savings::parse(&fs::read_to_string(folder.join("models.csv"))?));
    let text =
        text::text(&machine::words_of(folder)?, cases, references, &rows, &savings, &statistics::all()?);
    fs::write(folder.join("README.md"), text)?;
    let scenes: Vec<(&Case, &Reference)> = cases.iter().zip(references).collect();
    for (name, measure, cost) in [
        ("time", Measure::E1max, Cost::Time),
        ("evaluations", Measure::E1max, Cost::Evaluations),
        ("state", Measure::State, Cost::Time),
    ] {
        work_precision(&folder.join(format!("{name}.svg")), &scenes, &rows, measure, cost)?;
    }
    savings::chart(&folder.join("models.svg"), &savings)?;
    let plan = methods::plan(REFERENCE, runs::MOST_STEPS, std::iter::empty());
    sealed::seal(folder, &methods::ACCURACY, plan, cases.iter())
}

/// Reruns every row and prints those whose errors, counts or evaluations differ.
fn check(folder: &Path, cases: &[Case], references: &[Reference]) -> Any<()> {
    let rows = rows(folder, cases)?;
    let changed = |row: &Row| {
        let (case, reference) = cases.iter().zip(references).find(|(case, _)| case.name == row.scene)?;
        comparison::change(row, case, &reference.found)
    };
    let changes: Vec<String> = rows.par_iter().filter_map(changed).collect();
    changes.iter().for_each(|change| eprintln!("{change}"));
    eprintln!("{} rows, {} changed", rows.len(), changes.len());
    if changes.is_empty() {
        Ok(())
    } else {
        Err("results/accuracy/runs.csv is not what the code makes".into())
    }
}
