//! Reads a file, or the results of a search, into a checked study.

use super::built_in::{is_built_in, read_plan_text};
use super::file::{Kind, StudyError, expect, in_si, parse, read_text};
use super::format::Study;
use super::rule::Rule;
use super::search::name_from;
use super::words::{counted, joined};
use super::{records, window};
use retune_model::{Design, Parameter};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Reads the plan of the paper's reproduction.
///
/// # Errors
/// [`StudyError`]: the file, the field, its value and the allowed values.
pub fn read_paper<T: DeserializeOwned + Serialize>(path: &Path) -> Result<T, StudyError> {
    let (text, file) = (read_plan_text(path)?, path.display().to_string());
    expect(Kind::Paper, &text, &file)?;
    parse(&text, &file)
}

/// Reads and checks a study; its name defaults to that of the file. For the directory of a search's results, or its
/// `optimum.json`, returns the study with the design found in its scene.
///
/// # Errors
/// [`StudyError`]: the file, the field, its value and the allowed values.
pub fn read(path: &Path) -> Result<Study, StudyError> {
    let Some(place) = found_in(path)? else {
        return from_text(&read_text(path)?, &path.display().to_string());
    };
    if path.is_dir() && !place.join(STUDY).exists() {
        return Err(instead(path));
    }
    let file = place.join(STUDY);
    let study = from_text(&read_text(&file)?, &file.display().to_string())?;
    let optimum = if path.is_dir() { place.join(OPTIMUM) } else { path.to_owned() };
    if !optimum.exists() {
        return Ok(study); // results of a certificate: the study holds the design
    }
    let found = design(&read_text(&optimum)?, &optimum.display().to_string())?;
    match study.scene_at(&found) {
        Some(scene) => Ok(Study { scene, ..study }),
        None => Err(StudyError::Rule { file: file.display().to_string(), rule: Rule::NoDamper }),
    }
}

/// Like [`read`], for a study that a plan names, which may be built in.
pub(super) fn named(path: &Path) -> Result<Study, StudyError> {
    if is_built_in(path) {
        from_text(&read_plan_text(path)?, &path.display().to_string())
    } else {
        read(path)
    }
}

/// The directory of results that a path names: the path itself, or the directory of an `optimum.json`; none for a study file.
pub fn found_in(path: &Path) -> Result<Option<PathBuf>, StudyError> {
    if path.is_dir() {
        return Ok(Some(path.to_owned()));
    }
    let json: Result<Value, _> = serde_json::from_str(&read_text(path)?);
    let is_optimum = json.is_ok_and(|json| json.get("damper_type").is_some());
    Ok(is_optimum.then(|| path.parent().unwrap_or(Path::new("")).to_owned()))
}

/// The design of an `optimum.json`.
fn design(text: &str, file: &str) -> Result<Design, StudyError> {
    let found: Value = parse(text, file)?;
    let value =
        |parameter: Parameter| found.get(parameter.symbol()).and_then(Value::as_f64).unwrap_or(f64::NAN);
    let refused = |parameter: Parameter| StudyError::Rule {
        file: file.to_owned(),
        rule: Rule::not_allowed(
            parameter.symbol(),
            found.get(parameter.symbol()).map_or("nothing".to_owned(), ToString::to_string),
            "a number not below 0: the design that `retune optimize` found",
        ),
    };
    // Either both gaps are given, or neither (a damper without walls).
    let gaps = [Parameter::D, Parameter::C];
    let walled = gaps.iter().any(|gap| found.get(gap.symbol()).is_some());
    match gaps.into_iter().find(|gap| walled && value(*gap).is_nan()) {
        Some(missing) => Err(refused(missing)),
        None => Design::new(value).map_err(|(parameter, _)| refused(parameter)),
    }
}

/// Like [`read`], for the text of a study file.
pub fn from_text(text: &str, file: &str) -> Result<Study, StudyError> {
    expect(Kind::Study, text, file)?;
    let base = Path::new(file).parent().unwrap_or(Path::new(""));
    let text = &*in_si(text, file)?;
    let settled =
        window::resolved(text, base).map_err(|rule| StudyError::Rule { file: file.to_owned(), rule })?;
    let mut study: Study = parse(settled.as_deref().unwrap_or(text), file)?;
    let stem = Path::new(file).file_stem().map(|stem| name_from(&stem.to_string_lossy()));
    study.name = study.name.or(stem);
    records::read_all(&mut study, base).map_err(|rule| StudyError::Rule { file: file.to_owned(), rule })?;
    study.check().map_err(|rule| StudyError::Rule { file: file.to_owned(), rule })?;
    Ok(study)
}

/// The file with the design that a search found, beside [`STUDY`], its study.
pub const OPTIMUM: &str = "optimum.json";
/// The study of results.
pub const STUDY: &str = "study.json";
/// The file that replaces [`STUDY`] if there are several studies.
const RESOLVED: &str = "resolved.json";
/// Most file names listed in a message.
const MAX_LISTED: usize = 5;

/// The error for a directory that holds no study.
pub fn instead(path: &Path) -> StudyError {
    let names = match names(path) {
        Ok(names) => names,
        Err(source) => return StudyError::Unreadable { file: path.display().to_string(), source },
    };
    let one = first_study(path, &names).or_else(|| first_subdirectory(path, &names));
    let (file, one) = (path.display().to_string(), one.map(|one| one.display().to_string()));
    if names.iter().any(|name| name == RESOLVED) {
        return StudyError::Several { file, one };
    }
    StudyError::NoResults { file, found: listed(&names), one }
}

/// The names in a directory, sorted; directories end in a slash.
fn names(path: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(path)? {
        let entry = entry?;
        let slash = if entry.file_type()?.is_dir() { "/" } else { "" };
        names.push(format!("{}{slash}", entry.file_name().to_string_lossy()));
    }
    names.sort();
    Ok(names)
}

/// Lists the names in a sentence.
fn listed(names: &[String]) -> String {
    match names.len() {
        0 => "nothing".to_owned(),
        count if count > MAX_LISTED => {
            format!(
                "{} and {}",
                joined(&names[..MAX_LISTED], ", "),
                counted((count - MAX_LISTED) as u64, "other")
            )
        }
        _ => joined(names, ", "),
    }
}

/// The first study in a directory.
fn first_study(path: &Path, names: &[String]) -> Option<PathBuf> {
    let is_study = |file: &PathBuf| {
        let json = read_text(file).ok().and_then(|text| serde_json::from_str(&text).ok());
        json.is_some_and(|json| Kind::of(&json) == Some(Kind::Study))
    };
    names.iter().filter(|name| name.ends_with(".json")).map(|name| path.join(name)).find(is_study)
}

/// The first directory at any depth below `path` with the results of a search.
fn first_subdirectory(path: &Path, names: &[String]) -> Option<PathBuf> {
    let inner: Vec<PathBuf> =
        names.iter().filter_map(|name| Some(path.join(name.strip_suffix('/')?))).collect();
    let below = |inner: &PathBuf| {
        if inner.join(OPTIMUM).exists() {
            return Some(inner.clone());
        }
        first_subdirectory(inner, &names_of(inner))
    };
    inner.iter().find_map(below)
}

fn names_of(path: &Path) -> Vec<String> {
    names(path).unwrap_or_default()
}
