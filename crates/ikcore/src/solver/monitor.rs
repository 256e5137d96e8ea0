//! The caller's say in a long run: progress and interruption.

use std::cell::Cell;

/// The caller's say in a long run: asked from the calling thread, every few microseconds of work.
pub trait Monitor {
    /// False ends the run with [`Status::Interrupted`](super::Status::Interrupted).
    fn keep_going(&mut self) -> bool;

    /// Told of the steps of a track, or of the items of a batch, that are done, out of `total`.
    fn progress(&mut self, _done: usize, _total: usize) {}
}

/// A monitor that lets everything run to its end.
#[derive(Debug, Clone, Copy)]
pub struct Unattended;

impl Monitor for Unattended {
    fn keep_going(&mut self) -> bool {
        true
    }
}

/// Tells the caller's monitor how many evaluations are done.
pub(crate) struct EvaluationMonitor<'a> {
    /// The caller's.
    pub monitor: &'a mut dyn Monitor,
    /// Evaluations made so far, counted elsewhere.
    pub done: &'a Cell<usize>,
    /// Evaluations that may be made.
    pub total: usize,
}

impl Monitor for EvaluationMonitor<'_> {
    fn keep_going(&mut self) -> bool {
        self.monitor.progress(self.done.get(), self.total);
        self.monitor.keep_going()
    }
}
