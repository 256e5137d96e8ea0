//! The admissible changes of one joint.
//!
//! A change is admissible if jerk and acceleration limits allow it and the fastest stop that follows stays inside the
//! position limits and below the velocity limits until it ends. The rest of a fastest stop is itself a fastest stop, so the
//! set of the next tick contains at least the continued stop: it is never empty, as long as limits do not close in. The
//! highest position and the highest speed of the stop increase with the change, so the set is an interval.

use super::Braking;
use super::bracket::largest_not_positive;
use super::braking::longest_first;

/// Distances to the position limits, and the largest step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    pub below: f64,
    pub above: f64,
    pub step: f64,
}

impl Braking {
    /// The admissible changes of a joint with this step and change, from smallest to largest, and whether there are any.
    /// Without any, the nearest to admissible twice. `slowest_until` gives the smallest velocity limit of the next ticks,
    /// in rad or m per tick, if it varies.
    pub(super) fn changes(
        &self,
        [step, change]: [f64; 2],
        room: Room,
        slowest_until: Option<&dyn Fn(f64) -> f64>,
    ) -> (bool, [f64; 2]) {
        let ends = [(change - self.jerk).max(-self.acceleration), (change + self.jerk).min(self.acceleration)];
        let [least, most] = ends;
        // A change that fades out adds to the step.
        let fastest = |left: f64| if left >= 0.0 { longest_first(left, self.jerk) } else { left };
        let limited = [(-fastest(room.step + step)).clamp(least, most), fastest(room.step - step).clamp(least, most)];
        let not_too_fast = -fastest(room.step + step) <= most && fastest(room.step - step) >= least;
        let upper = self.largest_before(step, [least, limited[1]], room.above, slowest_until);
        let lower = self.largest_before(-step, [-most, -limited[0]], room.below, slowest_until).map(|change| -change);
        match (lower, upper) {
            (Some(lower), Some(upper)) if lower <= upper => (not_too_fast, [lower, upper]),
            (Some(lower), Some(upper)) => (false, [0.5 * (lower + upper); 2]),
            (Some(_), None) => (false, [least; 2]),
            (None, Some(upper)) => (false, [upper; 2]),
            (None, None) => (false, [self.first_change(step, change).clamp(least, most); 2]),
        }
    }

    /// The largest change from `least` to `most` after which the fastest stop stays within `room` above and below
    /// `slowest_until` its end.
    fn largest_before(
        &self,
        step: f64,
        [least, most]: [f64; 2],
        room: f64,
        slowest_until: Option<&dyn Fn(f64) -> f64>,
    ) -> Option<f64> {
        let excess = |change: f64| {
            let next = step + change;
            let stop = self.stop(next, change);
            let too_far = if room == f64::INFINITY { f64::NEG_INFINITY } else { next + stop.highest - room };
            let too_fast =
                slowest_until.map_or(f64::NEG_INFINITY, |limit| self.fastest(next, change) - limit(stop.ticks));
            too_far.max(too_fast)
        };
        if room == f64::INFINITY && slowest_until.is_none() {
            return Some(most);
        }
        largest_not_positive([least, most], excess)
    }
}
