//! Progress of a search, told to whoever watches it.

use std::cell::Cell;

use super::stop::Monitor;

/// Tells the caller's monitor how many evaluations are done.
pub(crate) struct Reporting<'a> {
    /// The caller's.
    pub monitor: &'a mut dyn Monitor,
    /// Evaluations made so far, counted elsewhere.
    pub done: &'a Cell<usize>,
    /// Evaluations that may be made.
    pub total: usize,
}

impl Monitor for Reporting<'_> {
    fn keep_going(&mut self) -> bool {
        self.monitor.progress(self.done.get(), self.total);
        self.monitor.keep_going()
    }
}
