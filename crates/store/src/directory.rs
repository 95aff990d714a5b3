//! A directory of results while they are made: opened, filled, read.

mod manifest;
mod publish;

use crate::error::Error;
use crate::identity::{Identity, json_text};
use crate::journal::Journal;
use crate::lock::Lock;
use crate::manifest::{MadeBy, NAME, file_sha256};
use crate::order::{Extent, Order};
use crate::pending::{self, Pending};
use crate::plain;
use crate::plain::{names, sync_directory};
use crate::unfinished::{self, JOURNAL, UNFINISHED, Unfinished};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A directory of results while they are made. One process at a time has it.
pub struct Directory {
    path: PathBuf,
    unfinished: PathBuf,
    journal: Journal,
    order: Order,
    extent: Extent,
    identity: Identity,
    is_ours: Box<dyn Fn(&str) -> bool + Send + Sync>,
    /// The directories below in which searches were begun.
    parts: Mutex<BTreeSet<String>>,
    /// Those of unfinished work that is discarded.
    thrown_away: BTreeSet<String>,
    warning: Option<String>,
    _lock: Lock,
}

impl Directory {
    /// Opens the directory, created if there is none, for work of this identity. Earlier results stay until the new ones are complete
    /// and are then removed: results of two studies must not be mixed. `is_ours` tells the names of the files that the work may write;
    /// where its extent is not [`Extent::Whole`], only these are replaced.
    ///
    /// # Errors
    /// The directory cannot be made or written to; another process has it; there is something in it that `order` does not allow to
    /// be replaced; or there is unfinished work of another study in it, or any if `order` does not say what becomes of it.
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
        let (journal, thrown_away, warning) = found.take_up(&unfinished, identity)?;
        // The names of the journal and its directory must outlive a power cut as well.
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
            thrown_away,
            warning,
            _lock: lock,
        })
    }

    /// The directory `name` below this one, for a search that is part of the work.
    pub fn part(&self, name: &str) -> Result<PathBuf, Error> {
        let part = plain::below(&self.path, name).map_err(|source| self.refused(source))?;
        self.journal.note_part(name);
        self.parts.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned());
        Ok(part)
    }

    /// The directories below that the work has made results in.
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

    /// Removes the lock file that a killed run has left behind.
    pub fn tidy(path: &Path) {
        drop(Lock::take(path)); // without the right to, it stays, and does no harm
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

    /// Records the value of a point of the grid that was computed elsewhere.
    pub fn know(&mut self, point: usize, value: f64) {
        self.journal.learn_grid(point, value);
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
    pub fn write_json(&self, name: &str, value: &impl serde::Serialize) -> Result<(), Error> {
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

    /// Discards the unfinished work, because to repeat it would end the same way. Earlier results stay.
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
