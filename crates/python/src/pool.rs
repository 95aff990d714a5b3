//! The threads that an evaluation may use: a pool of this process, never rayon's own.
//!
//! `multiprocessing` may fork: a child inherits the memory of its parent but none of its threads, so that it would wait for the
//! parent's pool forever. Pools are therefore stored with the id of the process that made them.

use crate::errors::Fault;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Arc, Mutex, PoisonError};

/// Most threads that may be asked for.
pub const MOST_THREADS: u16 = 1024;

/// The pools of a process, with its id: the one of all cores, and the last one of another size.
type Pools = (u32, [Option<(u16, Arc<ThreadPool>)>; 2]);

static POOLS: Mutex<Pools> = Mutex::new((0, [None, None]));

/// A pool of this many threads, by default one per core. The last is kept, so that not every batch starts threads.
///
/// # Errors
/// Their number is not allowed, or they cannot be started.
pub fn pool(threads: Option<i64>) -> Result<Arc<ThreadPool>, Fault> {
    let threads = threads.map_or(Ok(0), check)?;
    let mut kept = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if kept.0 != std::process::id() {
        // Dropping the parent's pools would wait for threads that do not exist here.
        std::mem::forget(std::mem::replace(&mut *kept, (std::process::id(), [None, None])));
    }
    let place = &mut kept.1[usize::from(threads != 0)];
    if let Some((_, pool)) = place.as_ref().filter(|(own, _)| *own == threads) {
        return Ok(Arc::clone(pool));
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads.into()).build();
    let pool = pool.map_err(|error| Fault::Other(format!("cannot start the threads: {error}")))?;
    Ok(Arc::clone(&place.insert((threads, Arc::new(pool))).1))
}

/// Abandons the current pools: their work runs on, and later work gets new threads.
pub fn abandon_pools() {
    POOLS.lock().unwrap_or_else(PoisonError::into_inner).1 = [None, None];
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
