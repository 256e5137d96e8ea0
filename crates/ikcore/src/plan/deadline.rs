//! The wall-clock budget of a plan.

use std::time::Duration;

use crate::solver::{Stop, Stopwatch};

/// The time since a plan began, and its limit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Deadline {
    stopwatch: Stopwatch,
    max_time: Option<Duration>,
}

impl Deadline {
    /// Starts now; `stop` without a time limit never ends.
    pub(crate) fn start(stop: Option<&Stop>) -> Self {
        Self { stopwatch: Stopwatch::start(), max_time: stop.and_then(|stop| stop.max_time) }
    }

    /// Time since the start.
    pub(crate) fn elapsed(&self) -> Duration {
        self.stopwatch.elapsed()
    }

    /// Whether the time is up.
    pub(crate) fn is_over(&self) -> bool {
        self.max_time.is_some_and(|max_time| self.stopwatch.elapsed() >= max_time)
    }
}
