//! The records of a journal: their keys, and the text of a value of the grid.

use sha2::{Digest, Sha256};

/// Half of a SHA-256: the stage, the design and the cutoff.
pub type Key = [u8; 16];

/// The text of the line of a point of the grid.
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
