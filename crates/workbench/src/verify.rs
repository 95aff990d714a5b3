//! `verify`: whether results are those that their study gives. Every file is compared with the manifest, a sample of the rows is run
//! again and compared to the last bit, certificates are made again. What cannot be checked is no evidence, and is said.

mod files;
mod search;
mod several;
mod table;
mod values;

use crate::resolved;
use crate::tune::shard::PARTS;
use crate::{Error, Observer};
use rayon::prelude::*;
use retune_store::{UNFINISHED, manifest};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A number of a result, and what gives it again.
struct Check<'a> {
    said: f64,
    again: Box<dyn Fn() -> f64 + Sync + 'a>,
}

impl Check<'_> {
    /// That of a row which no command writes.
    fn never() -> Self {
        Self { said: f64::NAN, again: Box::new(|| 0.0) }
    }
}

/// What became of the numbers of a file.
#[derive(Default)]
struct Tally {
    differ: usize,
    /// The largest relative difference.
    most: f64,
}

/// Says what holds, and keeps what does not and what cannot be checked.
struct Report<'a> {
    watch: &'a dyn Observer,
    /// The largest relative difference that counts as held.
    within: f64,
    /// What stands before a file in a message: the directory, where there are several.
    place: String,
    problems: Vec<String>,
    unchecked: Vec<String>,
}

/// Looks at a directory of results, and at those in it, and says of each file whether it holds. Of each table `sample` rows are run
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
    let mut report =
        Report { watch, within, place: String::new(), problems: Vec::new(), unchecked: Vec::new() };
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

/// Looks at the results in one directory.
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
        // What is damaged is one more thing that does not hold.
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
    // The shares of a grid are what a merge begins with, and no results.
    inner.retain(|path| path.is_dir() && !path.ends_with(UNFINISHED) && !path.ends_with(PARTS));
    inner.sort();
    inner.iter().try_for_each(|path| collect(path, places))
}

fn text(place: &Path, name: &str) -> Result<String, Error> {
    let path = place.join(name);
    Ok(std::fs::read_to_string(&path).map_err(|source| retune_store::Error::Input { path, source })?)
}

fn json(place: &Path, name: &str) -> Result<Value, Error> {
    let refuse = |error: serde_json::Error| retune_store::Error::Input {
        path: place.join(name),
        source: error.into(),
    };
    Ok(serde_json::from_str(&text(place, name)?).map_err(refuse)?)
}

impl Report<'_> {
    /// Says what does not hold; `name` is the file, or empty.
    fn fail(&mut self, name: &str, words: &str) -> Result<(), Error> {
        let between = if name.is_empty() { "" } else { ", " };
        self.problems.push(format!("{}{name}{between}{words}", self.place));
        let line = if name.is_empty() { format!("  {words}") } else { format!("  {name:<22} {words}") };
        self.watch.result(&line)
    }

    /// Says what cannot be checked.
    fn unchecked(&mut self, words: &str) -> Result<(), Error> {
        self.unchecked.push(format!("{}{words}", self.place));
        self.watch.result(&format!("  cannot be checked: {words}"))
    }

    /// Makes all `checks` of a file, of which they are `what`.
    fn look(&mut self, name: &str, what: &str, checks: &[Check]) -> Result<(), Error> {
        self.tell(name, &format!("{what} run again"), &run(checks))
    }

    /// Compares a JSON file, or a part of it, with what is made again.
    fn compare(&mut self, name: &str, what: &str, said: &Value, again: &Value) -> Result<(), Error> {
        let tally = values::compare(said, again, self.within);
        self.tell(name, &format!("{what} made again"), &tally)
    }

    fn tell(&mut self, name: &str, what: &str, tally: &Tally) -> Result<(), Error> {
        let most = if tally.most.is_finite() {
            format!(
                "by at most {:.1e} of {} value",
                tally.most,
                if tally.differ == 1 { "its" } else { "their" }
            )
        } else {
            "and not only in digits".to_owned()
        };
        let words = match tally.differ {
            0 => "the same to the last bit".to_owned(),
            1 => format!("1 differs, {most}"),
            differ => format!("{differ} differ, {most}"),
        };
        if tally.most > self.within {
            self.problems.push(format!("{}{name}, {words}", self.place));
        }
        self.watch.result(&format!("  {name:<22} {what}: {words}"))
    }

    /// The last word.
    fn end(self, path: &Path) -> Result<(), Error> {
        let Self { watch, within, problems, unchecked, .. } = self;
        let unchecked = unchecked.join("; ");
        if problems.is_empty() && unchecked.is_empty() {
            let agrees = if within > 0.0 { format!("agrees within {within:e}") } else { "agrees".to_owned() };
            return watch.result(&format!(
                "holds: every file is as it was made, and all that was run or made again {agrees}"
            ));
        }
        if problems.is_empty() {
            return Err(Error::NotChecked { path: path.to_owned(), problem: unchecked });
        }
        let and = if unchecked.is_empty() { "" } else { "; cannot be checked: " };
        let problem = format!("does not hold: {}{and}{unchecked}", problems.join("; "));
        Err(Error::NotHeld { path: path.to_owned(), problem })
    }
}

/// Runs all again.
fn run(checks: &[Check]) -> Tally {
    let found: Vec<f64> = checks.par_iter().map(|check| (check.again)()).collect();
    let mut tally = Tally::default();
    for (check, found) in checks.iter().zip(found) {
        tally.see(check.said, found);
    }
    tally
}

impl Tally {
    /// Compares two numbers; two that are not finite are the same: no value.
    fn see(&mut self, said: f64, found: f64) {
        let none = |value: f64| !value.is_finite();
        if said.to_bits() != found.to_bits() && !(none(said) && none(found)) {
            let difference = (said - found).abs() / said.abs().max(found.abs());
            self.differs(if difference.is_finite() { difference } else { f64::INFINITY });
        }
    }

    fn differs(&mut self, by: f64) {
        self.differ += 1;
        self.most = self.most.max(by);
    }
}
