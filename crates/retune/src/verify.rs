//! `verify`: whether results are those that their study gives. A sample of the rows is run again and compared to the last bit.

use crate::cli;
use crate::error::Error;
use crate::optimize::manifest::{self, Manifest};
use crate::optimize::{band, objective};
use crate::results::identity::{VERSION, sha256};
use crate::screen::Screen;
use crate::study::{self, Study};
use rayon::prelude::*;
use retune_model::{NonNegative, Scene};
use retune_optim::{PeakEnergy, Variable};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A number of a result, and the run that gives it.
struct Check {
    said: f64,
    scene: Scene,
    /// Whether the number is that of the objective, over its band if it has one, or of the scene's own ω.
    whole: bool,
}

/// What became of the numbers of a file.
#[derive(Default)]
struct Tally {
    differ: usize,
    /// The largest relative difference.
    most: f64,
}

/// Runs rows of a directory of results again, and says of each file whether they hold. Of a directory without a study, those
/// in it are looked at.
///
/// # Errors
/// The results cannot be read, or do not hold.
pub fn command(arguments: &cli::Verify) -> Result<(), Error> {
    let screen = Screen::new(false);
    let path = &arguments.results;
    let refuse = |source| Error::Input { path: path.clone(), source };
    let mut places = vec![path.clone()];
    if !path.join("study.json").exists() {
        places.clear();
        collect(path, &mut places).map_err(refuse)?;
    }
    if places.is_empty() {
        return Err(refuse(std::io::Error::other("there is no study.json in it: these are no results")));
    }
    let mut problems = Vec::new();
    for place in &places {
        if places.len() > 1 {
            screen.line(format!("{}:", place.display()))?;
        }
        problems.extend(verify(place, arguments, screen)?);
    }
    if problems.is_empty() {
        return screen.line("all that was looked at holds");
    }
    Err(Error::NotHeld { path: path.clone(), problem: format!("does not hold: {}", problems.join("; ")) })
}

/// The directories below with results of a study, sorted.
fn collect(path: &Path, places: &mut Vec<PathBuf>) -> std::io::Result<()> {
    let mut inner = Vec::new();
    for entry in std::fs::read_dir(path)? {
        inner.push(entry?.path());
    }
    inner.sort();
    for path in inner.into_iter().filter(|path| path.is_dir()) {
        if path.join("study.json").exists() {
            places.push(path);
        } else {
            collect(&path, places)?;
        }
    }
    Ok(())
}

/// Looks at one directory; returns what does not hold.
fn verify(place: &Path, arguments: &cli::Verify, screen: Screen) -> Result<Vec<String>, Error> {
    let mut problems = files(place, screen)?;
    if !place.join("optimum.json").exists() {
        screen.line("  no search stands here, so no row can be run again one by one")?;
        return Ok(problems);
    }
    let study = study::read(&place.join("study.json"))?;
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let objective = objective(&study, &search, &Variable::ALL);
    let optimum: Value = serde_json::from_str(&text(place, "optimum.json")?)
        .map_err(|error| Error::Input { path: place.join("optimum.json"), source: error.into() })?;
    let sample = arguments.sample as usize;
    for (name, first) in [
        ("surf.csv", 0),
        ("fminsearch.csv", 3),
        ("fminsearch-starts.csv", 4),
        ("band.csv", 0),
        ("optimum.json", 0),
    ] {
        if !place.join(name).exists() {
            continue;
        }
        let (checks, what) = match name {
            "optimum.json" => (best(&objective, &optimum), "its design".to_owned()),
            "band.csv" => band(place, &study, &objective, &optimum, sample)?,
            _ => designs(place, name, first, &objective, sample)?,
        };
        let tally = run(&study, &objective, checks);
        let words = match tally.differ {
            0 => "the same to the last bit".to_owned(),
            differ => format!("{differ} differ, by at most {:.1e} of their value", tally.most),
        };
        screen.line(format!("  {name:<22} {what} run again: {words}"))?;
        if tally.most > arguments.within {
            problems.push(format!("{name}, {words}"));
        }
    }
    Ok(problems)
}

