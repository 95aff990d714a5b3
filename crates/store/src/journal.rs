//! The journal: every value of an objective that was computed, as it is computed, so that nothing of an interrupted run is
//! lost.
//!
//! Each search here is deterministic in the values of its objective. So a run that goes on begins anew, and the journal answers
//! what it knows: the run comes to where it was in a moment, and its results have the bytes of an unbroken one. No search
//! knows of it.
//!
//! A line is whole or it does not count: it ends with a checksum that holds for this work alone (see [`Seal`]). So every record that
//! is whole is believed, wherever it stands, and one that is not (a crash may leave half a line, a disk a flipped bit) is counted,
//! announced and computed again. Lines are handed to the system as they come, which a killed process cannot undo, and to the
//! disk about once a second.
//!
//! Values that are not finite (designs that cannot be computed) are written, but not answered: such a design is run again, so
//! that the search can say why it failed.

mod read;

pub use read::{Damage, Found, Known, MOST_POINTS, read};

use super::identity::{Identity, hexadecimal};
use super::plain;
use super::seal::Seal;
use crate::error::Error;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// The first words of a journal.
const TITLE: &str = "retune-journal-2";

/// Milliseconds between two times that the disk is waited for.
const SYNC_EVERY: u64 = 1000;

/// Half of a SHA-256: the stage, the design and the cutoff.
type Key = [u8; 16];

/// A journal that is being written.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    seal: Seal,
    known: Known,
    file: Mutex<File>,
    /// The same file, to wait for the disk without holding up those who write.
    disk: File,
    begun: Instant,
    synced: AtomicU64,
    written: AtomicBool,
    broken: AtomicBool,
    trouble: Mutex<Option<std::io::Error>>,
}

/// The text of the line of a point of the grid.
pub fn grid_text(point: usize, value: f64) -> String {
    format!("g {point} {:016x}", value.to_bits())
}

/// Reads [`grid_text`].
pub fn grid_value(text: &str) -> Option<(usize, f64)> {
    let (point, value) = text.strip_prefix("g ")?.split_once(' ')?;
    Some((point.parse().ok()?, bits(value)?))
}

fn bits(text: &str) -> Option<f64> {
    (text.len() == 16).then(|| u64::from_str_radix(text, 16).ok().map(f64::from_bits))?
}

fn key(stage: &str, design: &[f64], cutoff: f64) -> Key {
    let mut hash = Sha256::new();
    hash.update(stage.as_bytes());
    for number in std::iter::once(&cutoff).chain(design) {
        hash.update(number.to_bits().to_le_bytes());
    }
    let mut key = Key::default();
    key.copy_from_slice(&hash.finalize()[..16]);
    key
}

impl Journal {
    /// Begins a journal, of which nothing must stand there.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn begin(path: &Path, identity: &Identity) -> Result<Self, Error> {
        let made = OpenOptions::new().append(true).create_new(true).open(path);
        let refuse = |source| Error::Output { path: path.to_owned(), source };
        let mut file = made.map_err(refuse)?;
        file.write_all(read::first_line(identity).as_bytes()).map_err(refuse)?;
        Self::write_to(path, file, identity, Known::default())
    }

    /// Goes on with a journal, of which `known` was read. Where there is damage, what is whole is written anew first.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn go_on(path: &Path, identity: &Identity, known: Known, damage: Damage) -> Result<Self, Error> {
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
            trouble: Mutex::default(),
        })
    }

    /// Whether there is no line.
    pub fn is_empty(&self) -> bool {
        self.known.lines == 0 && !self.written.load(Relaxed)
    }

    /// How many lines were known from before.
    pub fn known(&self) -> u64 {
        self.known.lines
    }

    /// The directories below that searches of this work were begun in before.
    pub fn parts(&self) -> &BTreeSet<String> {
        &self.known.parts
    }

    /// Notes that a search is begun in a directory below.
    pub fn note_part(&self, name: &str) {
        if !self.known.parts.contains(name) {
            self.append(&format!("p {name}"));
        }
    }

    /// The value of an objective at `design`: known from before, which `recall` is told, or computed now and written down. `stage`
    /// names the objective; `cutoff` is what it may stop at.
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

    /// The same of a point of the grid, which is known by its number.
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
            // What cannot be kept need not be computed: the search comes to its end at once, and `check` says why.
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

    /// Learns the value of a point of the grid that was computed elsewhere.
    pub fn learn_grid(&mut self, point: usize, value: f64) {
        if self.known.grid.get(point).is_none_or(|value| value.is_nan())
            && self.known.set_grid(point, value).is_some()
        {
            self.known.lines += 1;
            self.write(&grid_text(point, value));
        }
    }

    /// Whether a part of the work named `name` is done.
    pub fn is_marked(&self, name: &str) -> bool {
        self.known.marks.contains(name)
    }

    /// Notes that a part of the work named `name` is done.
    pub fn mark(&self, name: &str) {
        self.write(&format!("m {name}"));
    }

    /// Whether all could be written so far. Must be asked before anything that a search found is believed.
    ///
    /// # Errors
    /// The journal cannot be written, for instance because the disk is full.
    pub fn check(&self) -> Result<(), Error> {
        match &*self.trouble.lock().unwrap_or_else(PoisonError::into_inner) {
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

    /// Writes down a result.
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
        let mine = due && self.synced.compare_exchange(last, now, Relaxed, Relaxed).is_ok();
        let synced = written.and_then(|()| if mine { self.disk.sync_data() } else { Ok(()) });
        if let Err(source) = synced {
            self.broken.store(true, Relaxed);
            self.trouble.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(source);
        }
    }
}

#[cfg(test)]
mod tests;
