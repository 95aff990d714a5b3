//! What takes milliseconds to compute and is asked for again by every run.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Most values that are kept: a study has a few restitutions.
const MOST: usize = 64;

/// Values by a number, each computed once; from any thread.
#[derive(Debug)]
pub struct Kept<T>(Mutex<BTreeMap<u64, Arc<T>>>);

impl<T> Kept<T> {
    /// None yet.
    pub const fn new() -> Self {
        Self(Mutex::new(BTreeMap::new()))
    }

    /// The value for a number, which is made if it is not there. More than 64 are forgotten.
    pub fn of(&self, number: f64, make: impl FnOnce() -> T) -> Arc<T> {
        // A value is whole before it is kept, so that a panic elsewhere has left nothing half done.
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
