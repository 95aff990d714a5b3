//! Files of results as text and as JSON.

use crate::Error;
use serde_json::Value;
use std::path::Path;

/// The text of a file of results.
///
/// # Errors
/// It cannot be read.
pub fn text(place: &Path, name: &str) -> Result<String, Error> {
    let path = place.join(name);
    Ok(retune_store::plain::text(&path).map_err(|source| retune_store::Error::Input { path, source })?)
}

/// A JSON file of results.
///
/// # Errors
/// It cannot be read, or is not JSON.
pub fn json(place: &Path, name: &str) -> Result<Value, Error> {
    let refuse = |error: serde_json::Error| retune_store::Error::Input {
        path: place.join(name),
        source: error.into(),
    };
    Ok(serde_json::from_str(&text(place, name)?).map_err(refuse)?)
}
