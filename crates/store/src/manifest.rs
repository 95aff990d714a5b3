//! `manifest.json`: the origin of the results beside it, and the checksum that each had when it was made.

use crate::error::Error;
use crate::identity::{Identity, hexadecimal};
use crate::plain;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// Its name.
pub const NAME: &str = "manifest.json";

/// A flat JSON object, its fields in their order.
pub type Fields = IndexMap<String, Value>;

/// The origin of a directory of results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The version of Retune.
    pub retune: String,
    /// The command and the study file that made them; none where that was not written down yet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_by: Option<MadeBy>,
    /// SHA-256 of the resolved study, `study.json`; of a result of several studies, of `resolved.json`.
    pub study_sha256: String,
    /// A checksum of the machine's sines and powers.
    pub arithmetic: String,
    /// The integration method and its tolerances; none where studies differ in it, and then each says its own in `resolved.json`.
    pub solver: Option<Fields>,
    /// SHA-256 of each file.
    pub files: BTreeMap<String, String>,
    /// Files of an earlier study that are still beside them, with their SHA-256.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub earlier: BTreeMap<String, String>,
    /// Directories below with the results of its searches, each with a manifest of its own.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub parts: BTreeSet<String>,
}

/// The owner of results: a study file remains the same study when it is edited; a file of the same name elsewhere is another one.
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

    /// The identity of the work that made the results.
    pub fn identity(&self) -> Identity {
        Identity {
            study: self.study_sha256.clone(),
            version: self.retune.clone(),
            arithmetic: self.arithmetic.clone(),
        }
    }

    /// Whether the file `name` in the directory `place` of this manifest is unchanged since Retune made it.
    pub fn has_made(&self, place: &Path, name: &str) -> bool {
        let made = [&self.files, &self.earlier].map(|files| files.get(name));
        let path = place.join(name);
        made.iter().any(Option::is_some)
            && plain::is_there(&path).unwrap_or(false)
            && file_sha256(&path).is_ok_and(|found| made.contains(&Some(&found)))
    }
}

/// SHA-256 of a file, in hexadecimal.
///
/// # Errors
/// It cannot be read.
pub fn file_sha256(path: &Path) -> Result<String, Error> {
    let refuse = |source| Error::Input { path: path.to_owned(), source };
    let mut file = BufReader::with_capacity(1 << 16, File::open(path).map_err(refuse)?);
    let mut hash = Sha256::new();
    loop {
        let part = file.fill_buf().map_err(refuse)?;
        if part.is_empty() {
            return Ok(hexadecimal(&hash.finalize()));
        }
        hash.update(part);
        let read = part.len();
        file.consume(read);
    }
}
