//! `verify`: results are compared with those that their study gives. Every file is compared with the manifest; by the lists of the jobs
//! a sample of the rows is run again and compared to the last bit, certificates are made again. Parts that cannot be checked are
//! reported.

mod files;
mod report;
mod rows;
mod tally;
mod values;

use crate::again::Made;
use crate::artefact::{Content, Kind};
use crate::parts::PARTS;
use crate::{
    Error, Observer, branches, certify, design, fronts, losses, methods, paper, resolved, retention, sweep,
    table2, tune,
};
use report::Report;
use retune_store::manifest::Manifest;
use retune_store::{UNFINISHED, manifest};
use std::path::{Path, PathBuf};

/// Checks a directory of results, and those in it, and reports of each file whether it holds. Of each table `sample` rows are run
/// again; numbers that differ by at most `within` of their size hold.
///
/// # Errors
/// There are no results, they do not hold, or something cannot be checked.
pub fn verify(path: &Path, sample: usize, within: f64, watch: &dyn Observer) -> Result<(), Error> {
    let refuse = |source| retune_store::Error::Input { path: path.to_owned(), source };
    let mut places = Vec::new();
    collect(path, &mut places).map_err(refuse)?;
    if !places.iter().any(|place| is_result(place)) {
        let words = "there is no manifest.json and no study.json in it: these are no results";
        return Err(refuse(std::io::Error::other(words)).into());
    }
    let mut report = Report::new(watch, within);
    for place in &places {
        if places.len() > 1 {
            report.watch.result(&format!("{}:", place.display()))?;
            let below = place.strip_prefix(path).unwrap_or(place);
            report.place =
                if below.as_os_str().is_empty() { String::new() } else { format!("{}/", below.display()) };
        }
        check(place, sample, &mut report)?;
    }
    report.end(path)
}

static KINDS: [&Kind; 10] = [
    &tune::KIND,
    &certify::KIND,
    &table2::KIND,
    &losses::KIND,
    &sweep::KIND,
    &retention::KIND,
    &fronts::KIND,
    &branches::KIND,
    &paper::KIND,
    &design::KIND,
];
/// Those of the comparison of methods, whose files have names that say little: only where their manifest names them.
static COMPARISONS: [&Kind; 2] = [&methods::ACCURACY, &methods::STABILITY];

/// Checks the results in one directory: each file against the manifest, then the contents of each against a computation.
fn check(place: &Path, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let there = files::verify(place, report)?;
    let known = known(place, &there);
    let is_input = |content: &Content| matches!(content, Content::Input);
    if !known.iter().any(|(_, content)| is_input(content))
        || known.iter().all(|(_, content)| is_input(content) || matches!(content, Content::Derived))
    {
        return report.unchecked("no row of these results can be run again by itself");
    }
    for &(name, content) in &known {
        let done = match content {
            Content::Input | Content::Derived => Ok(()),
            Content::Rows(source) => source(place, name)
                .and_then(|source| rows::check(&place.join(name), name, &source, most, report)),
            Content::Whole(made) => made(place, name).and_then(|made| match made {
                Made::Of { what, said, again } => report.compare(name, what, &said, &again),
                Made::Not(why) => report.fail(name, &why),
            }),
        };
        match done {
            // Damaged files do not hold either.
            Err(
                error @ (Error::Store(retune_store::Error::Input { .. })
                | Error::Study(_)
                | Error::Rule { .. }
                | Error::Setting(_)),
            ) => report.fail("", &error.to_string())?,
            other => other?,
        }
    }
    let is_found = known.iter().any(|(name, _)| *name == tune::OPTIMUM);
    if known.iter().any(|(name, _)| tune::files::SEARCHED.contains(name)) && !is_found {
        return report.unchecked("there is no optimum.json: the design that was found");
    }
    Ok(())
}

/// The files of a directory that a job makes, in the order of its list.
fn known<'a>(place: &Path, there: &'a [String]) -> Vec<(&'a str, Content)> {
    let mut known: Vec<(&str, Content)> = Vec::new();
    let command = Manifest::read(place).ok().flatten().map(|manifest| manifest.made_by.command);
    let compared = COMPARISONS.iter().filter(|kind| command.as_deref() == Some(kind.command));
    for artefact in compared.chain(&KINDS).flat_map(|kind| kind.artefacts) {
        for name in there.iter().filter(|name| artefact.is(name)) {
            if known.iter().all(|(other, _)| other != name) {
                known.push((name, artefact.content));
            }
        }
    }
    known
}

fn is_result(place: &Path) -> bool {
    [manifest::NAME, resolved::ONE].iter().any(|name| place.join(name).exists())
}

/// A directory, if there are files in it, and those below with files, sorted. No link is followed.
fn collect(path: &Path, places: &mut Vec<PathBuf>) -> std::io::Result<()> {
    let mut inner = Vec::new();
    for entry in std::fs::read_dir(path)? {
        let entry = entry?;
        inner.push((entry.path(), entry.file_type()?.is_dir()));
    }
    if inner.iter().any(|(path, is_directory)| !is_directory && !files::is_hidden(path)) {
        places.push(path.to_owned());
    }
    // The shares of a grid are the input of a merge, not results.
    inner.retain(|(path, is_directory)| {
        *is_directory && !path.ends_with(UNFINISHED) && !path.ends_with(PARTS)
    });
    inner.sort();
    inner.iter().try_for_each(|(path, _)| collect(path, places))
}
