//! Repetition of targets by a loop that runs faster than they arrive.
//!
//! A camera gives 60 targets a second, the loop runs at 500 Hz and passes the last target in every tick. Taken as samples, the
//! repetitions would describe a target that stops, jumps and stops.

use crate::task::{Target, TargetRow};

/// Number of intervals without change after which a target has stopped.
const STOPPED: f64 = 2.0;

/// Longest interval between changes of a stream of targets (s); rarer ones each stand still until the next.
const LONGEST_INTERVAL: f64 = 0.1;

/// Detector of repeated targets.
#[derive(Debug)]
pub(super) struct RepeatedTargets {
    dt: f64,
    last: TargetRow,
    /// Time of the last change of the target (s), and the mean interval between changes.
    changed: f64,
    interval: f64,
}

impl RepeatedTargets {
    /// Detector for ticks of `dt` (s).
    pub fn new(dt: f64) -> Self {
        Self { dt, last: TargetRow::new(), changed: f64::NEG_INFINITY, interval: f64::INFINITY }
    }

    /// Whether these targets, received at `time` (s), repeat the last ones while the next are still due.
    pub fn is_repetition(&mut self, targets: &[Target], time: f64) -> bool {
        let waited = time - self.changed;
        if self.last[..] == *targets {
            let stream = self.interval > 1.5 * self.dt && self.interval <= LONGEST_INTERVAL;
            return stream && waited > 0.0 && waited <= STOPPED * self.interval;
        }
        self.interval = if self.interval.is_finite() { 0.5 * (self.interval + waited) } else { waited };
        self.last.clear();
        self.last.extend_from_slice(targets);
        self.changed = time;
        false
    }

    /// Forgets the last target, so that the next counts as new.
    pub fn forget(&mut self) {
        *self = Self::new(self.dt);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns whether each tick repeats a target that changes every `every` ticks and stops at tick `stop`.
    fn repetitions(every: usize, stop: usize) -> Vec<bool> {
        let mut targets = RepeatedTargets::new(0.002);
        let target = |tick: usize| Target::Position([(tick.min(stop) / every) as f64, 0.0, 0.0]);
        (0..300).map(|tick| targets.is_repetition(&[target(tick)], 0.002 * tick as f64)).collect()
    }

    #[test]
    fn a_slow_stream_repeats_until_it_stops() {
        let found = repetitions(8, 48);
        for tick in 9..300 {
            let expected = if tick <= 48 { tick % 8 != 0 } else { tick < 64 };
            // Rounding decides the last tick of the second interval.
            assert!(tick == 64 || found[tick] == expected, "tick {tick}");
        }
    }

    #[test]
    fn new_targets_in_every_tick_and_rare_ones_are_no_stream() {
        assert!(!repetitions(1, 40).contains(&true));
        assert!(!repetitions(60, 1000).contains(&true));
    }

    #[test]
    fn after_forgetting_a_target_is_new() {
        let mut targets = RepeatedTargets::new(0.002);
        for tick in 0..20 {
            targets.is_repetition(&[Target::Position([f64::from(tick / 8), 0.0, 0.0])], 0.002 * f64::from(tick));
        }
        let last = [Target::Position([2.0, 0.0, 0.0])];
        assert!(targets.is_repetition(&last, 0.04));
        targets.forget();
        assert!(!targets.is_repetition(&last, 0.042));
    }
}
