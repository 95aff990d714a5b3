//! A directory of results while they are being made: opened, filled, read.

use crate::error::Error;
use crate::identity::{Identity, json_text};
use crate::journal::Journal;
use crate::lock::Lock;
use crate::manifest::{Fields, MadeBy, Manifest, NAME, file_sha256};
use crate::order::{Extent, Order};
use crate::pending::{self, Pending};
use crate::plain::{self, names, sync_directory};
use crate::unfinished::{self, JOURNAL, UNFINISHED, Unfinished};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A directory of results while they are being made. One process at a time holds it.
pub struct Directory {
    path: PathBuf,
    unfinished: PathBuf,
    journal: Journal,
    order: Order,
    extent: Extent,
    identity: Identity,
    is_ours: Box<dyn Fn(&str) -> bool + Send + Sync>,
    /// The subdirectories in which this run began searches.
    parts: Mutex<BTreeSet<String>>,
    /// The subdirectories of discarded unfinished work.
    discarded_parts: BTreeSet<String>,
    warning: Option<String>,
    _lock: Lock,
}

impl Directory {
    /// Opens the directory, created if there is none, for work of this identity. Earlier results stay until the new ones are complete
    /// and are then removed: results of two studies must not be mixed. `is_ours` tells which file names the work may write; unless its
    /// extent is [`Extent::Whole`], only these are replaced.
    ///
    /// # Errors
    /// The directory cannot be created or written to; another process holds it; it contains something that `order` does not allow to
    /// be replaced; or it contains unfinished work of another study, or any that `order` neither resumes nor discards.
    pub fn open(
        path: &Path,
        order: &Order,
        identity: &Identity,
        extent: Extent,
        is_ours: impl Fn(&str) -> bool + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        let refuse = |source| Error::Output { path: path.to_owned(), source };
        std::fs::create_dir_all(path).map_err(refuse)?;
        let lock = Lock::take(path)?;
        pending::clear(&path.join(NAME)).map_err(refuse)?;
        let found = Unfinished::find(path, order.begin, identity)?;
        order.may_replace(path, extent, identity, &is_ours)?;
        let unfinished = path.join(UNFINISHED);
        let (journal, discarded_parts, warning) = found.start(&unfinished, identity)?;
        // The directory entries of the journal and its directory must survive a power cut too.
        sync_directory(&unfinished).and_then(|()| sync_directory(path)).map_err(refuse)?;
        Ok(Self {
            path: path.to_owned(),
            unfinished,
            journal,
            order: order.clone(),
            extent,
            identity: identity.clone(),
            is_ours: Box::new(is_ours),
            parts: Mutex::default(),
            discarded_parts,
            warning,
            _lock: lock,
        })
    }

