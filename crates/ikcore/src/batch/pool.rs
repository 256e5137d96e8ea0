//! Thread pool of the library: rayon's global pool does not survive a fork.

use std::sync::{Arc, Mutex};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::{Error, Result};

/// Largest number of threads; more than any machine needs.
const MAX_THREADS: usize = 1024;

/// Resolves the number of threads.
///
/// # Errors
/// [`Error::OutOfRange`].
pub(super) fn thread_count(wanted: Option<usize>) -> Result<usize> {
    match wanted {
        None => Ok(std::thread::available_parallelism().map_or(1, |count| count.get().min(MAX_THREADS))),
        Some(count) if (1..=MAX_THREADS).contains(&count) => Ok(count),
        Some(count) => Err(Error::out_of_range("threads", format!("from 1 to {MAX_THREADS}"), count as f64)),
    }
}

/// Pool of the last call, and the process that owns its threads: a forked child inherits the pool without its threads, and
/// would wait for ever.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// Returns a pool of `threads` threads, kept for the next call.
///
/// # Errors
/// [`Error::NoThreads`].
pub(super) fn pool(threads: usize) -> Result<Arc<ThreadPool>> {
    // Does not wait: if this process was forked, another thread of the parent may have held the lock.
    let Ok(mut kept) = POOL.try_lock() else { return new_pool(threads) };
    let process = std::process::id();
    if let Some((owner, pool)) = &*kept
        && *owner == process
        && pool.current_num_threads() == threads
    {
        return Ok(Arc::clone(pool));
    }
    let pool = new_pool(threads)?;
    if let Some((owner, old)) = kept.replace((process, Arc::clone(&pool)))
        && owner != process
    {
        std::mem::forget(old); // in this process there are no threads to join
    }
    Ok(pool)
}

fn new_pool(threads: usize) -> Result<Arc<ThreadPool>> {
    match ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => Ok(Arc::new(pool)),
        Err(problem) => Err(Error::NoThreads { threads, problem: problem.to_string() }),
    }
}
