//! `verify`: compares results with what their study gives. Every file is compared with the manifest; by the lists of the jobs a sample of
//! the rows is recomputed and compared to the last bit, and certificates are recomputed. Parts that cannot be checked are reported.

mod report;

use crate::artefact::{Content, Kind, is_named};
use crate::parts::PARTS;
use crate::recompute::{Recomputed, text};
use crate::{
    Error, Observer, branches, certify, design, fronts, losses, methods, paper, resolved, retention, sweep,
    table2, tune,
};
use report::Report;
use retune_store::UNFINISHED;
use retune_store::identity::{Identity, VERSION, sha256};
use retune_store::manifest::{self, Manifest};
use retune_study::counted;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Checks a directory of results and those below it, and reports whether each file holds. Of each table `sample` rows are recomputed;
/// numbers hold if their relative difference is at most `within`.
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
/// The comparisons of methods: their file names are generic, so they apply only where the manifest names their command.
static COMPARISONS: [&Kind; 2] = [&methods::ACCURACY, &methods::STABILITY];

/// The kinds that make searches, each in a directory below; the manifest of a search names their command.
static SEARCHING: [&Kind; 6] =
    [&table2::KIND, &losses::KIND, &retention::KIND, &fronts::KIND, &paper::KIND, &design::KIND];

