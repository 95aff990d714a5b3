//! What a directory holds that is not the results of one search, and what in it can be read instead.

use super::file::{StudyError, read_text};
use super::kind::Kind;
use super::words::{counted, joined};
use std::path::{Path, PathBuf};

/// The file with the design that a search found, beside [`STUDY`], its study.
pub const OPTIMUM: &str = "optimum.json";
/// The study of results.
pub const STUDY: &str = "study.json";
/// The file in the place of [`STUDY`] where there are several.
const SEVERAL: &str = "resolved.json";
/// How many names of files are told.
const TOLD: usize = 5;

/// Why a directory without a study is not read as one.
pub fn instead(path: &Path) -> StudyError {
    let names = match names(path) {
        Ok(names) => names,
        Err(source) => return StudyError::Unreadable { file: path.display().to_string(), source },
    };
    let one = first_study(path, &names).or_else(|| first_below(path, &names));
    let (file, one) = (path.display().to_string(), one.map(|one| one.display().to_string()));
    if names.iter().any(|name| name == SEVERAL) {
        return StudyError::Several { file, one };
    }
    StudyError::NoResults { file, found: told(&names), one }
}

/// The names in a directory, sorted; those of directories end in a slash.
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

/// The names in words.
fn told(names: &[String]) -> String {
    match names.len() {
        0 => "nothing".to_owned(),
        count if count > TOLD => {
            format!("{} and {}", joined(&names[..TOLD], ", "), counted((count - TOLD) as u64, "other"))
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

/// The first directory below with the results of a search.
fn first_below(path: &Path, names: &[String]) -> Option<PathBuf> {
    let inner: Vec<PathBuf> =
        names.iter().filter_map(|name| Some(path.join(name.strip_suffix('/')?))).collect();
    let below = |inner: &PathBuf| {
        if inner.join(OPTIMUM).exists() {
            return Some(inner.clone());
        }
        first_below(inner, &names_of(inner))
    };
    inner.iter().find_map(below)
}

fn names_of(path: &Path) -> Vec<String> {
    names(path).unwrap_or_default()
}