    /// The subdirectory `name`, for a search that is part of the work.
    pub fn part(&self, name: &str) -> Result<PathBuf, Error> {
        let part = plain::below(&self.path, name).map_err(|source| self.refused(source))?;
        self.journal.note_part(name);
        self.parts.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned());
        Ok(part)
    }

    /// The subdirectories in which the work has made results.
    pub fn parts(&self) -> BTreeSet<String> {
        self.parts.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The owner of the results.
    pub fn made_by(&self) -> MadeBy {
        self.order.made_by(&self.path)
    }

    /// Whether an earlier file of this name is removed when the new results are complete.
    pub fn replaces(&self, name: &str) -> bool {
        self.extent == Extent::Whole || (self.is_ours)(name)
    }

    /// Whether there is unfinished work in a directory.
    pub fn is_unfinished(path: &Path) -> bool {
        path.join(UNFINISHED).exists()
    }

    /// Removes the lock file left behind by a killed run.
    pub fn tidy(path: &Path) {
        drop(Lock::take(path)); // without permission it stays, and does no harm
    }

    /// A warning where the journal of the unfinished work was damaged.
    pub fn warning(&self) -> Option<&str> {
        self.warning.as_deref()
    }

    /// The path of the directory.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The journal of the work.
    pub fn journal(&self) -> &Journal {
        &self.journal
    }

    /// Records the value of a grid point that was computed elsewhere.
    pub fn know(&mut self, point: usize, value: f64) {
        self.journal.record_grid_value(point, value);
    }

    /// Begins the file `name`.
    pub fn file(&self, name: &str) -> Result<Pending, Error> {
        Pending::create(&self.unfinished.join(name))
    }

    /// Writes the whole file `name`.
    pub fn write(&self, name: &str, text: &str) -> Result<(), Error> {
        let mut file = self.file(name)?;
        file.push(text)?;
        file.finish()
    }

    /// Writes `value` as the JSON file `name`.
    pub fn write_json(&self, name: &str, value: &impl Serialize) -> Result<(), Error> {
        self.write(name, &json_text(value, name)?)
    }

    /// The text of a file that was written before the work was interrupted.
    pub fn read(&self, name: &str) -> Option<String> {
        std::fs::read_to_string(self.unfinished.join(name)).ok()
    }

    /// The names of the complete results, sorted.
    pub fn whole(&self) -> Result<Vec<String>, Error> {
        let mut names = names(&self.unfinished).map_err(|source| self.refused(source))?;
        names.retain(|name| name != JOURNAL && !name.ends_with(".item") && !name.starts_with('.'));
        Ok(names)
    }

    /// SHA-256 of each complete result except the manifest.
    fn new_files(&self) -> Result<BTreeMap<String, String>, Error> {
        let mut files = BTreeMap::new();
        for name in self.whole()?.into_iter().filter(|name| name != NAME) {
            let sha = file_sha256(&self.whole_path(&name))?;
            files.insert(name, sha);
        }
        Ok(files)
    }

    /// The path of a complete result that is not published yet.
    pub fn whole_path(&self, name: &str) -> PathBuf {
        self.unfinished.join(name)
    }

    /// Discards the unfinished work, because repeating it would end the same way. Earlier results stay.
    pub fn discard(&self) {
        let _ = unfinished::remove(&self.unfinished); // what is left of it is cleared by the next run
    }

    fn refused(&self, source: std::io::Error) -> Error {
        Error::Output { path: self.path.clone(), source }
    }
}

impl Drop for Directory {
    /// A run that computed nothing leaves nothing to resume.
    fn drop(&mut self) {
        let began = |part: &String| self.path.join(part).join(UNFINISHED).exists();
        if self.journal.is_empty() && !self.parts().iter().any(began) {
            let _ = unfinished::remove(&self.unfinished); // an empty journal does no harm either
        }
    }
}

