//! `manifest.json`: what made the results that stand beside it, and what they were when they were made.

use super::identity::{Identity, hexadecimal};
use super::{Directory, plain};
use crate::error::Error;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Its name.
pub const NAME: &str = "manifest.json";

/// A flat JSON object, its fields in their order.
pub type Fields = IndexMap<String, Value>;

/// What made a directory of results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The version of Retune.
    pub retune: String,
    /// The command and the study file that made them; none where that was not written down yet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_by: Option<MadeBy>,
    /// SHA-256 of the resolved study, `study.json`; of a result of several studies, of `resolved.json`.
    pub study_sha256: String,
    /// Digits that stand for the machine's sines and powers.
    pub arithmetic: String,
    /// The integration method and its tolerances; none where studies differ in it, and then each says its own in `resolved.json`.
    pub solver: Option<Fields>,
    /// SHA-256 of each file.
    pub files: BTreeMap<String, String>,
    /// Files of an earlier study that still stand beside them.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub earlier: BTreeMap<String, String>,
    /// Directories below with the results of its searches, each with a manifest of its own.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub parts: BTreeSet<String>,
}

/// Whose results they are: a study that was edited is the same study, and one of the same name elsewhere another.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MadeBy {
    /// The command.
    pub command: String,
    /// The study file, as seen from the directory of the results.
    pub study: String,
}

impl Manifest {
    /// Reads the manifest of a directory, if there is one.
    pub fn read(place: &Path) -> Option<Self> {
        let mut text = String::new();
        plain::open(&place.join(NAME)).ok()?.read_to_string(&mut text).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// What made the results.
    pub fn identity(&self) -> Identity {
        Identity {
            study: self.study_sha256.clone(),
            version: self.retune.clone(),
            arithmetic: self.arithmetic.clone(),
        }
    }

    /// Whether the file `name` in the directory `place` of this manifest stands as Retune made it.
    pub fn has_made(&self, place: &Path, name: &str) -> bool {
        let made = [&self.files, &self.earlier].map(|files| files.get(name));
        let path = place.join(name);
        made.iter().any(Option::is_some)
            && plain::is_there(&path).unwrap_or(false)
            && file_sha256(&path).is_ok_and(|found| made.contains(&Some(&found)))
    }
}

/// Writes the manifest of all results that are whole, made by `solvers`; it must be the last of them.
///
/// # Errors
/// A file cannot be read or written.
pub fn write(
    identity: Identity,
    solvers: impl IntoIterator<Item = impl Serialize>,
    results: &Directory,
) -> Result<(), Error> {
    let mut files = results.new_files()?;
    let mut earlier = BTreeMap::new();
    let mut made_by = results.made_by();
    if let Some(old) = Manifest::read(results.path()) {
        // What a share of the results leaves alone stays in the books, as part of the whole if it is of the same work.
        let same = old.identity() == identity;
        let whole = old.files.into_iter().map(|(name, sha)| (same, name, sha));
        let rest = old.earlier.into_iter().map(|(name, sha)| (false, name, sha));
        for (is_part, name, sha) in whole.chain(rest) {
            if !results.replaces(&name) && !files.contains_key(&name) {
                if is_part { &mut files } else { &mut earlier }.insert(name, sha);
            }
        }
        // The same study from another place is still that of the first.
        made_by = old.made_by.filter(|_| same).unwrap_or(made_by);
    }
    let Identity { study: study_sha256, version, arithmetic } = identity;
    let solvers =
        solvers.into_iter().map(|solver| fields(&solver)).collect::<Result<Vec<Fields>, Error>>()?;
    let mut solvers = solvers.into_iter();
    let solver = solvers.next().filter(|first| solvers.all(|other| other == *first));
    let (made_by, parts) = (Some(made_by), results.parts());
    let manifest =
        Manifest { retune: version, made_by, study_sha256, arithmetic, solver, files, earlier, parts };
    results.write_json(NAME, &manifest)
}

/// A structure as a flat JSON object.
fn fields(of: &impl Serialize) -> Result<Fields, Error> {
    let refuse = |error: serde_json::Error| Error::Output { path: NAME.into(), source: error.into() };
    serde_json::from_str(&serde_json::to_string(of).map_err(refuse)?).map_err(refuse)
}

/// Writes the manifest that stands there with the files that are new: they belong to results that stay as they are.
///
/// # Errors
/// A file cannot be read or written.
pub fn amend(results: &Directory) -> Result<(), Error> {
    let Some(mut manifest) = Manifest::read(results.path()) else { return Ok(()) };
    manifest.files.extend(results.new_files()?);
    results.write_json(NAME, &manifest)
}

/// Whether the results of this work stand in `out` already, whole.
pub fn is_finished(out: &Path, identity: &Identity) -> bool {
    let made_by = Manifest::read(out).map(|manifest| manifest.identity());
    made_by.is_some_and(|made_by| made_by == *identity) && !Directory::is_unfinished(out)
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
