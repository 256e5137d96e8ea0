//! Stopwatch, the only clock of the crate.

use std::time::{Duration, Instant};

/// Stopwatch for elapsed time.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch(Instant);

impl Stopwatch {
    /// Starts a stopwatch.
    #[allow(clippy::disallowed_methods)]
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// Stopwatch that started later by this time.
    pub(crate) fn started_later(self, by: Duration) -> Self {
        Self(self.0 + by)
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Duration {
        self.0.elapsed()
    }
}
