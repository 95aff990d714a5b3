//! Results on disk, whatever is computed: whole or not there, and never those of someone else.
//!
//! A run opens a [`Directory`] for a work of an [`Identity`], writes its files, and finishes. New results come about in a directory of their own, `unfinished`, inside that of the results; only when all
//! are whole do they take the place of the earlier ones. What a run computed on the way is in its [`Journal`] there, so a run
//! that was stopped, killed or cut off can go on.

pub mod error;
pub mod identity;
pub mod journal;
mod lock;
pub mod manifest;
pub mod order;
mod pending;
mod plain;
pub mod seal;
mod unfinished;

pub use error::Error;
pub use identity::{Identity, json_text};
pub use journal::Journal;
pub use order::{Begin, Extent, Order};
pub use pending::Pending;

use lock::Lock;
use manifest::{MadeBy, Manifest};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

pub use unfinished::UNFINISHED;
use unfinished::{JOURNAL, Unfinished};

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
    /// Those of unfinished work that is thrown away.
    thrown_away: BTreeSet<String>,
    warning: Option<String>,
    _lock: Lock,
}

impl Directory {
    /// Opens the directory, made if there is none, for a work of this identity. Earlier results stay until the new ones are whole,
    /// and then go: those of two studies must not stand side by side. `is_ours` names what the work may write, and of a share of
    /// the results all that it replaces.
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
    pub fn part(&self, name: &str) -> PathBuf {
        self.journal.note_part(name);
        self.parts.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned());
        self.path.join(name)
    }

    /// The directories below that the work has made results in.
    pub fn parts(&self) -> BTreeSet<String> {
        self.parts.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Who makes the results.
    pub fn made_by(&self) -> MadeBy {
        self.order.made_by(&self.path)
    }

    /// Whether an earlier file of this name goes when the new results are whole.
    pub fn replaces(&self, name: &str) -> bool {
        self.extent == Extent::Whole || (self.is_ours)(name)
    }

    /// Whether there is unfinished work in a directory.
    pub fn is_unfinished(path: &Path) -> bool {
        path.join(UNFINISHED).exists()
    }

    /// Removes the lock's file that a run which was killed as it ended has left beside its results.
    pub fn tidy(path: &Path) {
        drop(Lock::take(path)); // without the right to, it stays, and does no harm
    }

    /// What a person should know of the unfinished work that was found: damage to its journal.
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

    /// Teaches the journal the value of a point of the grid that was computed elsewhere.
    pub fn know(&mut self, point: usize, value: f64) {
        self.journal.learn_grid(point, value);
    }

    /// Begins the file `name`.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn file(&self, name: &str) -> Result<Pending, Error> {
        Pending::create(&self.unfinished.join(name))
    }

    /// Writes the whole file `name`.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, name: &str, text: &str) -> Result<(), Error> {
        let mut file = self.file(name)?;
        file.push(text)?;
        file.finish()
    }

    /// Writes `value` as the JSON file `name`.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write_json(&self, name: &str, value: &impl serde::Serialize) -> Result<(), Error> {
        self.write(name, &json_text(value, name)?)
    }

    /// The text of a file that was written before the work was interrupted.
    pub fn read(&self, name: &str) -> Option<String> {
        std::fs::read_to_string(self.unfinished.join(name)).ok()
    }

    /// The names of the results that are whole, sorted.
    ///
    /// # Errors
    /// The directory cannot be read.
    pub fn whole(&self) -> Result<Vec<String>, Error> {
        let mut names = names(&self.unfinished).map_err(|source| self.refused(source))?;
        names.retain(|name| name != JOURNAL && !name.ends_with(".item") && !name.starts_with('.'));
        Ok(names)
    }

    /// SHA-256 of each result that is whole, but for the manifest.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn new_files(&self) -> Result<BTreeMap<String, String>, Error> {
        let mut files = BTreeMap::new();
        for name in self.whole()?.into_iter().filter(|name| name != manifest::NAME) {
            let sha = manifest::file_sha256(&self.whole_path(&name))?;
            files.insert(name, sha);
        }
        Ok(files)
    }

    /// The path of a result that is whole but not yet in its place.
    pub fn whole_path(&self, name: &str) -> PathBuf {
        self.unfinished.join(name)
    }

    /// Puts the new results into the place of the earlier ones. They are on the disk before an earlier one goes; the journal stays
    /// until [`Self::finish`].
    ///
    /// # Errors
    /// Something stands in their place that may not be replaced, or a file cannot be written, moved or removed.
    pub fn publish(&self) -> Result<(), Error> {
        self.journal.check()?;
        let new = self.whole()?;
        if new.is_empty() {
            return Ok(()); // they are in their place already
        }
        // Someone may have put a file there since the work began.
        self.order
            .may_replace(&self.path, self.extent, &self.identity, |name| new.iter().any(|new| new == name))?;
        self.place(&new).map_err(|source| self.refused(source))
    }

    /// The manifest that stands there between says that the files of both are Retune's: the process may end at any moment.
    fn place(&self, new: &[String]) -> std::io::Result<()> {
        for name in new {
            File::open(self.unfinished.join(name))?.sync_all()?;
        }
        let old = Manifest::read(&self.path);
        let mut standing = names(&self.path)?;
        standing.retain(|name| old.as_ref().is_some_and(|old| old.has_made(&self.path, name)));
        if let Some(mut between) = Manifest::read(&self.unfinished) {
            for name in &standing {
                let sha = manifest::file_sha256(&self.path.join(name)).map_err(std::io::Error::other)?;
                between.earlier.insert(name.clone(), sha);
            }
            let write = || {
                let mut file = Pending::create(&self.path.join(manifest::NAME))?;
                file.push(&json_text(&between, manifest::NAME)?)?;
                file.finish_on_disk()
            };
            write().map_err(std::io::Error::other)?;
        }
        standing.retain(|name| self.replaces(name));
        if self.order.replace {
            let is_ours = |name: &String| {
                (self.is_ours)(name) && plain::is_there(&self.path.join(name)).unwrap_or(false)
            };
            standing.extend(names(&self.path)?.into_iter().filter(is_ours));
        }
        let gone: BTreeSet<String> = standing.into_iter().filter(|name| !new.contains(name)).collect();
        for name in gone {
            std::fs::remove_file(self.path.join(name))?;
        }
        if let Some(old) = old.filter(|_| self.extent == Extent::Whole) {
            self.remove_parts(&old.parts, false)?;
        }
        self.remove_parts(self.journal.parts(), true)?;
        self.remove_parts(&self.thrown_away, true)?;
        let (manifest, files): (Vec<&String>, Vec<&String>) =
            new.iter().partition(|name| *name == manifest::NAME);
        for name in files.into_iter().chain(manifest) {
            std::fs::rename(self.unfinished.join(name), self.path.join(name))?;
        }
        sync_directory(&self.path)
    }

    /// Removes what Retune made in directories below that are no part of the work any more.
    fn remove_parts(&self, earlier: &BTreeSet<String>, with_unfinished: bool) -> std::io::Result<()> {
        let now = self.parts();
        for name in earlier.difference(&now).filter(|name| order::is_below(name)) {
            unfinished::remove_results(&self.path.join(name), with_unfinished)?;
            let mut above = Path::new(name).parent();
            while let Some(name) = above.filter(|name| !name.as_os_str().is_empty()) {
                let _ = std::fs::remove_dir(self.path.join(name)); // it stays if anything else is in it
                above = name.parent();
            }
        }
        Ok(())
    }

    /// Puts the new results into place and removes what the work left behind.
    ///
    /// # Errors
    /// As [`Self::publish`].
    pub fn finish(self) -> Result<(), Error> {
        self.publish()?;
        unfinished::remove(&self.unfinished).map_err(|source| self.refused(source))
    }

    /// Throws the unfinished work away: it has come to an end that it would come to again. Earlier results stay.
    pub fn discard(self) {
        let _ = unfinished::remove(&self.unfinished); // what is left of it is cleared by the next run
    }

    fn refused(&self, source: std::io::Error) -> Error {
        Error::Output { path: self.path.clone(), source }
    }
}

impl Drop for Directory {
    /// Where nothing was computed there is nothing to go on with.
    fn drop(&mut self) {
        let began = |part: &String| self.path.join(part).join(UNFINISHED).exists();
        if self.journal.is_empty() && !self.parts().iter().any(began) {
            let _ = unfinished::remove(&self.unfinished); // an empty journal does no harm either
        }
    }
}

/// The names in a directory, sorted.
fn names(directory: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(directory)? {
        names.extend(entry?.file_name().into_string());
    }
    names.sort();
    Ok(names)
}

/// Waits until the names in a directory are on the disk.
#[cfg(unix)]
fn sync_directory(path: &Path) -> std::io::Result<()> {
    File::open(path)?.sync_all()
}

/// Elsewhere a directory cannot be waited for.
#[cfg(not(unix))]
fn sync_directory(_path: &Path) -> std::io::Result<()> {
    Ok(())
}
