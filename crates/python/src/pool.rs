//! The threads that an evaluation may use: a pool of this process, never rayon's own.
//!
//! `multiprocessing` forks: a child inherits the memory of its parent and none of its threads, so that a pool of the parent would be
//! waited for forever. A pool is therefore known by the process that made it.

use crate::errors::Fault;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Arc, Mutex, PoisonError};

/// Most threads that may be asked for.
pub const MOST_THREADS: u16 = 1024;

static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// A pool of this many threads, by default one a core.
///
/// # Errors
/// Their number is not allowed, or they cannot be started.
pub fn pool(threads: Option<i64>) -> Result<Arc<ThreadPool>, Fault> {
    if let Some(threads) = threads {
        return made(check(threads)?);
    }
    let mut kept = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some((_, pool)) = kept.as_ref().filter(|(own, _)| *own == process) {
        return Ok(Arc::clone(pool));
    }
    let pool = made(0)?;
    // The threads of a parent cannot be waited for.
    std::mem::forget(kept.replace((process, Arc::clone(&pool))));
    Ok(pool)
}

/// A number of threads that may be asked for.
///
/// # Errors
/// [`Fault::Study`].
pub fn check(threads: i64) -> Result<u16, Fault> {
    match u16::try_from(threads) {
        Ok(threads @ 1..=MOST_THREADS) => Ok(threads),
        _ => {
            let allowed = "a whole number from 1 to 1024, or None for all cores";
            Err(Fault::argument("threads", threads as f64, allowed))
        }
    }
}

fn made(threads: u16) -> Result<Arc<ThreadPool>, Fault> {
    let pool = ThreadPoolBuilder::new().num_threads(threads.into()).build();
    pool.map(Arc::new).map_err(|error| Fault::Other(format!("cannot start the threads: {error}")))
}
