//! What other records make of a design, in data and in words.

use super::verdict::or_none;
use super::walls::Found;
use crate::amount::Amount;
use retune_study::joined;
use serde::Serialize;

/// A design under other records.
#[derive(Clone, Debug, Serialize)]
pub struct Records {
    /// In words.
    words: String,
    each: Vec<UnderRecord>,
}

/// The value under a changed record.
#[derive(Clone, Debug, Serialize)]
pub struct UnderRecord {
    /// How it is changed.
    pub under: String,
    #[serde(flatten)]
    pub found: Found,
}

impl Records {
    /// Of a design with its own value.
    pub fn new(Amount { quantity, value, .. }: Amount, each: Vec<UnderRecord>) -> Self {
        let others = each.iter().map(|one| format!("{} {}", or_none(one.found.value, quantity), one.under));
        let others = joined(&others.collect::<Vec<_>>(), ", ");
        let words = format!("{} {}; {others}", quantity.name(), or_none(value, quantity));
        Self { words, each }
    }

    /// In words.
    pub fn words(&self) -> &str {
        &self.words
    }
}