impl Directory {
    /// Writes the manifest of all complete results, made by `solvers`; it must be the last file.
    pub fn write_manifest(&self, solvers: impl IntoIterator<Item = impl Serialize>) -> Result<(), Error> {
        let mut files = self.new_files()?;
        let mut earlier = BTreeMap::new();
        let mut made_by = self.made_by();
        let mut parts = BTreeMap::new();
        for name in self.parts() {
            let made = Manifest::read(&self.path.join(&name))?;
            parts.extend(made.map(|manifest| (name, manifest.study_sha256)));
        }
        if let Some(old) = Manifest::read(&self.path)? {
            // Files that this run does not replace stay listed: among the results if they are of the same work, else as earlier files.
            let same = old.identity() == self.identity;
            let whole = old.files.into_iter().map(|(name, sha)| (same, name, sha));
            let rest = old.earlier.into_iter().map(|(name, sha)| (false, name, sha));
            for (is_part, name, sha) in whole.chain(rest) {
                if !self.replaces(&name) && !files.contains_key(&name) {
                    if is_part { &mut files } else { &mut earlier }.insert(name, sha);
                }
            }
            if same && self.extent != Extent::Whole {
                old.parts.into_iter().for_each(|(name, study)| {
                    parts.entry(name).or_insert(study); // the parts of the files that stay
                });
            }
            // If the same study is run from another path, the owner remains the first one.
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

    /// Adds the new files to the existing manifest, whose results do not change.
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

impl Directory {
    /// Replaces the earlier results by the new ones, which are synced to disk before any earlier file is removed. The journal stays
    /// until [`Self::finish`].
    ///
    /// # Errors
    /// An existing file may not be replaced, or a file cannot be written, moved or removed.
    pub fn publish(&self) -> Result<(), Error> {
        self.journal.check()?;
        let new = self.whole()?;
        if new.is_empty() {
            return Ok(()); // already in place
        }
        // A file may have been put there since the work began.
        self.order
            .may_replace(&self.path, self.extent, &self.identity, |name| new.iter().any(|new| new == name))?;
        self.place(&new).map_err(|source| self.refused(source))
    }

    /// Moves the new files into place. The process may be killed at any moment, so a manifest that lists both old and new files is
    /// written first.
    fn place(&self, new: &[String]) -> std::io::Result<()> {
        for name in new {
            File::open(self.unfinished.join(name))?.sync_all()?;
        }
        let old = Manifest::read(&self.path).map_err(std::io::Error::other)?;
        let mut existing = names(&self.path)?;
        existing.retain(|name| old.as_ref().is_some_and(|old| old.has_made(&self.path, name)));
        if let Some(mut interim) = Manifest::read(&self.unfinished).map_err(std::io::Error::other)? {
            for name in &existing {
                let sha = file_sha256(&self.path.join(name)).map_err(std::io::Error::other)?;
                interim.earlier.insert(name.clone(), sha);
            }
            let write = || {
                let mut file = Pending::create(&self.path.join(NAME))?;
                file.push(&json_text(&interim, NAME)?)?;
                file.finish_on_disk()
            };
            write().map_err(std::io::Error::other)?;
        }
        existing.retain(|name| self.replaces(name));
        if self.order.replace {
            let is_ours = |name: &String| {
                (self.is_ours)(name) && plain::is_there(&self.path.join(name)).unwrap_or(false)
            };
            existing.extend(names(&self.path)?.into_iter().filter(is_ours));
        }
        let gone: BTreeSet<String> = existing.into_iter().filter(|name| !new.contains(name)).collect();
        for name in gone {
            std::fs::remove_file(self.path.join(name))?;
        }
        if let Some(old) = old.filter(|_| self.extent == Extent::Whole) {
            self.remove_parts(old.parts.keys(), false)?;
        }
        self.remove_parts(self.journal.parts(), true)?;
        self.remove_parts(&self.discarded_parts, true)?;
        let (manifest, files): (Vec<&String>, Vec<&String>) = new.iter().partition(|name| *name == NAME);
        for name in files.into_iter().chain(manifest) {
            std::fs::rename(self.unfinished.join(name), self.path.join(name))?;
        }
        sync_directory(&self.path)
    }

    /// Removes Retune's files from subdirectories that are no longer part of the work.
    fn remove_parts<'a>(
        &self,
        earlier: impl IntoIterator<Item = &'a String>,
        with_unfinished: bool,
    ) -> std::io::Result<()> {
        let now = self.parts();
        for name in earlier.into_iter().filter(|name| !now.contains(*name)) {
            // A symbolic link put there since the manifest was read points to files that are not ours.
            let Ok(part) = plain::below(&self.path, name) else { continue };
            unfinished::remove_results(&part, with_unfinished)?;
            let mut above = Path::new(name).parent();
            while let Some(name) = above.filter(|name| !name.as_os_str().is_empty()) {
                let _ = std::fs::remove_dir(self.path.join(name)); // it stays if anything else is in it
                above = name.parent();
            }
        }
        Ok(())
    }

    /// Puts the new results into place and removes what the work left behind.
    pub fn finish(self) -> Result<(), Error> {
        self.publish()?;
        unfinished::remove(&self.unfinished).map_err(|source| self.refused(source))
    }
}
