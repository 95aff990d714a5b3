//! The manifest of a directory, written when its results are complete.

use super::Directory;
use crate::error::Error;
use crate::identity::Identity;
use crate::manifest::{Fields, Manifest, NAME};
use crate::order::Extent;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

impl Directory {
    /// Writes the manifest of all complete results, made by `solvers`; it must be the last file.
    pub fn write_manifest(&self, solvers: impl IntoIterator<Item = impl Serialize>) -> Result<(), Error> {
        let mut files = self.new_files()?;
        let mut earlier = BTreeMap::new();
        let mut made_by = self.made_by();
        let mut parts = self.parts();
        if let Some(old) = Manifest::read(&self.path)? {
            // Files that this run does not replace stay listed: as part of the results if they are of the same work, else as earlier.
            let same = old.identity() == self.identity;
            let whole = old.files.into_iter().map(|(name, sha)| (same, name, sha));
            let rest = old.earlier.into_iter().map(|(name, sha)| (false, name, sha));
            for (is_part, name, sha) in whole.chain(rest) {
                if !self.replaces(&name) && !files.contains_key(&name) {
                    if is_part { &mut files } else { &mut earlier }.insert(name, sha);
                }
            }
            if same && self.extent != Extent::Whole {
                parts.extend(old.parts); // those of the files that stay
            }
            // The same study from another place is still that of the first.
            if same {
                made_by = old.made_by;
            }
        }
        let Identity { study: study_sha256, version, arithmetic } = self.identity.clone();
        let solvers =
            solvers.into_iter().map(|solver| fields(&solver)).collect::<Result<Vec<Fields>, Error>>()?;
        let mut solvers = solvers.into_iter();
        let solver = solvers.next().filter(|first| solvers.all(|other| other == *first));
        let manifest =
            Manifest { retune: version, made_by, study_sha256, arithmetic, solver, files, earlier, parts };
        self.write_json(NAME, &manifest)
    }

    /// Adds the new files to the existing manifest: they belong to results that are not changed.
    pub fn amend_manifest(&self) -> Result<(), Error> {
        let Some(mut manifest) = Manifest::read(&self.path)? else { return Ok(()) };
        manifest.files.extend(self.new_files()?);
        self.write_json(NAME, &manifest)
    }

    /// Whether `path` holds the complete results of this work, `file` among them.
    pub fn is_finished(path: &Path, identity: &Identity, file: &str) -> bool {
        let is_made = |made: Manifest| made.identity() == *identity && made.files.contains_key(file);
        Manifest::read(path).ok().flatten().is_some_and(is_made) && !Self::is_unfinished(path)
    }
}

/// A structure as a flat JSON object.
fn fields(of: &impl Serialize) -> Result<Fields, Error> {
    let refuse = |error: serde_json::Error| Error::Output { path: NAME.into(), source: error.into() };
    serde_json::from_str(&serde_json::to_string(of).map_err(refuse)?).map_err(refuse)
}
