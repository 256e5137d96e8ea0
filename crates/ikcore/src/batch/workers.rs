//! Threads that work while the calling thread polls its monitor.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use rayon::ThreadPool;

use super::monitors::StopFlag;
use crate::interrupt::interruptible;
use crate::solver::Monitor;

/// Time between two polls of the monitor while threads work.
const INTERVAL: Duration = Duration::from_millis(20);

/// State shared by the worker threads and the calling thread.
#[derive(Default)]
pub(super) struct Shared {
    done: AtomicUsize,
    stopped: Arc<AtomicBool>,
}

impl Shared {
    /// Monitor of one worker thread.
    pub(super) fn monitor(&self) -> StopFlag<'_> {
        StopFlag(&self.stopped)
    }

    /// Runs `work`, whose checkpoints end it on request.
    pub(super) fn interruptible<T>(&self, work: impl FnOnce() -> T) -> T {
        let stopped = Arc::clone(&self.stopped);
        interruptible(move || !stopped.load(Ordering::Relaxed), work)
    }

    /// Counts finished items.
    pub(super) fn count(&self, items: usize) {
        self.done.fetch_add(items, Ordering::Relaxed);
    }
}

/// Runs `work` on `pool`, while the calling thread reports the number of finished items, out of `total`, to `monitor`, which
/// may stop the work.
pub(super) fn run_on(pool: &ThreadPool, total: usize, monitor: &mut dyn Monitor, work: impl FnOnce(&Shared) + Send) {
    let shared = Shared::default();
    // Channel without messages: the sender is dropped when the threads are done.
    let (working, finished) = mpsc::channel::<()>();
    pool.in_place_scope(|scope| {
        let shared = &shared;
        scope.spawn(move |_| {
            let _working = working;
            work(shared);
        });
        while let Err(RecvTimeoutError::Timeout) = finished.recv_timeout(INTERVAL) {
            if !monitor.keep_going() {
                shared.stopped.store(true, Ordering::Relaxed);
            }
            monitor.progress(shared.done.load(Ordering::Relaxed), total);
        }
    });
    monitor.progress(shared.done.into_inner(), total);
}
