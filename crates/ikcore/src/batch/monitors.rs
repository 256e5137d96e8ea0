//! The monitor of the threads of a batch.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::solver::Monitor;

/// The monitor of a worker thread, which only signals whether to stop.
pub(super) struct StopFlag<'a>(pub &'a AtomicBool);

impl Monitor for StopFlag<'_> {
    fn keep_going(&mut self) -> bool {
        !self.0.load(Ordering::Relaxed)
    }
}
