//! The identity of a result: the study to the last digit, the version of Retune, and the arithmetic of the machine.

use crate::error::Error;
use sha2::{Digest, Sha256};
use std::hint::black_box;

/// The version of this program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Identifies a result: two runs of the same identity give the same bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// SHA-256 of the resolved study, the bytes of `study.json`, in hexadecimal.
    pub study: String,
    /// The version of Retune.
    pub version: String,
    /// A checksum of the machine's sines and powers; see [`arithmetic`].
    pub arithmetic: String,
}

impl Identity {
    /// The identity of the work that is described by `text`.
    pub fn of(text: &str) -> Self {
        Self { study: sha256(text.as_bytes()), version: VERSION.to_owned(), arithmetic: arithmetic() }
    }

    /// As the text of a header.
    pub fn words(&self) -> String {
        format!("study={} version={} arithmetic={}", self.study, self.version, self.arithmetic)
    }

    /// Reads [`Self::words`].
    pub fn parse(words: &str) -> Option<Self> {
        let mut fields = words.split(' ');
        let mut field = |name: &str| fields.next()?.strip_prefix(name).map(str::to_owned);
        let (study, version, arithmetic) = (field("study=")?, field("version=")?, field("arithmetic=")?);
        fields.next().is_none().then_some(Self { study, version, arithmetic })
    }

    /// Describes how `other` differs; none if it does not.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let short = |hash: &str| hash.chars().take(12).collect::<String>();
        if self.study != other.study {
            Some(format!(
                "of another study (SHA-256 {}..., this one {}...)",
                short(&other.study),
                short(&self.study)
            ))
        } else if self.version != other.version {
            Some(format!("of Retune {}, this is {}", other.version, self.version))
        } else if self.arithmetic != other.arithmetic {
            Some(format!(
                "of a machine whose sines or powers differ in their last bits ({}, here {})",
                other.arithmetic, self.arithmetic
            ))
        } else {
            None
        }
    }
}

/// `value` as the text of a JSON file; numbers that are not finite become null.
pub fn json_text(value: &impl serde::Serialize, name: &str) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Error::Output { path: name.into(), source: error.into() })?;
    Ok(text + "\n")
}

/// SHA-256 in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// Bytes in hexadecimal.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A checksum of this machine's sine, cosine and power functions. They are rounded differently on different systems, and an
/// impacting motion may depend on the last bit: machines whose checksums differ must not share a result.
fn arithmetic() -> String {
    let mut hash = Sha256::new();
    for i in 0..1024 {
        let x = black_box(f64::from(i) * 0.613 + 1e-3);
        let (sin, cos) = x.sin_cos();
        for value in [sin, cos, x.powf(1.5), x.powf(-0.125), x.hypot(1.7), x.log10(), 10f64.powf(sin)] {
            hash.update(value.to_bits().to_le_bytes());
        }
    }
    hexadecimal(&hash.finalize()[..4])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_sha256_of_the_standards_example() {
        assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn contract_an_identity_is_read_as_it_was_written() {
        let identity = Identity::of("a study");
        assert_eq!(Identity::parse(&identity.words()).as_ref(), Some(&identity));
        assert_eq!(identity.difference(&identity), None);
        assert_eq!(Identity::parse("study=1 version=2"), None);
        let other = Identity::of("another study");
        assert!(identity.difference(&other).is_some_and(|words| words.starts_with("of another study")));
        assert_eq!(arithmetic(), arithmetic());
    }
}
