//! `verify`: results are compared with those that their study gives. Every file is compared with the manifest; by the lists of the jobs
//! a sample of the rows is run again and compared to the last bit, certificates are made again. Parts that cannot be checked are
//! reported.

mod files;
pub mod input;
pub mod methods;
pub mod one;
pub mod report;
mod several;
mod swept;
pub mod table;
mod tally;
mod values;

use crate::artefact::{Content, Kind};
use crate::parts::PARTS;
use crate::{Error, Observer, branches, certify, fronts, paper, resolved, retention, sweep, table2, tune};
use one::One;
pub use report::{Check, Report};
use retune_store::manifest::Manifest;
use retune_store::{UNFINISHED, manifest};
use several::Several;
use std::path::{Path, PathBuf};

/// Computes a file of a job's own contents again and compares it with what it says: in a directory of results, the name of the file,
/// the most rows to run again, and the report.
pub type Again = fn(&Path, &str, usize, &mut Report<'_>) -> Result<(), Error>;

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
        look(place, sample, &mut report)?;
    }
    report.end(path)
}

/// The kinds of jobs, and how files that only the job itself knows are computed again.
static KINDS: [(&Kind, Option<Again>); 8] = [
    (&tune::KIND, None),
    (&certify::KIND, None),
    (&table2::KIND, None),
    (&sweep::KIND, None),
    (&retention::KIND, Some(retention::again)),
    (&fronts::KIND, Some(fronts::again)),
    (&branches::KIND, Some(branches::again)),
    (&paper::KIND, Some(paper::again)),
];
/// Those of the comparison of methods, whose files have names that say little: only where their manifest names them.
static COMPARISONS: [&Kind; 2] = [&methods::ACCURACY, &methods::STABILITY];

/// Checks the results in one directory: each file against the manifest, then the contents of each against a computation.
fn look(place: &Path, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let there = files::verify(place, report)?;
    let known = known(place, &there);
    let plain = |content| matches!(content, Content::Input | Content::Derived);
    if !has(&known, Content::Input) || known.iter().all(|(_, content, _)| plain(*content)) {
        return report.unchecked("no row of these results can be run again by itself");
    }
    for &(name, content, again) in &known {
        let done = match content {
            Content::Input | Content::Derived => Ok(()),
            Content::Grid => One::read(place).and_then(|one| one.grid(name, most, report)),
            Content::Searched => One::read(place).and_then(|one| one.searched(name, most, report)),
            Content::Band => One::read(place).and_then(|one| one.band(name, most, report)),
            Content::Optimum => One::read(place).and_then(|one| one.optimum(name, report)),
            Content::Certificate => One::read(place).and_then(|one| one.certificate(name, report)),
            Content::Designs => Several::read(place).and_then(|all| all.designs(name, most, report)),
            Content::Methods => methods::methods(place, name, most, report),
            Content::Swept => swept::swept(place, name, most, report),
            Content::Own => again.map_or(Ok(()), |again| again(place, name, most, report)),
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
    if known.iter().any(|(_, content, _)| content.is_of_a_search()) && !has(&known, Content::Optimum) {
        return report.unchecked("there is no optimum.json: the design that was found");
    }
    Ok(())
}

/// A file of results: its name, its contents, and how its own are computed again.
type Known<'a> = (&'a str, Content, Option<Again>);

/// The files of a directory that a job makes, in the order of its list.
fn known<'a>(place: &Path, there: &'a [String]) -> Vec<Known<'a>> {
    let mut known: Vec<Known> = Vec::new();
    let command =
        Manifest::read(place).ok().flatten().and_then(|manifest| manifest.made_by).map(|made| made.command);
    let compared = COMPARISONS.iter().filter(|kind| command.as_deref() == Some(kind.command));
    for (kind, again) in compared.map(|kind| (*kind, None)).chain(KINDS) {
        for artefact in kind.artefacts {
            for name in there.iter().filter(|name| artefact.is(name)) {
                if known.iter().all(|(other, ..)| other != name) {
                    known.push((name, artefact.content, again));
                }
            }
        }
    }
    known
}

fn has(known: &[Known], content: Content) -> bool {
    known.iter().any(|(_, other, _)| *other == content)
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
