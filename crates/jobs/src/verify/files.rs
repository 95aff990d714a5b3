//! Comparison of the files of a directory with its manifest.

use super::report::Report;
use crate::Error;
use crate::again::text;
use crate::resolved;
use retune_store::identity::{Identity, VERSION, sha256};
use retune_store::manifest::{self, Manifest};
use retune_study::counted;
use std::path::Path;

/// Compares every file with the manifest; returns their names, sorted.
pub fn verify(place: &Path, report: &mut Report<'_>) -> Result<Vec<String>, Error> {
    let (there, links) = names(place)?;
    compare(place, &there, report)?;
    for name in links {
        report.unchecked(&format!("{name} is a symbolic link, and Retune follows none"))?;
    }
    Ok(there)
}

fn compare(place: &Path, there: &[String], report: &mut Report<'_>) -> Result<(), Error> {
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
        _ => {}
    }
    let whole =
        format!("{} as {} made", counted(manifest.files.len() as u64, "file"), was(manifest.files.len()));
    let words = if problems.is_empty() {
        whole
    } else {
        format!("{}: {}", counted(manifest.files.len() as u64, "file"), problems.join("; "))
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

fn was(files: usize) -> &'static str {
    if files == 1 { "it was" } else { "they were" }
}

/// Whether a file is not a result: a lock, or a hidden file of an editor.
pub fn is_hidden(path: &Path) -> bool {
    path.file_name().is_none_or(|name| name.to_string_lossy().starts_with('.'))
}

/// The names of the files in a directory but the manifest, sorted; and those of the symbolic links.
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
