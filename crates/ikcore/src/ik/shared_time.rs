//! Elapsed time, shared equally by the runs that are side by side.

use std::cell::Cell;
use std::time::Duration;

use crate::solver::Stopwatch;

/// Elapsed time, shared equally by concurrent runs.
pub(super) struct SharedTime {
    stopwatch: Stopwatch,
    state: Cell<Shares>,
}

/// The time that a run present from the start would have used by `until`, and the number of runs from then on.
#[derive(Clone, Copy)]
struct Shares {
    until: Duration,
    each: Duration,
    runs: u32,
}

impl SharedTime {
    pub fn start() -> Self {
        let state = Shares { until: Duration::ZERO, each: Duration::ZERO, runs: 0 };
        Self { stopwatch: Stopwatch::start(), state: Cell::new(state) }
    }

    /// Updates the shares to now; `runs` changes the number of runs.
    fn share(&self, runs: impl FnOnce(u32) -> u32) -> Duration {
        let (Shares { until, each, runs: before }, now) = (self.state.get(), self.stopwatch.elapsed());
        let each = each + (now - until) / before.max(1);
        self.state.set(Shares { until: now, each, runs: runs(before) });
        each
    }

    /// A run begins; returns the value to pass to [`leave`](Self::leave).
    pub fn enter(&self) -> Duration {
        self.share(|runs| runs + 1)
    }

    /// A run ends; returns its share of the time since it began.
    pub fn leave(&self, begun: Duration) -> Duration {
        self.share(|runs| runs - 1) - begun
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_to_the_time_that_passed() {
        let shared = SharedTime::start();
        let first = shared.enter();
        let second = shared.enter();
        let shares = [shared.leave(first), shared.leave(second)];
        let passed = shared.stopwatch.elapsed();
        assert!(shares.iter().sum::<Duration>() <= passed);
        assert!(shares[1] >= Duration::ZERO && shared.state.get().runs == 0);
    }
}
