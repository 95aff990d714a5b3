//! The journal: every value of an objective that was computed, as it is computed, so that nothing of an interrupted run is
//! lost.
//!
//! Each search here is deterministic in the values of its objective. So a run that goes on begins anew, and the journal answers
//! what it knows: the run comes to where it was in a moment, and its results have the bytes of an unbroken one. No search
//! knows of it.
//!
//! A line is whole or it does not count: it ends with a checksum, and what follows the first that is broken (a crash may leave
//! half a line, a power cut more) is cut off and computed again. Lines are handed to the system as they come, which a killed
//! process cannot undo, and to the disk about once a second.
//!
//! Values that are not finite (designs that cannot be computed) are written, but not answered: such a design is run again, so
//! that the search can say why it failed.

use super::identity::{Identity, hexadecimal};
use crate::error::Error;
use crate::study::MOST_GRID_POINTS;
use sha2::{Digest, Sha256};
use std::collections::{HashMap, HashSet};
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// The first words of a journal.
const TITLE: &str = "retune-journal-1";

/// Milliseconds between two times that the disk is waited for.
const SYNC_EVERY: u64 = 1000;

/// Half of a SHA-256: the stage, the design and the cutoff.
type Key = [u8; 16];

/// What a journal knows.
#[derive(Debug, Default)]
pub struct Known {
    values: HashMap<Key, f64>,
    /// The values of the points of the grid; NaN where one is not known.
    grid: Vec<f64>,
    marks: HashSet<String>,
    /// How many lines there are.
    pub lines: u64,
}

/// A journal that is being written.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
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

/// Reads a journal: what made it, what it knows, and how many of its bytes are whole. None if it has no first line.
///
/// # Errors
/// It cannot be read.
pub fn read(path: &Path) -> std::io::Result<Option<(Identity, Known, u64)>> {
    let mut lines = BufReader::new(match File::open(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        other => other?,
    });
    let mut line = Vec::new();
    lines.read_until(b'\n', &mut line)?;
    let first = whole(&line).and_then(|text| text.strip_prefix(TITLE)?.strip_prefix(' '));
    let Some(identity) = first.and_then(Identity::parse) else { return Ok(None) };
    let mut known = Known::default();
    let mut length = line.len() as u64;
    loop {
        line.clear();
        lines.read_until(b'\n', &mut line)?;
        match whole(&line).and_then(|text| known.learn(text)) {
            Some(()) => length += line.len() as u64,
            None => return Ok(Some((identity, known, length))),
        }
    }
}

/// A line without its checksum; none if it is not whole.
pub fn whole(line: &[u8]) -> Option<&str> {
    let line = std::str::from_utf8(line.strip_suffix(b"\n")?).ok()?;
    let (text, check) = line.rsplit_once(' ')?;
    (check == checksum(text)).then_some(text)
}

/// A line with its checksum.
pub fn sealed(text: &str) -> String {
    format!("{text} {}\n", checksum(text))
}

/// The line of a point of the grid.
pub fn grid_line(point: usize, value: f64) -> String {
    sealed(&format!("g {point} {:016x}", value.to_bits()))
}

/// Reads the text of [`grid_line`].
pub fn grid_value(text: &str) -> Option<(usize, f64)> {
    let (point, value) = text.strip_prefix("g ")?.split_once(' ')?;
    Some((point.parse().ok()?, bits(value)?))
}

fn checksum(text: &str) -> String {
    hexadecimal(&Sha256::digest(text.as_bytes())[..4])
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

impl Known {
    fn learn(&mut self, text: &str) -> Option<()> {
        let (kind, rest) = text.split_once(' ')?;
        match kind {
            "g" => {
                let (point, value) = grid_value(text)?;
                self.set_grid(point, value)?;
            }
            "e" => {
                let (name, value) = rest.split_once(' ')?;
                let number = (name.len() == 32).then(|| u128::from_str_radix(name, 16).ok())??;
                self.values.insert(number.to_be_bytes(), bits(value)?);
            }
            "m" => {
                self.marks.insert(rest.to_owned());
            }
            _ => return None,
        }
        self.lines += 1;
        Some(())
    }

    fn set_grid(&mut self, point: usize, value: f64) -> Option<()> {
        if point >= self.grid.len() {
            (point < MOST_GRID_POINTS).then(|| self.grid.resize(point + 1, f64::NAN))?;
        }
        self.grid[point] = value;
        Some(())
    }
}

impl Journal {
    /// Begins a journal, or goes on with one of which the first `length` bytes are whole.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn open(path: &Path, identity: &Identity, known: Known, length: u64) -> Result<Self, Error> {
        let refuse = |source| Error::Output { path: path.to_owned(), source };
        let mut options = OpenOptions::new();
        let mut file =
            options.create(true).truncate(false).read(true).write(true).open(path).map_err(refuse)?;
        file.set_len(length).and_then(|()| file.seek(SeekFrom::Start(length)).map(drop)).map_err(refuse)?;
        if length == 0 {
            file.write_all(sealed(&format!("{TITLE} {}", identity.words())).as_bytes()).map_err(refuse)?;
        }
        let disk = file.try_clone().map_err(refuse)?;
        Ok(Self {
            path: path.to_owned(),
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
            sealed(&format!("e {} {:016x}", hexadecimal(&key), value.to_bits()))
        })
    }

    /// The same of a point of the grid, which is known by its number.
    pub fn grid_value(&self, point: usize, compute: impl FnOnce() -> f64, recall: impl FnOnce(f64)) -> f64 {
        self.answer(self.known.grid.get(point).copied(), compute, recall, |value| grid_line(point, value))
    }

    fn answer(
        &self,
        known: Option<f64>,
        compute: impl FnOnce() -> f64,
        recall: impl FnOnce(f64),
        line: impl FnOnce(f64) -> String,
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
                    self.append(&line(value));
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
            self.append(&grid_line(point, value));
        }
    }

    /// Whether a part of the work named `name` is done.
    pub fn is_marked(&self, name: &str) -> bool {
        self.known.marks.contains(name)
    }

    /// Notes that a part of the work named `name` is done.
    pub fn mark(&self, name: &str) {
        self.append(&sealed(&format!("m {name}")));
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

    fn append(&self, line: &str) {
        self.written.store(true, Relaxed);
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
