//! The records of a journal: their keys, and the text of a value of the grid.

use crate::identity::{Identity, hexadecimal};
use sha2::{Digest, Sha256};

/// Half of the SHA-256 of stage, design and cutoff.
pub type Key = [u8; 16];

/// The text of a grid point's line.
pub fn grid_text(point: usize, value: f64) -> String {
    format!("g {point} {:016x}", value.to_bits())
}

/// Reads [`grid_text`].
pub fn grid_value(text: &str) -> Option<(usize, f64)> {
    let (point, value) = text.strip_prefix("g ")?.split_once(' ')?;
    Some((point.parse().ok()?, bits(value)?))
}

/// Reads the sixteen hexadecimal digits of a number.
pub fn bits(text: &str) -> Option<f64> {
    (text.len() == 16).then(|| u64::from_str_radix(text, 16).ok().map(f64::from_bits))?
}

/// The key of the value of the objective `stage` at `design`, computed with `cutoff`.
pub fn key(stage: &str, design: &[f64], cutoff: f64) -> Key {
    let mut hash = Sha256::new();
    hash.update(stage.as_bytes());
    for number in std::iter::once(&cutoff).chain(design) {
        hash.update(number.to_bits().to_le_bytes());
    }
    let mut key = Key::default();
    key.copy_from_slice(&hash.finalize()[..16]);
    key
}

/// The state from which the checksums of a work's lines are computed.
#[derive(Clone, Debug)]
pub struct Seal(Sha256);

impl Seal {
    /// For lines that identify their work themselves, and for files that are checked as a whole.
    pub fn plain() -> Self {
        Self(Sha256::new())
    }

    /// For the lines of a work.
    pub fn of(identity: &Identity) -> Self {
        Self(Sha256::new_with_prefix(identity.words()))
    }

    /// `text` as a line, with its end.
    pub fn close(&self, text: &str) -> String {
        format!("{text} {}\n", self.checksum(text))
    }

    /// The text of a line; none if it is damaged or of another work.
    pub fn open<'a>(&self, line: &'a [u8]) -> Option<&'a str> {
        let line = std::str::from_utf8(line.strip_suffix(b"\n")?).ok()?;
        let (text, check) = line.rsplit_once(' ')?;
        (check == self.checksum(text)).then_some(text)
    }

    fn checksum(&self, text: &str) -> String {
        hexadecimal(&self.0.clone().chain_update(text).finalize()[..4])
    }
}
