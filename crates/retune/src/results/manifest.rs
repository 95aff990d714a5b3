//! `manifest.json`: what made the results that stand beside it, and what they were when they were made.

use super::Directory;
use super::identity::{Identity, hexadecimal};
use crate::error::Error;
use crate::study::Solver;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

/// Its name.
pub const NAME: &str = "manifest.json";

/// What made a directory of results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The version of Retune.
    pub retune: String,
    /// SHA-256 of the resolved study, `study.json`; of a result of several studies, of `resolved.json`.
    pub study_sha256: String,
    /// Digits that stand for the machine's sines and powers.
    pub arithmetic: String,
    /// The integration method and its tolerances; none where studies differ in it, and then each says its own in `resolved.json`.
    pub solver: Option<Solver>,
    /// SHA-256 of each file.
    pub files: BTreeMap<String, String>,
}

/// Writes the manifest of all results that are whole, made by `solvers`; it must be the last of them.
///
/// # Errors
/// A file cannot be read or written.
pub fn write(
    identity: Identity,
    solvers: impl IntoIterator<Item = Solver>,
    results: &Directory,
) -> Result<(), Error> {
    let Identity { study: study_sha256, version, arithmetic } = identity;
    let mut files = BTreeMap::new();
    for name in results.whole()? {
        files.insert(name.clone(), file_sha256(&results.whole_path(&name))?);
    }
    let mut solvers = solvers.into_iter();
    let solver = solvers.next().filter(|first| solvers.all(|other| other == *first));
    let manifest = Manifest { retune: version, study_sha256, arithmetic, solver, files };
    results.write_json(NAME, &manifest)
}

/// Whether the results of this work stand in `out` already, whole.
pub fn is_finished(out: &Path, identity: &Identity) -> bool {
    let text = std::fs::read_to_string(out.join(NAME)).unwrap_or_default();
    let made_by = serde_json::from_str(&text).map(|manifest: Manifest| Identity {
        study: manifest.study_sha256,
        version: manifest.retune,
        arithmetic: manifest.arithmetic,
    });
    made_by.is_ok_and(|made_by| made_by == *identity) && !Directory::is_unfinished(out)
}

/// SHA-256 of a file, in hexadecimal.
///
/// # Errors
/// It cannot be read.
pub fn file_sha256(path: &Path) -> Result<String, Error> {
    let refuse = |source| Error::Input { path: path.to_owned(), source };
    let mut hash = Sha256::new();
    std::io::copy(&mut File::open(path).map_err(refuse)?, &mut hash).map_err(refuse)?;
    Ok(hexadecimal(&hash.finalize()))
}
