//! Reading a journal, damaged or not: complete records are kept, damaged ones counted.

use super::record::{Key, Seal, bits, grid_value};
use crate::error::Error;
use crate::identity::Identity;
use crate::pending::Pending;
use crate::plain;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::Path;

/// The first words of a journal.
const TITLE: &str = "retune-journal-2";

/// Longest valid line, bytes.
const LONGEST: usize = 1024;

/// Most grid points that a journal holds.
pub const MOST_POINTS: usize = 10_000_000;

/// The contents of a journal.
#[derive(Debug, Default)]
pub struct Known {
    pub(super) values: HashMap<Key, f64>,
    /// The values of the grid points; NaN where not known.
    pub(super) grid: Vec<f64>,
    pub(super) marks: HashSet<String>,
    /// The subdirectories in which the work began searches.
    pub parts: BTreeSet<String>,
    /// Number of its values and marks.
    pub lines: u64,
}

/// Damage to a journal that can still be continued.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Damage {
    /// Whether the first line, which identifies the work, is damaged.
    pub head: bool,
    /// Number of damaged lines.
    pub lines: u64,
}

impl Damage {
    /// Whether there is none.
    pub fn is_none(self) -> bool {
        self == Self::default()
    }
}

/// The state of a journal's file.
#[derive(Debug)]
pub enum State {
    /// No file, or an empty one.
    Nothing,
    /// The work cannot be identified, for this reason.
    Unclear(&'static str),
    /// The journal of a work: its identity, its contents and its damage.
    Work(Identity, Box<Known>, Damage),
}

/// Reads a journal. If its first line is damaged, its records tell whether it belongs to the work `identity`.
pub fn read(path: &Path, identity: &Identity) -> std::io::Result<State> {
    let mut lines = BufReader::new(match plain::open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(State::Nothing),
        other => other?,
    });
    let mut line = Vec::new();
    if !next(&mut lines, &mut line)? {
        return Ok(State::Nothing);
    }
    let head = head(&line);
    let of = head.clone().unwrap_or_else(|| identity.clone());
    let seal = Seal::of(&of);
    let mut known = Known::default();
    let mut damage = Damage { head: head.is_none(), lines: 0 };
    if head.is_none() {
        // If its beginning is lost, the first line is a record or part of one.
        seal.open(&line).and_then(|text| known.add_record(text));
    }
    while next(&mut lines, &mut line)? {
        if seal.open(&line).and_then(|text| known.add_record(text)).is_some() {
            continue;
        }
        match self::head(&line) {
            Some(other) if damage.head || other != of => {
                return Ok(State::Unclear("it holds the work of two studies, one after the other"));
            }
            Some(_) => {}
            None => damage.lines += 1,
        }
    }
    if damage.head && known.lines == 0 && known.parts.is_empty() {
        return Ok(State::Unclear(
            "its first line, which says whose work it is, is damaged or of another version, and no record in it is of this study",
        ));
    }
    Ok(State::Work(of, Box::new(known), damage))
}

/// Rewrites a damaged journal with a new first line and every complete record. The old file stays until the new one is complete.
pub fn mend(path: &Path, identity: &Identity) -> Result<(), Error> {
    let refuse = |source| Error::Output { path: path.to_owned(), source };
    let mut lines = BufReader::new(plain::open(path).map_err(refuse)?);
    let seal = Seal::of(identity);
    let mut mended = Pending::create(path)?;
    mended.push(&first_line(identity))?;
    let mut line = Vec::new();
    while next(&mut lines, &mut line).map_err(refuse)? {
        if let Some(text) = seal.open(&line) {
            mended.push(&seal.close(text))?;
        }
    }
    mended.finish_on_disk()
}

/// The first line of the journal of a work.
pub fn first_line(identity: &Identity) -> String {
    Seal::plain().close(&format!("{TITLE} {}", identity.words()))
}

fn head(line: &[u8]) -> Option<Identity> {
    Identity::parse(Seal::plain().open(line)?.strip_prefix(TITLE)?.strip_prefix(' ')?)
}

/// Reads the next line with its line end; only the beginning of one that is too long. False at the end of the file.
fn next(file: &mut impl BufRead, line: &mut Vec<u8>) -> std::io::Result<bool> {
    line.clear();
    loop {
        let there = match file.fill_buf() {
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            other => other?,
        };
        let end = there.iter().position(|byte| *byte == b'\n').map(|at| at + 1);
        let length = end.unwrap_or(there.len());
        line.extend_from_slice(&there[..length.min(LONGEST.saturating_sub(line.len()))]);
        file.consume(length);
        if end.is_some() || length == 0 {
            return Ok(!line.is_empty());
        }
    }
}

impl Known {
    fn add_record(&mut self, text: &str) -> Option<()> {
        let (kind, rest) = text.split_once(' ')?;
        let is_new = match kind {
            "g" => {
                let (point, value) = grid_value(text)?;
                self.set_grid(point, value)?
            }
            "e" => {
                let (name, value) = rest.split_once(' ')?;
                let number = (name.len() == 32).then(|| u128::from_str_radix(name, 16).ok())??;
                self.values.insert(number.to_be_bytes(), bits(value)?).is_none()
            }
            "m" => self.marks.insert(rest.to_owned()),
            "p" => {
                self.parts.insert(rest.to_owned());
                false
            }
            _ => return None,
        };
        self.lines += u64::from(is_new);
        Some(())
    }

    /// Sets the value of a grid point; returns whether it was unknown. None if the index is out of range.
    pub(super) fn set_grid(&mut self, point: usize, value: f64) -> Option<bool> {
        if point >= self.grid.len() {
            (point < MOST_POINTS).then(|| self.grid.resize(point + 1, f64::NAN))?;
        }
        Some(std::mem::replace(&mut self.grid[point], value).is_nan())
    }
}
