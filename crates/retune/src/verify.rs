//! `verify`: whether results are those that their study gives. A sample of the rows is run again and compared to the last bit.

mod search;
mod several;
mod table;

use crate::cli;
use crate::error::Error;
use crate::results::identity::{VERSION, sha256};
use crate::results::manifest::{self, Manifest};
use crate::results::{UNFINISHED, resolved};
use crate::screen::Screen;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// A number of a result, and what gives it again.
struct Check<'a> {
    said: f64,
    again: Box<dyn Fn() -> f64 + Sync + 'a>,
}

/// What became of the numbers of a file.
#[derive(Default)]
struct Tally {
    differ: usize,
    /// The largest relative difference.
    most: f64,
}

/// Says what holds, and keeps what does not.
struct Report {
    screen: Screen,
    /// The largest relative difference that counts as held.
    within: f64,
    problems: Vec<String>,
}

/// Runs rows of a directory of results, and of those in it, again, and says of each file whether they hold.
///
/// # Errors
/// The results cannot be read, or do not hold.
pub fn command(arguments: &cli::Verify) -> Result<(), Error> {
    let path = &arguments.results;
    let refuse = |source| Error::Input { path: path.clone(), source };
    let mut places = Vec::new();
    collect(path, &mut places).map_err(refuse)?;
    if places.is_empty() {
        let words = "there is no manifest.json and no study.json in it: these are no results";
        return Err(refuse(std::io::Error::other(words)));
    }
    let mut report = Report { screen: Screen::new(false), within: arguments.within, problems: Vec::new() };
    for place in &places {
        if places.len() > 1 {
            report.screen.line(format!("{}:", place.display()))?;
        }
        files(place, &mut report)?;
        let has = |name: &str| place.join(name).exists();
        let sample = arguments.sample as usize;
        if has("optimum.json") {
            search::verify(place, sample, &mut report)?;
        } else if has("certificate.json") {
            search::certificate(place, &mut report)?;
        } else if has(resolved::NAME) {
            several::verify(place, sample, &mut report)?;
        } else {
            report.screen.line("  no row of these results can be run again by itself")?;
        }
    }
    if report.problems.is_empty() {
        return report.screen.line("all that was looked at holds");
    }
    let problem = format!("does not hold: {}", report.problems.join("; "));
    Err(Error::NotHeld { path: path.clone(), problem })
}

/// A directory, if there are results in it, and those below with results, sorted.
fn collect(path: &Path, places: &mut Vec<PathBuf>) -> std::io::Result<()> {
    if path.join(manifest::NAME).exists() || path.join("study.json").exists() {
        places.push(path.to_owned());
    }
    let mut inner = Vec::new();
    for entry in std::fs::read_dir(path)? {
        inner.push(entry?.path());
    }
    inner.retain(|path| path.is_dir() && !path.ends_with(UNFINISHED));
    inner.sort();
    inner.iter().try_for_each(|path| collect(path, places))
}

/// Compares the files with the manifest.
fn files(place: &Path, report: &mut Report) -> Result<(), Error> {
    let path = place.join(manifest::NAME);
    if !path.exists() {
        return report.screen.line("  no manifest.json: what made these results is not written down");
    }
    let refuse = |error: serde_json::Error| Error::Input { path: path.clone(), source: error.into() };
    let manifest: Manifest = serde_json::from_str(&text(place, manifest::NAME)?).map_err(refuse)?;
    let mut problems = Vec::new();
    for (name, expected) in &manifest.files {
        match manifest::file_sha256(&place.join(name)) {
            Ok(found) if found == *expected => {}
            Ok(_) => problems.push(format!("{name} is not as it was made")),
            Err(_) => problems.push(format!("{name} is missing")),
        }
    }
    let input = [resolved::NAME, "study.json"].into_iter().find(|name| place.join(name).exists());
    match input {
        Some(input) if sha256(text(place, input)?.as_bytes()) != manifest.study_sha256 => {
            problems.push(format!("{input} is not the study that made these results"));
        }
        _ => {}
    }
    let words = if problems.is_empty() { "as they were made".to_owned() } else { problems.join("; ") };
    report.screen.line(format!("  {} files {words}", manifest.files.len()))?;
    if manifest.retune != VERSION {
        report.screen.line(format!("  note: made by Retune {}, this is {VERSION}", manifest.retune))?;
    }
    report.problems.extend(problems);
    Ok(())
}

fn text(place: &Path, name: &str) -> Result<String, Error> {
    let path = place.join(name);
    std::fs::read_to_string(&path).map_err(|source| Error::Input { path, source })
}

impl Report {
    /// Says what does not hold.
    fn fail(&mut self, name: &str, words: &str) -> Result<(), Error> {
        self.problems.push(format!("{name}, {words}"));
        self.screen.line(format!("  {name:<22} {words}"))
    }

    /// Makes all `checks` of a file, of which they are `what`.
    fn look(&mut self, name: &str, what: &str, checks: &[Check]) -> Result<(), Error> {
        let tally = run(checks);
        let words = match tally.differ {
            0 => "the same to the last bit".to_owned(),
            differ => format!("{differ} differ, by at most {:.1e} of their value", tally.most),
        };
        if tally.most > self.within {
            self.problems.push(format!("{name}, {words}"));
        }
        self.screen.line(format!("  {name:<22} {what} run again: {words}"))
    }
}

/// Runs all again.
fn run(checks: &[Check]) -> Tally {
    let found: Vec<f64> = checks.par_iter().map(|check| (check.again)()).collect();
    let mut tally = Tally::default();
    for (check, found) in checks.iter().zip(found) {
        let none = |value: f64| !value.is_finite();
        if check.said.to_bits() != found.to_bits() && !(none(check.said) && none(found)) {
            tally.differ += 1;
            let difference = (check.said - found).abs() / check.said.abs().max(found.abs());
            tally.most = tally.most.max(if difference.is_finite() { difference } else { f64::INFINITY });
        }
    }
    tally
}