/// Compares the files with the manifest.
fn files(place: &Path, screen: Screen) -> Result<Vec<String>, Error> {
    let mut problems = Vec::new();
    let manifest = place.join(manifest::NAME);
    if !manifest.exists() {
        screen.line("  no manifest.json: what made these results is not written down")?;
        return Ok(problems);
    }
    let refuse = |error: serde_json::Error| Error::Input { path: manifest.clone(), source: error.into() };
    let manifest: Manifest = serde_json::from_str(&text(place, manifest::NAME)?).map_err(refuse)?;
    for (name, expected) in &manifest.files {
        match manifest::file_sha256(&place.join(name)) {
            Ok(found) if found == *expected => {}
            Ok(_) => problems.push(format!("{name} is not as it was made")),
            Err(_) => problems.push(format!("{name} is missing")),
        }
    }
    let study = sha256(text(place, "study.json")?.as_bytes());
    let known = [Some(&study), manifest.files.get("resolved.json")];
    if !known.contains(&Some(&manifest.study_sha256)) {
        problems.push("study.json is not the study that made these results".to_owned());
    }
    let words = if problems.is_empty() { "as they were made".to_owned() } else { problems.join("; ") };
    screen.line(format!("  {} files {words}", manifest.files.len()))?;
    if manifest.retune != VERSION {
        screen.line(format!("  note: made by Retune {}, this is {VERSION}", manifest.retune))?;
    }
    Ok(problems)
}

fn text(place: &Path, name: &str) -> Result<String, Error> {
    let path = place.join(name);
    std::fs::read_to_string(&path).map_err(|source| Error::Input { path, source })
}

/// Fields of a table's rows, of which `sample` are kept, evenly spread; and how many rows there are.
fn rows(place: &Path, name: &str, sample: usize) -> Result<(Vec<Vec<String>>, usize), Error> {
    let text = text(place, name)?;
    let count = text.lines().count().saturating_sub(1);
    let kept = count.min(sample);
    let wanted: Vec<usize> = (0..kept).map(|i| i * (count - 1) / kept.saturating_sub(1).max(1)).collect();
    let fields = |line: &str| line.split(',').map(str::to_owned).collect();
    let mut all = text.lines().skip(1);
    let mut next = 0;
    let mut found = Vec::new();
    for row in wanted {
        found.extend(all.nth(row - next).map(fields));
        next = row + 1;
    }
    Ok((found, count))
}

/// A field as a number; NaN where it is none.
fn number(fields: &[String], i: usize) -> f64 {
    fields.get(i).and_then(|field| field.parse().ok()).unwrap_or(f64::NAN)
}

/// Rows of a design, from field number `first`, and its E1max.
fn designs(
    place: &Path,
    name: &str,
    first: usize,
    objective: &PeakEnergy,
    sample: usize,
) -> Result<(Vec<Check>, String), Error> {
    let (rows, count) = rows(place, name, sample)?;
    let check = |fields: &Vec<String>| {
        let design: Vec<f64> = (first..first + 4).map(|i| number(fields, i)).collect();
        let said = number(fields, first + 4);
        objective.scene(&design).ok().map(|scene| Check { said, scene, whole: true })
    };
    Ok((rows.iter().filter_map(check).collect(), of(&rows, count)))
}

/// The curves over the band: without damper, with that of the study, with the best.
fn band(
    place: &Path,
    study: &Study,
    objective: &PeakEnergy,
    optimum: &Value,
    sample: usize,
) -> Result<(Vec<Check>, String), Error> {
    let (rows, count) = rows(place, "band.csv", sample)?;
    let mut checks = Vec::new();
    let what = of(&rows, count);
    let Some(tuned) = best_scene(objective, optimum) else { return Ok((checks, what)) };
    for fields in &rows {
        let Ok(omega) = NonNegative::new(number(fields, 0)) else { continue };
        for (i, mut scene) in [Scene { damper: None, ..tuned }, study.scene, tuned].into_iter().enumerate() {
            scene.forcing.frequency = omega;
            checks.push(Check { said: number(fields, i + 1), scene, whole: false });
        }
    }
    Ok((checks, what))
}

/// How many rows there are, and how many were taken.
fn of(rows: &[Vec<String>], count: usize) -> String {
    format!("{} of {count} rows", rows.len())
}

/// The best design's E1max, as the search found it and as its run says.
fn best(objective: &PeakEnergy, optimum: &Value) -> Vec<Check> {
    let Some(scene) = best_scene(objective, optimum) else { return Vec::new() };
    let said = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    vec![Check { said: said(&optimum["E1max"]), scene, whole: true }]
}

fn best_scene(objective: &PeakEnergy, optimum: &Value) -> Option<Scene> {
    let design = Variable::ALL.map(|variable| optimum[variable.symbol()].as_f64().unwrap_or(f64::NAN));
    objective.scene(&design).ok()
}

/// Runs all again.
fn run(study: &Study, objective: &PeakEnergy, checks: Vec<Check>) -> Tally {
    let again = |check: &Check| {
        if check.whole {
            let found = objective.evaluate(&check.scene, f64::INFINITY);
            found.map_or(f64::INFINITY, |found| found.value)
        } else {
            band::at_its_own(study, check.scene)
        }
    };
    let found: Vec<f64> = checks.par_iter().map(again).collect();
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
