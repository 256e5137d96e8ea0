//! Monitors of the items of a batch.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::solver::Monitor;

/// Monitor of a worker thread, which only signals whether to stop.
pub(super) struct StopFlag<'a>(pub &'a AtomicBool);

impl Monitor for StopFlag<'_> {
    fn keep_going(&mut self) -> bool {
        !self.0.load(Ordering::Relaxed)
    }
}

/// Caller's monitor without progress, for a single item of a batch.
pub(super) struct Quiet<'a>(pub &'a mut dyn Monitor);

impl Monitor for Quiet<'_> {
    fn keep_going(&mut self) -> bool {
        self.0.keep_going()
    }
}
