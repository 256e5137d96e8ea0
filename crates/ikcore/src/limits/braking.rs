//! Acceleration limits: the motion of a joint in one tick after which it can still stop before its position limit.
//!
//! If joints could not stop in time, position and acceleration limits could not both hold. In continuous time the speed
//! limit is |q'| <= sqrt(2 a distance); with ticks it is a little lower, and computed exactly here.
//! |q'| <= sqrt(2 a distance); in ticks at a little less, which is counted exactly here.

use super::{Limits, TickBox};

/// Bounds that cross by less than this (rad, m; relative beyond 1) cross by rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Fraction of its acceleration limit that a joint plans to brake with; with all of it, rounding could make it late.
const PLANNED: f64 = 1.0 - 1e-6;

impl Limits {
    /// Narrows `tick`, the box from position and velocity limits at `q`, by the acceleration limits of an arm that
    /// moves at `qd` (rad/s, m/s), in the tick of `dt` from `from` to `to` (s). Returns false if a joint has no
    /// admissible position; it then brakes as hard as it may, past its other limits.
    pub(crate) fn brake(&self, q: &[f64], qd: &[f64], [from, to]: [f64; 2], dt: f64, tick: &mut TickBox) -> bool {
        let Some(accelerations) = &self.acceleration else { return true };
        let (lower, upper) = tick.bounds.parts_mut();
        let mut feasible = true;
        for (j, acceleration) in accelerations.iter().enumerate() {
            let acceleration = acceleration.smallest(from, to).1;
            if acceleration == f64::INFINITY {
                continue;
            }
            let [floor, ceiling] = self.position_range(j, from, to);
            let change = acceleration.max(0.0) * dt * dt;
            let (slowest, fastest) = (q[j] + qd[j] * dt - change, q[j] + qd[j] * dt + change);
            let from_below = lower[j].max(q[j] - longest_step(q[j] - floor, PLANNED * change));
            let from_above = upper[j].min(q[j] + longest_step(ceiling - q[j], PLANNED * change)).max(from_below);
            let rounding = ROUNDING * q[j].abs().max(1.0);
            feasible &= from_below <= fastest + rounding && slowest <= from_above + rounding;
            lower[j] = from_below.clamp(slowest, fastest);
            upper[j] = from_above.clamp(slowest, fastest);
        }
        feasible
    }

    /// The longest step (rad, m) of joint `j` over the tick from `from` to `to` (s) after which it can still stop
    /// within `distance` of its position.
    pub(crate) fn longest_step_before(&self, j: usize, distance: f64, [from, to]: [f64; 2]) -> f64 {
        let acceleration = self.acceleration_over(j, from, to);
        let dt = to - from;
        if acceleration == f64::INFINITY { distance } else { longest_step(distance, PLANNED * acceleration * dt * dt) }
    }

    /// The acceleration limit of joint `j` over the tick from `from` to `to` (s); infinite without one.
    pub(crate) fn acceleration_over(&self, j: usize, from: f64, to: f64) -> f64 {
        self.acceleration.as_ref().map_or(f64::INFINITY, |profiles| profiles[j].smallest(from, to).1)
    }
}

/// The longest step of a tick after which a joint that shortens its steps by `change` from tick to tick stays within
/// `distance`.
///
/// Steps s, s - change, s - 2 change, ... of m ticks sum to m s - change m (m - 1) / 2. This is within `distance` for
/// every m if s <= distance / m + change (m - 1) / 2; the smallest right-hand side is at m near sqrt(2 distance /
/// change).
fn longest_step(distance: f64, change: f64) -> f64 {
    if change == 0.0 || distance <= 0.0 || distance == f64::INFINITY {
        return distance.max(0.0);
    }
    let after = |ticks: f64| distance / ticks + 0.5 * change * (ticks - 1.0);
    let ticks = (2.0 * distance / change).sqrt().floor().max(1.0);
    after(ticks).min(after(ticks + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// How far a joint gets that begins with a step of `step` and brakes.
    fn stopping_distance(step: f64, change: f64) -> f64 {
        let mut steps = std::iter::successors(Some(step), |step| Some(step - change)).take_while(|step| *step > 0.0);
        steps.by_ref().take(100_000).sum()
    }

    proptest! {
        #[test]
        fn braking_from_the_longest_step_ends_at_the_limit(distance in 1e-6..3.0, change in 1e-5..0.1) {
            let step = longest_step(distance, change);
            prop_assert!(stopping_distance(step, change) <= distance * (1.0 + 1e-9));
            prop_assert!(stopping_distance(step * (1.0 + 1e-6), change) > distance);
        }
    }

    #[test]
    fn short_ticks_approach_the_continuous_braking_distance() {
        let (distance, acceleration, dt) = (0.4, 3.0, 1e-5);
        let speed = longest_step(distance, acceleration * dt * dt) / dt;
        assert!((speed - (2.0_f64 * acceleration * distance).sqrt()).abs() < 1e-4);
    }

    #[test]
    fn without_a_distance_or_an_acceleration_there_is_no_step() {
        assert_eq!(longest_step(-0.1, 0.01), 0.0);
        assert_eq!(longest_step(0.1, 0.0), 0.1);
        assert_eq!(longest_step(f64::INFINITY, 0.01), f64::INFINITY);
    }
}
