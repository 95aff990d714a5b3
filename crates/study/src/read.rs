//! From a file, or the results of a search, to a checked study.

use super::built_in::{is_built_in, read_plan_text};
use super::file::{StudyError, expect, in_si, parse, read_text};
use super::format::Study;
use super::instead::{OPTIMUM, STUDY, instead};
use super::kind::Kind;
use super::records;
use super::rule::Rule;
use super::search::name_from;
use super::window;
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

/// Reads and checks a study, whose name is filled in from that of the file. The directory of a search's results, or its
/// `optimum.json`, stands for the study with the design that was found in its scene.
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
        return Ok(study); // of a certificate: the design is that of the study
    }
    let found = design(&read_text(&optimum)?, &optimum.display().to_string())?;
    match study.scene_at(&found) {
        Some(scene) => Ok(Study { scene, ..study }),
        None => Err(StudyError::Rule { file: file.display().to_string(), rule: Rule::NoDamper }),
    }
}

/// Reads a study that a plan names, which may be built in, as [`read`] does.
///
/// # Errors
/// As [`read`].
pub(super) fn named(path: &Path) -> Result<Study, StudyError> {
    if is_built_in(path) {
        from_text(&read_plan_text(path)?, &path.display().to_string())
    } else {
        read(path)
    }
}

/// The directory of the results that a path names: itself, or that of the `optimum.json` that it is; none of a study file.
///
/// # Errors
/// The file cannot be read.
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
        rule: Rule::NotAllowed {
            field: parameter.to_string(),
            value: found.get(parameter.symbol()).map_or("nothing".to_owned(), ToString::to_string),
            allowed: "a number not below 0: the design that `retune optimize` found",
        },
    };
    // Both gaps are there, or, of a damper without walls, neither.
    let gaps = [Parameter::D, Parameter::C];
    let walled = gaps.iter().any(|gap| found.get(gap.symbol()).is_some());
    match gaps.into_iter().find(|gap| walled && value(*gap).is_nan()) {
        Some(missing) => Err(refused(missing)),
        None => Design::new(value).map_err(|(parameter, _)| refused(parameter)),
    }
}

/// Checks the text of a study file as [`read`] does.
///
/// # Errors
/// As [`read`].
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
