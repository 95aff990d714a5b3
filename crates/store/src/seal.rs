//! A line with a checksum: whole, or it does not count. A line of a work holds under the seal of that work alone, so lines of two
//! works cannot be taken for each other, whatever becomes of the file that they stand in.

use super::identity::{Identity, hexadecimal};
use sha2::{Digest, Sha256};

/// What checksums begin with.
#[derive(Clone, Debug)]
pub struct Seal(Sha256);

impl Seal {
    /// Of a line that says itself what it belongs to, or of a file that is checked as a whole.
    pub fn plain() -> Self {
        Self(Sha256::new())
    }

    /// Of the lines of a work.
    pub fn of(identity: &Identity) -> Self {
        Self(Sha256::new_with_prefix(identity.words()))
    }

    /// `text` as a line, with its end.
    pub fn close(&self, text: &str) -> String {
        format!("{text} {}\n", self.checksum(text))
    }

    /// The text of a line; none if it is not whole, or not under this seal.
    pub fn open<'a>(&self, line: &'a [u8]) -> Option<&'a str> {
        let line = std::str::from_utf8(line.strip_suffix(b"\n")?).ok()?;
        let (text, check) = line.rsplit_once(' ')?;
        (check == self.checksum(text)).then_some(text)
    }

    fn checksum(&self, text: &str) -> String {
        hexadecimal(&self.0.clone().chain_update(text).finalize()[..4])
    }
}
