//! `manifest.json`: the origin of the results beside it, and the checksum that each had when it was made.

mod contents;

pub use contents::{Fields, MadeBy, Manifest, NAME, file_sha256};

use crate::directory::Directory;
use crate::error::Error;
use crate::identity::Identity;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Writes the manifest of all complete results, made by `solvers`; it must be the last file.
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
        // Files that this run does not replace stay listed: as part of the results if they are of the same work, else as earlier.
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

/// Adds the new files to the existing manifest: they belong to results that are not changed.
///
/// # Errors
/// A file cannot be read or written.
pub fn amend(results: &Directory) -> Result<(), Error> {
    let Some(mut manifest) = Manifest::read(results.path()) else { return Ok(()) };
    manifest.files.extend(results.new_files()?);
    results.write_json(NAME, &manifest)
}

/// Whether `out` holds the complete results of this work.
pub fn is_finished(out: &Path, identity: &Identity) -> bool {
    let made_by = Manifest::read(out).map(|manifest| manifest.identity());
    made_by.is_some_and(|made_by| made_by == *identity) && !Directory::is_unfinished(out)
}
