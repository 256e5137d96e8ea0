//! Progress and interruption of long runs.

use std::cell::Cell;

/// Monitor of a long run, polled from the calling thread every few microseconds of work to report progress or interrupt.
pub trait Monitor {
    /// Returns false to end the run with [`Status::Interrupted`](super::Status::Interrupted).
    fn keep_going(&mut self) -> bool;

    /// Receives the number of finished steps of a track, items of a batch or evaluations, out of `total`.
    fn progress(&mut self, _done: usize, _total: usize) {}
}

/// Monitor that never interrupts.
#[derive(Debug, Clone, Copy)]
pub struct Unattended;

impl Monitor for Unattended {
    fn keep_going(&mut self) -> bool {
        true
    }
}

/// Monitor that reports the number of evaluations to the caller's monitor.
pub(crate) struct EvaluationMonitor<'a> {
    /// Monitor of the caller.
    pub monitor: &'a mut dyn Monitor,
    /// Evaluations so far, counted elsewhere.
    pub done: &'a Cell<usize>,
    /// Budget of evaluations.
    pub total: usize,
}

impl Monitor for EvaluationMonitor<'_> {
    fn keep_going(&mut self) -> bool {
        self.monitor.progress(self.done.get(), self.total);
        self.monitor.keep_going()
    }
}
