//! The admissible changes of one joint.
//!
//! A change is admissible if jerk and acceleration limits allow it and the fastest stop that follows stays inside the
//! position limits and below the velocity limits until it ends. The rest of a fastest stop is itself a fastest stop, so the
//! set of the next tick contains at least the continued stop: it is never empty, as long as limits do not close in. The
//! highest position and the highest speed of the stop increase with the change, so the set is an interval.

use super::bracket::largest_not_positive;
use super::braking::{Braking, longest_first};

/// Limits of a joint that could not stop in time otherwise, relative to its planned limits; still below the given ones.
const HARDER: f64 = 1.0 + 0.8e-6;

/// Distances to the position limits, and the largest step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    pub below: f64,
    pub above: f64,
    pub step: f64,
}

impl Braking {
    /// Returns the smallest and largest admissible change of a joint with this step and change; if there is none, the
    /// nearest one twice. `slowest_until` gives the smallest velocity limit of the next ticks, in rad or m per tick, if
    /// it varies.
    pub(super) fn changes(
        &self,
        [step, change]: [f64; 2],
        room: Room,
        slowest_until: Option<&dyn Fn(f64) -> f64>,
    ) -> [f64; 2] {
        let [least, most] = [(change - self.jerk).max(-self.acceleration), (change + self.jerk).min(self.acceleration)];
        // A change that fades out adds to the step.
        let fastest = |left: f64| if left >= 0.0 { longest_first(left, self.jerk) } else { left };
        let [slow, fast] = [-fastest(room.step + step), fastest(room.step - step)].map(|end| end.max(least).min(most));
        let upper = self.largest_before(step, [least, fast], room.above, slowest_until);
        let lower = self.largest_before(-step, [-most, -slow], room.below, slowest_until).map(|change| -change);
        // Rounding may leave a stop a little too long; braking a little harder than planned makes up for it.
        let [jerk, acceleration] = [self.jerk, self.acceleration].map(|limit| HARDER * limit);
        let [hardest, softest] = [(change - jerk).max(-acceleration), (change + jerk).min(acceleration)];
        match (lower, upper) {
            (Some(lower), Some(upper)) if lower <= upper => [lower, upper],
            (Some(lower), None) => [if lower > least { lower } else { hardest }; 2],
            (None, Some(upper)) => [if upper < most { upper } else { softest }; 2],
            // Both limits are out of reach, or they have crossed.
            _ => [self.first_change(step, change).max(least).min(most); 2],
        }
    }

    /// Returns the largest change from `least` to `most` after which the fastest stop stays within `room` above and
    /// below `slowest_until` its end.
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
        // Far from the position limit no stop need be known.
        if slowest_until.is_none() && step + most + self.at_most_up(step + most, most) <= room {
            return Some(most);
        }
        let at_most = excess(most);
        if at_most <= 0.0 { Some(most) } else { largest_not_positive(least, [most, at_most], excess) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::between;
    use proptest::prelude::*;

    proptest! {
        /// A joint that takes any admissible changes keeps all limits and always has an admissible change left.
        #[test]
        fn admissible_changes_never_run_out(
            jerk in -2.5_f64..0.5, limited in any::<bool>(), speed in -0.5_f64..2.3, width in -1.0_f64..2.0,
            fractions in prop::collection::vec((0_u8..5, 0.0..1.0), 10), falls in any::<bool>(),
        ) {
            let jerk = if limited { 10.0_f64.powf(jerk) } else { f64::INFINITY };
            let braking = Braking { acceleration: 1.0, jerk };
            let fastest = 10.0_f64.powf(speed);
            let half = fastest * 10.0_f64.powf(width);
            // The velocity limit falls to a tenth within the motion.
            let limit = |tick: f64| if falls { fastest * (1.0 - 0.003 * tick).max(0.1) } else { fastest };
            let (mut q, mut step, mut change) = (0.0, 0.0, 0.0);
            for tick in 0..400 {
                let now = f64::from(tick);
                let until = |ticks: f64| limit(now + ticks + 1.0);
                let room = Room { below: q + half, above: half - q, step: limit(now + 1.0) };
                let [least, most] = braking.changes([step, change], room, Some(&until));
                prop_assert!(least <= most);
                let (kind, fraction) = fractions[tick as usize / 40];
                let fraction = match kind { 0 => 0.0, 1 => 1.0, 2 => f64::from(u8::from(tick % 7 < 3)), _ => fraction };
                let next = between(least, most, fraction);
                let rounding = 1e-12 * (1.0 + half);
                prop_assert!((next - change).abs() <= HARDER * jerk + rounding && next.abs() <= HARDER + rounding);
                (change, step) = (next, step + next);
                q += step;
                prop_assert!(step.abs() <= limit(now + 1.0) + rounding, "tick {tick}: {step} {}", limit(now + 1.0));
                prop_assert!(q.abs() <= half + rounding, "tick {tick}: {q} {half}");
            }
        }
    }

    #[test]
    fn a_joint_at_its_limit_may_stay_or_leave() {
        let braking = Braking { acceleration: 1.0, jerk: 0.25 };
        let room = Room { below: 9.0, above: 0.0, step: 5.0 };
        assert_eq!(braking.changes([0.0, 0.0], room, None), [-0.25, 0.0]);
    }

    #[test]
    fn a_joint_past_its_limit_brakes_as_hard_as_it_may() {
        let braking = Braking { acceleration: 1.0, jerk: 0.25 };
        let room = Room { below: 9.0, above: -2.0, step: 5.0 };
        let [least, most] = braking.changes([0.5, -0.5], room, None);
        assert!(least == most && (least + 0.75).abs() < 1e-6, "{least} {most}");
    }
}