/// Checks the results in one directory: each file against the manifest, then its contents by recomputing them.
fn check(place: &Path, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    if !is_result(place) {
        let (names, links) = names(place)?;
        let all = [names, links].concat().join(", ");
        return report.unchecked(&format!("{all}: no manifest.json beside it says what made this"));
    }
    let there = compare_files(place, report)?;
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
                .and_then(|source| report.check_rows(&place.join(name), name, &source, most)),
            Content::Whole(made) => made(place, name).and_then(|made| match made {
                Recomputed::Part { what, stored, recomputed } => {
                    report.compare(name, what, &stored, &recomputed)
                }
                Recomputed::Failed(why) => report.fail(name, &why),
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
    if known.iter().any(|(name, _)| tune::log::SEARCHED.contains(name)) && !is_found {
        return report.unchecked("there is no optimum.json: the design that was found");
    }
    Ok(())
}

/// The files of a directory that a job makes, in the order of its list.
fn known<'a>(place: &Path, there: &'a [String]) -> Vec<(&'a str, Content)> {
    let mut known: Vec<(&str, Content)> = Vec::new();
    let command = Manifest::read(place).ok().flatten().map(|manifest| manifest.made_by.command);
    let compared = COMPARISONS.iter().filter(|kind| command.as_deref() == Some(kind.command));
    for (pattern, content) in compared.chain(&KINDS).flat_map(|kind| kind.files()) {
        for name in there.iter().filter(|name| is_named(name, pattern)) {
            if known.iter().all(|(other, _)| other != name) {
                known.push((name, content));
            }
        }
    }
    known
}

fn is_result(place: &Path) -> bool {
    [manifest::NAME, resolved::ONE].iter().any(|name| place.join(name).exists())
}

/// Collects a directory and those below it that contain files, sorted. No link is followed.
fn collect(path: &Path, places: &mut Vec<PathBuf>) -> std::io::Result<()> {
    let mut inner = Vec::new();
    for entry in std::fs::read_dir(path)? {
        let entry = entry?;
        inner.push((entry.path(), entry.file_type()?.is_dir()));
    }
    if inner.iter().any(|(path, is_directory)| !is_directory && !is_hidden(path)) {
        places.push(path.to_owned());
    }
    // The shares of a grid are the input of a merge, not results.
    inner.retain(|(path, is_directory)| {
        *is_directory && !path.ends_with(UNFINISHED) && !path.ends_with(PARTS)
    });
    inner.sort();
    inner.iter().try_for_each(|(path, _)| collect(path, places))
}

/// Compares every file with the manifest; returns their names, sorted.
fn compare_files(place: &Path, report: &mut Report<'_>) -> Result<Vec<String>, Error> {
    let (there, links) = names(place)?;
    compare_with_manifest(place, &there, report)?;
    for name in links {
        report.unchecked(&format!("{name} is a symbolic link, and Retune follows none"))?;
    }
    Ok(there)
}

fn compare_with_manifest(place: &Path, there: &[String], report: &mut Report<'_>) -> Result<(), Error> {
    if !place.join(manifest::NAME).exists() {
        return report.unchecked(
            "there is no manifest.json: what made these files, and whether they are as it made them",
        );
    }
    let manifest = text(place, manifest::NAME).map(|text| serde_json::from_str::<Manifest>(&text));
    let manifest = match manifest {
        Ok(Ok(manifest)) => match manifest.check(place) {
            Ok(()) => manifest,
            Err(error) => return report.fail(manifest::NAME, &error.to_string()),
        },
        Ok(Err(error)) => return report.fail(manifest::NAME, &format!("is no manifest: {error}")),
        Err(error) => return report.fail(manifest::NAME, &error.to_string()),
    };
    let mut problems = Vec::new();
    for (name, study) in &manifest.parts {
        match Manifest::read(&place.join(name)) {
            Ok(Some(part)) if part.study_sha256 == *study => {}
            Ok(Some(_)) => {
                problems.push(format!("{name} has the results of another study than it was made with"))
            }
            _ => problems.push(format!("{name} is missing, or its manifest.json")),
        }
    }
    for (name, expected) in &manifest.files {
        match manifest::file_sha256(&place.join(name)) {
            Ok(found) if found == *expected => {}
            Ok(_) => problems.push(format!("{name} is not as it was made")),
            Err(_) => problems.push(format!("{name} is missing")),
        }
    }
    let input = [resolved::SEVERAL, resolved::ONE].into_iter().find(|name| place.join(name).exists());
    match input {
        Some(input) if sha256(text(place, input).unwrap_or_default().as_bytes()) != manifest.study_sha256 => {
            problems.push(format!("{input} is not the study that made these results"));
        }
        Some(input) => problems.extend(statements(place, input, &manifest)),
        None => {}
    }
    let files = counted(manifest.files.len() as u64, "file");
    let made = if manifest.files.len() == 1 { "it was" } else { "they were" };
    let words = match problems.as_slice() {
        [] => format!("{files} as {made} made"),
        problems => format!("{files}: {}", problems.join("; ")),
    };
    report.found("", Some(problems.is_empty()), &words);
    report.watch.result(&format!("  {words}"))?;
    let place = report.place.clone();
    report.problems.extend(problems.into_iter().map(|problem| format!("{place}{problem}")));
    let unnamed: Vec<String> =
        there.iter().filter(|name| !manifest.files.contains_key(*name)).cloned().collect();
    if !unnamed.is_empty() {
        let not = if unnamed.len() == 1 { "is" } else { "are" };
        report.unchecked(&format!("{} {not} not in the manifest", unnamed.join(", ")))?;
    }
    if manifest.retune != VERSION {
        report.watch.result(&format!("  note: made by Retune {}, this is {VERSION}", manifest.retune))?;
    }
    if manifest.arithmetic != Identity::of("").arithmetic {
        report.watch.result(
            "  note: made on a machine whose sines or powers differ in their last bits; --within allows for that",
        )?;
    }
    Ok(())
}

/// False statements of a manifest on the results, apart from their files and input.
fn statements(place: &Path, input: &str, manifest: &Manifest) -> Vec<String> {
    let mut problems = Vec::new();
    let command = &manifest.made_by.command;
    let makes = |kind: &Kind| manifest.files.keys().any(|name| name != input && kind.makes(name));
    let has_made = |kind: &Kind| {
        let is_search = SEARCHING.iter().any(|other| other.command == kind.command) && makes(&tune::KIND);
        kind.command == command && (makes(kind) || is_search)
    };
    if !KINDS.iter().chain(&COMPARISONS).any(|kind| has_made(kind)) {
        problems.push(format!("{}, made_by.command: `{command}` makes no such files", manifest::NAME));
    }
    let read: Value =
        text(place, input).ok().and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
    let dampers = read["dampers"].as_array();
    let studies: Vec<&Value> =
        dampers.map_or_else(|| vec![&read], |all| all.iter().map(|damper| &damper["study"]).collect());
    let first = studies.first().map_or(&Value::Null, |study| &study["solver"]);
    let common = if studies.iter().all(|study| study["solver"] == *first) { first } else { &Value::Null };
    // A comparison of methods has no solver.
    if manifest.solver.as_ref().is_some_and(|solver| serde_json::json!(solver) != *common) {
        problems.push(format!("{}, solver: {input} has another", manifest::NAME));
    }
    problems
}

/// Whether a file is hidden and so no result: a lock, or a file of an editor.
fn is_hidden(path: &Path) -> bool {
    path.file_name().is_none_or(|name| name.to_string_lossy().starts_with('.'))
}

/// The names of the files in a directory without the manifest, and of its symbolic links, both sorted.
fn names(place: &Path) -> Result<(Vec<String>, Vec<String>), Error> {
    let refuse = |source| retune_store::Error::Input { path: place.to_owned(), source };
    let (mut names, mut links) = (Vec::new(), Vec::new());
    for entry in std::fs::read_dir(place).map_err(refuse)? {
        let entry = entry.map_err(refuse)?;
        let (path, kind) = (entry.path(), entry.file_type().map_err(refuse)?);
        let list = if kind.is_symlink() { &mut links } else { &mut names };
        if !kind.is_dir() && !is_hidden(&path) && !path.ends_with(manifest::NAME) {
            list.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    names.sort();
    links.sort();
    Ok((names, links))
}
