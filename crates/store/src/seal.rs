//! Lines with a checksum. The checksum of a line depends on the work that it belongs to, so lines of different works cannot be
//! confused, even if their files are.

use super::identity::{Identity, hexadecimal};
use sha2::{Digest, Sha256};

/// The state from which the checksums of a work's lines are computed.
#[derive(Clone, Debug)]
pub struct Seal(Sha256);

impl Seal {
    /// For lines that name their work themselves, and for files that are checked as a whole.
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
