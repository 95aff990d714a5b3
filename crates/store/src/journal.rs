//! The journal: every computed value of an objective is recorded at once, so that an interrupted run loses nothing.
//!
//! Each search is deterministic, given the values of its objective. A resumed run therefore starts from the beginning and takes
//! known values from the journal: it reaches the point of interruption at once, and its results are identical to the byte to those
//! of an uninterrupted run. The searches themselves need not know of the journal.
//!
//! Each line ends with a checksum that is valid for this work alone (see [`Seal`]). A line with a valid checksum is used wherever it
//! stands; any other (half a line after a crash, a flipped bit) is counted, reported and computed again. Lines are passed to the
//! operating system at once, so they survive the process, and synced to disk about once a second.
//!
//! Non-finite values (designs that cannot be computed) are written but not recalled: such a design is run again, so that the search
//! can report why it failed.

mod read;
mod record;

pub use read::{Damage, Known, MOST_POINTS, State, read};
pub use record::{Seal, grid_text, grid_value};

use crate::error::Error;
use crate::identity::{Identity, hexadecimal};
use crate::plain;
use record::key;
use std::collections::BTreeSet;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Time between two syncs to disk, ms.
const SYNC_EVERY: u64 = 1000;

/// A journal that is being written.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    seal: Seal,
    known: Known,
    file: Mutex<File>,
    /// A second handle to the same file, to sync it without blocking writers.
    disk: File,
    begun: Instant,
    synced: AtomicU64,
    written: AtomicBool,
    broken: AtomicBool,
    first_error: Mutex<Option<std::io::Error>>,
}

impl Journal {
    /// Creates a journal; there must be none yet.
    pub fn begin(path: &Path, identity: &Identity) -> Result<Self, Error> {
        let made = OpenOptions::new().append(true).create_new(true).open(path);
        let refuse = |source| Error::Output { path: path.to_owned(), source };
        let mut file = made.map_err(refuse)?;
        file.write_all(read::first_line(identity).as_bytes()).map_err(refuse)?;
        Self::write_to(path, file, identity, Known::default())
    }

    /// Continues a journal from which `known` was read. A damaged one is first replaced by its complete records.
    pub fn resume(path: &Path, identity: &Identity, known: Known, damage: Damage) -> Result<Self, Error> {
        if !damage.is_none() {
            read::mend(path, identity)?;
        }
        let file = plain::open_with(path, OpenOptions::new().append(true));
        let file = file.map_err(|source| Error::Output { path: path.to_owned(), source })?;
        Self::write_to(path, file, identity, known)
    }

    fn write_to(path: &Path, file: File, identity: &Identity, known: Known) -> Result<Self, Error> {
        let disk = file.try_clone().map_err(|source| Error::Output { path: path.to_owned(), source })?;
        Ok(Self {
            path: path.to_owned(),
            seal: Seal::of(identity),
            known,
            file: Mutex::new(file),
            disk,
            begun: Instant::now(),
            synced: AtomicU64::new(0),
            written: AtomicBool::new(false),
            broken: AtomicBool::new(false),
            first_error: Mutex::default(),
        })
    }

    /// Whether it holds no value and no mark.
    pub fn is_empty(&self) -> bool {
        self.known.lines == 0 && !self.written.load(Relaxed)
    }

    /// Number of values and marks from earlier runs.
    pub fn known(&self) -> u64 {
        self.known.lines
    }

    /// The subdirectories in which earlier runs of this work began searches.
    pub fn parts(&self) -> &BTreeSet<String> {
        &self.known.parts
    }

    /// Records that a search begins in a subdirectory.
    pub fn note_part(&self, name: &str) {
        if !self.known.parts.contains(name) {
            self.append(&format!("p {name}"));
        }
    }

    /// The value of an objective at `design`: taken from the journal and passed to `recall`, or computed and recorded. `stage` names
    /// the objective; `cutoff` is the value at which its evaluation may stop.
    pub fn value(
        &self,
        stage: &str,
        design: &[f64],
        cutoff: f64,
        compute: impl FnOnce() -> f64,
        recall: impl FnOnce(f64),
    ) -> f64 {
        let key = key(stage, design, cutoff);
        self.answer(self.known.values.get(&key).copied(), compute, recall, |value| {
            format!("e {} {:016x}", hexadecimal(&key), value.to_bits())
        })
    }

    /// Like [`Self::value`], for a grid point identified by its number.
    pub fn grid_value(&self, point: usize, compute: impl FnOnce() -> f64, recall: impl FnOnce(f64)) -> f64 {
        self.answer(self.known.grid.get(point).copied(), compute, recall, |value| grid_text(point, value))
    }

    fn answer(
        &self,
        known: Option<f64>,
        compute: impl FnOnce() -> f64,
        recall: impl FnOnce(f64),
        text: impl FnOnce(f64) -> String,
    ) -> f64 {
        match known {
            Some(value) if value.is_finite() => {
                recall(value);
                value
            }
            // If values cannot be recorded, none are computed: the search ends at once, and `check` reports why.
            _ if self.broken.load(Relaxed) => f64::INFINITY,
            known => {
                let value = compute();
                if known.is_none_or(f64::is_nan) {
                    self.write(&text(value));
                }
                value
            }
        }
    }

    /// Records the value of a grid point that was computed elsewhere.
    pub fn record_grid_value(&mut self, point: usize, value: f64) {
        if self.known.grid.get(point).is_none_or(|value| value.is_nan())
            && self.known.set_grid(point, value).is_some()
        {
            self.known.lines += 1;
            self.write(&grid_text(point, value));
        }
    }

    /// Whether the part `name` of the work is done.
    pub fn is_marked(&self, name: &str) -> bool {
        self.known.marks.contains(name)
    }

    /// Records that the part `name` of the work is done.
    pub fn mark(&self, name: &str) {
        self.write(&format!("m {name}"));
    }

    /// Checks that everything could be written so far. Call it before using the result of a search.
    ///
    /// # Errors
    /// The journal cannot be written, for instance because the disk is full.
    pub fn check(&self) -> Result<(), Error> {
        match &*self.first_error.lock().unwrap_or_else(PoisonError::into_inner) {
            None => Ok(()),
            Some(source) => Err(Error::Output {
                path: self.path.clone(),
                source: std::io::Error::new(source.kind(), source.to_string()),
            }),
        }
    }

    /// Whether a line could not be written.
    pub fn is_broken(&self) -> bool {
        self.broken.load(Relaxed)
    }

    /// Appends a result.
    fn write(&self, text: &str) {
        self.written.store(true, Relaxed);
        self.append(text);
    }

    fn append(&self, text: &str) {
        let line = self.seal.close(text);
        let written = {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            file.write_all(line.as_bytes())
        };
        let now = self.begun.elapsed().as_millis() as u64;
        let last = self.synced.load(Relaxed);
        let due = now >= last + SYNC_EVERY;
        let claimed = due && self.synced.compare_exchange(last, now, Relaxed, Relaxed).is_ok();
        let synced = written.and_then(|()| if claimed { self.disk.sync_data() } else { Ok(()) });
        if let Err(source) = synced {
            self.broken.store(true, Relaxed);
            self.first_error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(source);
        }
    }
}

#[cfg(test)]
mod tests;
