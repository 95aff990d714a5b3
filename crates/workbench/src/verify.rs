//! `verify`: results are compared with those that their study gives. Every file is compared with the manifest, a sample of the rows
//! is run again and compared to the last bit, certificates are made again. Parts that cannot be checked are reported.

mod files;
mod input;
mod report;
mod search;
mod several;
mod table;
mod tally;
mod values;

use crate::resolved;
use crate::tune::shard::PARTS;
use crate::{Error, Observer};
use report::Report;
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
        look(place, sample, &mut report)?;
    }
    report.end(path)
}

/// Checks the results in one directory.
fn look(place: &Path, sample: usize, report: &mut Report<'_>) -> Result<(), Error> {
    files::verify(place, report)?;
    let has = |name: &str| place.join(name).exists();
    let done = if has(resolved::NAME) {
        several::verify(place, sample, report)
    } else if has("study.json") {
        search::verify(place, sample, report)
    } else {
        report.unchecked("no row of these results can be run again by itself")
    };
    match done {
        // Damaged files do not hold either.
        Err(
            error @ (Error::Store(retune_store::Error::Input { .. })
            | Error::Study(_)
            | Error::Rule { .. }
            | Error::Setting(_)),
        ) => report.fail("", &error.to_string()),
        other => other,
    }
}

fn is_result(place: &Path) -> bool {
    [manifest::NAME, "study.json"].iter().any(|name| place.join(name).exists())
}

/// A directory, if there are files in it, and those below with files, sorted.
fn collect(path: &Path, places: &mut Vec<PathBuf>) -> std::io::Result<()> {
    let mut inner = Vec::new();
    for entry in std::fs::read_dir(path)? {
        inner.push(entry?.path());
    }
    if inner.iter().any(|path| path.is_file() && !files::is_hidden(path)) {
        places.push(path.to_owned());
    }
    // The shares of a grid are the input of a merge, not results.
    inner.retain(|path| path.is_dir() && !path.ends_with(UNFINISHED) && !path.ends_with(PARTS));
    inner.sort();
    inner.iter().try_for_each(|path| collect(path, places))
}
