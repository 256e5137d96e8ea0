//! Progress and interruption of long runs.

use std::cell::Cell;

/// Lets the caller watch and interrupt a long run. It is polled from the calling thread, every few microseconds of work.
pub trait Monitor {
    /// Returns false to end the run with [`Status::Interrupted`](super::Status::Interrupted).
    fn keep_going(&mut self) -> bool;

    /// Receives the number of finished steps of a track, items of a batch or evaluations, out of `total`.
    fn progress(&mut self, _done: usize, _total: usize) {}
}

/// A monitor that never interrupts.
#[derive(Debug, Clone, Copy)]
pub struct Unattended;

impl Monitor for Unattended {
    fn keep_going(&mut self) -> bool {
        true
    }
}

/// Reports the number of evaluations to the caller's monitor.
pub(crate) struct EvaluationMonitor<'a> {
    /// The caller's monitor.
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
