//! Monitors of the solves of a batch.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::solver::Monitor;

/// The caller's monitor, shared by targets that are solved side by side.
#[derive(Clone)]
pub(super) struct SharedMonitor<'a, 'm>(pub &'a RefCell<&'m mut dyn Monitor>);

impl Monitor for SharedMonitor<'_, '_> {
    fn keep_going(&mut self) -> bool {
        self.0.borrow_mut().keep_going()
    }

    fn progress(&mut self, done: usize, total: usize) {
        self.0.borrow_mut().progress(done, total);
    }
}

/// The monitor of a worker thread, which only signals whether to stop.
#[derive(Clone)]
pub(super) struct StopFlag<'a>(pub &'a AtomicBool);

impl Monitor for StopFlag<'_> {
    fn keep_going(&mut self) -> bool {
        !self.0.load(Ordering::Relaxed)
    }
}
