//! Results on disk. New results come about in a directory of their own, `unfinished`, inside that of the results; only when all
//! are whole do they take the place of the earlier ones. What a run computed on the way is in its [`Journal`] there, so a run
//! that was stopped, killed or cut off can go on.

pub mod identity;
pub mod journal;
mod lock;
pub mod manifest;
mod pending;
pub mod resolved;

pub use identity::{Identity, json_text};
pub use journal::Journal;
pub use pending::Pending;

use crate::error::Error;
use crate::interrupt;
use journal::Known;
use lock::Lock;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Where new results come about.
pub const UNFINISHED: &str = "unfinished";

/// The journal, in [`UNFINISHED`].
const JOURNAL: &str = "journal";

/// What becomes of unfinished work that is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Begin {
    /// Nothing: it is announced, and the run refused.
    #[default]
    New,
    /// The run goes on with it.
    Resume,
    /// It is thrown away.
    Restart,
}

/// A directory of results while they are made. One process at a time has it.
pub struct Directory {
    path: PathBuf,
    unfinished: PathBuf,
    journal: Journal,
    is_ours: Box<dyn Fn(&str) -> bool + Send + Sync>,
    _lock: Lock,
}

impl Directory {
    /// Opens the directory, made if there is none, for a work of this identity. Of an earlier work, the files that `is_ours`
    /// names stay until the new ones are whole, and then go: results of two studies must not stand side by side.
    ///
    /// # Errors
    /// The directory cannot be made or written to; another process has it; or there is unfinished work of another study in it, or
    /// any if `begin` does not say what becomes of it.
    pub fn open(
        path: &Path,
        begin: Begin,
        identity: &Identity,
        is_ours: impl Fn(&str) -> bool + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        let refuse = |source| Error::Output { path: path.to_owned(), source };
        std::fs::create_dir_all(path).map_err(refuse)?;
        let lock = Lock::take(path)?;
        let unfinished = path.join(UNFINISHED);
        let found = journal::read(&unfinished.join(JOURNAL)).map_err(refuse)?;
        let (known, length) = match found {
            Some((of, known, length)) if begin != Begin::Restart && known.lines > 0 => {
                let difference = identity.difference(&of);
                if begin == Begin::New || difference.is_some() {
                    let lines = known.lines;
                    return Err(Error::Unfinished { path: path.to_owned(), lines, difference });
                }
                (known, length)
            }
            _ => (Known::default(), 0),
        };
        let keep = |name: &str| length > 0 && (name == JOURNAL || name.ends_with(".item"));
        clear(&unfinished, keep).map_err(refuse)?;
        std::fs::create_dir_all(&unfinished).map_err(refuse)?;
        let journal = Journal::open(&unfinished.join(JOURNAL), identity, known, length)?;
        // The names of the journal and its directory must outlive a power cut as well.
        sync_directory(&unfinished).and_then(|()| sync_directory(path)).map_err(refuse)?;
        interrupt::say_how_to_go_on();
        Ok(Self { path: path.to_owned(), unfinished, journal, is_ours: Box::new(is_ours), _lock: lock })
    }

    /// Whether there is unfinished work in a directory.
    pub fn is_unfinished(path: &Path) -> bool {
        path.join(UNFINISHED).exists()
    }

    /// Removes the lock's file that a run which was killed as it ended has left beside its results.
    pub fn tidy(path: &Path) {
        drop(Lock::take(path)); // without the right to, it stays, and does no harm
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

    /// The path of a result that is whole but not yet in its place.
    pub fn whole_path(&self, name: &str) -> PathBuf {
        self.unfinished.join(name)
    }

    /// Puts the new results into the place of the earlier ones. They are on the disk before an earlier one goes; the journal stays
    /// until [`Self::finish`].
    ///
    /// # Errors
    /// A file cannot be written, moved or removed.
    pub fn publish(&self) -> Result<(), Error> {
        self.journal.check()?;
        let new = self.whole()?;
        if new.is_empty() {
            return Ok(()); // they are in their place already
        }
        let place = || -> std::io::Result<()> {
            for name in &new {
                File::open(self.unfinished.join(name))?.sync_all()?;
            }
            for name in names(&self.path)? {
                if (self.is_ours)(&name) && !new.contains(&name) {
                    std::fs::remove_file(self.path.join(&name))?;
                }
            }
            for name in &new {
                std::fs::rename(self.unfinished.join(name), self.path.join(name))?;
            }
            sync_directory(&self.path)
        };
        place().map_err(|source| self.refused(source))
    }

    /// Puts the new results into place and removes what the work left behind.
    ///
    /// # Errors
    /// As [`Self::publish`].
    pub fn finish(self) -> Result<(), Error> {
        self.publish()?;
        std::fs::remove_dir_all(&self.unfinished).map_err(|source| self.refused(source))
    }

    /// Throws the unfinished work away: it has come to an end that it would come to again. Earlier results stay.
    pub fn discard(self) {
        let _ = std::fs::remove_dir_all(&self.unfinished); // what is left of it is cleared by the next run
    }

    fn refused(&self, source: std::io::Error) -> Error {
        Error::Output { path: self.path.clone(), source }
    }
}

impl Drop for Directory {
    /// Where nothing was computed there is nothing to go on with.
    fn drop(&mut self) {
        if self.journal.is_empty() {
            let _ = std::fs::remove_dir_all(&self.unfinished); // an empty journal does no harm either
        }
    }
}

/// Removes everything in a directory but what is to be kept.
fn clear(directory: &Path, keep: impl Fn(&str) -> bool) -> std::io::Result<()> {
    if !directory.exists() {
        return Ok(());
    }
    for name in names(directory)?.iter().filter(|name| !keep(name)) {
        std::fs::remove_file(directory.join(name))?;
    }
    Ok(())
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
