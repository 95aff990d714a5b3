//! `manifest.json`: the origin of the results beside it, and the checksum that each had when it was made.

use crate::error::Error;
use crate::identity::{Identity, hexadecimal};
use crate::plain;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::{Component, Path};

/// Its name.
pub const NAME: &str = "manifest.json";

/// A flat JSON object, its fields in their order.
pub type Fields = IndexMap<String, Value>;

/// The origin of a directory of results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The version of Retune.
    pub retune: String,
    /// The command and the study file that made them.
    pub made_by: MadeBy,
    /// SHA-256 of the resolved study, `study.json`; with several studies, of `resolved.json`.
    pub study_sha256: String,
    /// A checksum of the machine's sines and powers.
    pub arithmetic: String,
    /// The integration method and its tolerances; none if studies differ in them: `resolved.json` then has those of each.
    pub solver: Option<Fields>,
    /// The files, each with its SHA-256.
    pub files: BTreeMap<String, String>,
    /// Files of an earlier study that are still in the directory, with their SHA-256.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub earlier: BTreeMap<String, String>,
    /// Subdirectories with the results of its searches, each with its own manifest, and the SHA-256 of the study of each.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parts: BTreeMap<String, String>,
}

/// The owner of results. An edited study file remains the same owner; a file of the same name elsewhere is another.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MadeBy {
    /// The command.
    pub command: String,
    /// The study file, as seen from the directory of the results.
    pub study: String,
}

impl Manifest {
    /// Reads the manifest of a directory, if there is one.
    pub fn read(place: &Path) -> Result<Option<Self>, Error> {
        let text = plain::text(&place.join(NAME)).ok();
        let Some(manifest) = text.and_then(|text| serde_json::from_str::<Self>(&text).ok()) else {
            return Ok(None);
        };
        manifest.check(place)?;
        Ok(Some(manifest))
    }

    /// Checks that every path in the manifest of `place` stays within it: plain names of files, and parts below it.
    pub fn check(&self, place: &Path) -> Result<(), Error> {
        let refuse = |field: &str, problem: &str| Error::Input {
            path: place.join(NAME),
            source: std::io::Error::other(format!("{field}: {problem}")),
        };
        for (field, files) in [("files", &self.files), ("earlier", &self.earlier)] {
            let is_plain =
                |name: &&String| Path::new(name).components().eq([Component::Normal(name.as_ref())]);
            if let Some(name) = files.keys().find(|name| !is_plain(name)) {
                return Err(refuse(field, &format!("`{name}` is not the name of a file in this directory")));
            }
        }
        for name in self.parts.keys() {
            plain::below(place, name).map_err(|error| refuse("parts", &error.to_string()))?;
        }
        Ok(())
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
        made.iter().any(Option::is_some)
            && file_sha256(&place.join(name)).is_ok_and(|found| made.contains(&Some(&found)))
    }
}

/// SHA-256 of a plain file, in hexadecimal.
pub fn file_sha256(path: &Path) -> Result<String, Error> {
    let refuse = |source| Error::Input { path: path.to_owned(), source };
    let mut file = BufReader::with_capacity(1 << 16, plain::open(path).map_err(refuse)?);
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
