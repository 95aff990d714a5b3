//! A cache for values that take milliseconds to compute and that every run needs.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Maximum number of cached values: a study has a few restitutions.
const MOST: usize = 64;

/// Values cached by a number, each computed once; for use from any thread.
#[derive(Debug)]
pub struct Kept<T>(Mutex<BTreeMap<u64, Arc<T>>>);

impl<T> Kept<T> {
    /// An empty cache.
    pub const fn new() -> Self {
        Self(Mutex::new(BTreeMap::new()))
    }

    /// The value for a number, computed if it is not cached. A full cache is cleared.
    pub fn of(&self, number: f64, make: impl FnOnce() -> T) -> Arc<T> {
        // A value is complete before it is inserted, so a poisoned lock protects no partial state.
        let all = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(value) = all().get(&number.to_bits()) {
            return Arc::clone(value);
        }
        let value = Arc::new(make());
        let mut kept = all();
        if kept.len() >= MOST {
            kept.clear();
        }
        kept.insert(number.to_bits(), Arc::clone(&value));
        value
    }
}

impl<T> Default for Kept<T> {
    fn default() -> Self {
        Self::new()
    }
}
