//! The box of one tick: position limits intersected with what the velocity limit lets the ACCEPTED configuration reach.

use serde::{Deserialize, Serialize};

use super::{Field, Limits, Profile};
use crate::math::ordered::{larger, smaller};
use crate::objective::{Bounds, Point};
use crate::wording::words;

/// Where in a tick its limit is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum LimitAt {
    /// The smallest limit over the tick: never broken, at no instant.
    #[default]
    Interval,
    /// The limit at the tick's beginning, as Cheng et al. (2020) take it.
    Start,
}

words!("limit_at": LimitAt { Interval => "interval", Start => "start" });

impl LimitAt {
    /// The `limit` that holds for the tick from `from` to `to` (s).
    fn of(self, limit: &Profile, from: f64, to: f64) -> f64 {
        match self {
            Self::Interval => limit.smallest(from, to).1,
            Self::Start => limit.at(from),
        }
    }
}

/// Where one tick may end, and the velocity limits that it came from.
#[derive(Debug, Clone, PartialEq)]
pub struct TickBox {
    /// The box of the joints (rad, m).
    pub bounds: Bounds,
    /// The velocity limit of each joint for this tick (rad/s, m/s).
    pub velocity: Point,
    /// The lower position limits over the tick (rad, m).
    pub floor: Point,
    /// The upper ones.
    pub ceiling: Point,
}

impl TickBox {
    /// The box of an arm that stands still at `q`.
    pub fn around(q: &[f64]) -> Self {
        let all = |value: f64| Point::from_elem(value, q.len());
        Self {
            bounds: Bounds::from_ranges(q.iter().map(|q| (*q, *q))),
            velocity: all(0.0),
            floor: all(f64::NEG_INFINITY),
            ceiling: all(f64::INFINITY),
        }
    }
}

impl Limits {
    /// The velocity limit of joint `j` that holds for the tick from `from` to `to` (s).
    pub fn velocity_over(&self, j: usize, from: f64, to: f64, at: LimitAt) -> f64 {
        at.of(&self.velocity[j], from, to)
    }

    /// Writes the velocity limits that hold for the tick from `from` to `to` (s).
    pub fn write_velocities_over(&self, [from, to]: [f64; 2], at: LimitAt, velocity: &mut [f64]) {
        let mut last: Option<(&Profile, f64)> = None;
        for (velocity, limit) in velocity.iter_mut().zip(&self.velocity) {
            *velocity = match (limit, last) {
                (Profile::Constant(limit), _) => *limit,
                // Joints mostly share one limit, and two are compared more quickly than an extreme is found.
                (varying, Some((same, value))) if varying == same => value,
                _ => at.of(limit, from, to),
            };
            last = Some((limit, *velocity));
        }
    }

    /// The position range of joint `j` that holds at every instant from `from` to `to` (s).
    pub fn position_range(&self, j: usize, from: f64, to: f64) -> [f64; 2] {
        [self.lower[j].largest(from, to).1, self.upper[j].smallest(from, to).1]
    }

    /// Narrows `tick` to the positions that joints at `q` may have at the end of the tick from `from` to `to` (s), which lasts
    /// `dt`: `to - from` is rounded, the more so the later, and the reach must not depend on that. Returns whether every joint
    /// can be within its position limits then; one that cannot is sent towards them as fast as it may go.
    pub fn narrow(&self, q: &[f64], [from, to]: [f64; 2], dt: f64, at: LimitAt, tick: &mut TickBox) -> bool {
        let TickBox { bounds, velocity, floor, ceiling } = tick;
        self.write_velocities_over([from, to], at, velocity);
        floor.iter_mut().zip(&self.lower).for_each(|(floor, lower)| *floor = lower.largest(from, to).1);
        ceiling.iter_mut().zip(&self.upper).for_each(|(ceiling, upper)| *ceiling = upper.smallest(from, to).1);
        let n = q.len();
        let (lower, upper) = bounds.parts_mut();
        let (lower, upper) = (&mut lower[..n], &mut upper[..n]);
        let (velocity, floor, ceiling) = (&velocity[..n], &floor[..n], &ceiling[..n]);
        for j in 0..n {
            // A limit that varies may fall below zero at a time that could not be checked beforehand: then the joint stands still.
            let reach = larger(velocity[j] * dt, 0.0);
            let (slowest, fastest) = (reachable(q[j], -reach), reachable(q[j], reach));
            lower[j] = smaller(larger(slowest, floor[j]), fastest);
            // Limits that cross later than could be checked leave a point between them, not an empty box.
            upper[j] = larger(larger(smaller(fastest, ceiling[j]), slowest), lower[j]);
        }
        (0..n).all(|j| floor[j] <= lower[j] && upper[j] <= ceiling[j])
    }

    /// Whether every tick has the same box, wherever it begins: nothing varies, and no velocity is limited.
    pub fn leave_one_box(&self) -> bool {
        let ranges = self.lower.iter().chain(&self.upper);
        ranges.into_iter().all(|limit| matches!(limit, Profile::Constant(_))) && !self.is_finite(Field::Velocity)
    }
}

/// q + reach, rounded so that the displacement does not exceed `reach` by the last bit.
#[inline(always)]
fn reachable(q: f64, reach: f64) -> f64 {
    let end = q + reach;
    // Half of all ends are rounded too far, at random: a branch would be guessed wrong as often. The number next to `end` on
    // the side of q has bits that are lower by one where `end` and `reach` have the same sign, else higher.
    let bits = end.to_bits() as i64;
    let towards_q = -(1 | ((bits ^ reach.to_bits() as i64) >> 63));
    let too_far = i64::from((end - q).abs() > reach.abs());
    f64::from_bits((bits + too_far * towards_q) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Field;
    use crate::math::pose;
    use crate::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn slider(lower: f64, upper: f64, velocity: f64) -> Robot {
        let mut chain = ChainBuilder::new("slider", "base");
        let joint =
            chain.add_joint(Joint::new("x", JointKind::Prismatic).with_range(lower, upper).with_velocity(velocity));
        chain.moving(joint, JointKind::Prismatic, Vector3::x(), Drive::DIRECT);
        chain.fixed(pose::translation(0.0, 0.0, 0.1));
        chain.link("tip");
        chain.build().unwrap()
    }

    fn tick(limits: &Limits, q: f64, dt: f64) -> (bool, f64, f64) {
        let mut tick = TickBox::around(&[q]);
        let feasible = limits.narrow(&[q], [0.0, dt], dt, LimitAt::Interval, &mut tick);
        (feasible, tick.bounds.lower()[0], tick.bounds.upper()[0])
    }

    #[test]
    fn position_limits_cut_the_velocity_reach() {
        let limits = Limits::of(&slider(-1.0, 1.0, 0.5));
        assert_eq!(tick(&limits, 0.0, 1.0), (true, -0.5, 0.5));
        assert_eq!(tick(&limits, 0.75, 1.0), (true, 0.25, 1.0));
    }

    #[test]
    fn outside_its_limits_a_joint_returns_at_full_speed() {
        let limits = Limits::of(&slider(-1.0, 1.0, 0.5));
        assert_eq!(tick(&limits, 2.0, 1.0), (false, 1.5, 1.5));
        assert_eq!(tick(&limits, -2.0, 1.0), (false, -1.5, -1.5));
        assert_eq!(tick(&limits, 1.25, 1.0), (true, 0.75, 1.0));
    }

    #[test]
    fn a_zero_velocity_limit_locks_the_joint_and_none_frees_it() {
        assert_eq!(tick(&Limits::of(&slider(-1.0, 1.0, 0.0)), 0.3, 1.0), (true, 0.3, 0.3));
        let free = Limits::of(&slider(-1.0, 1.0, f64::INFINITY));
        assert_eq!(tick(&free, 0.3, 1.0), (true, -1.0, 1.0));
    }

    #[test]
    fn the_smallest_limit_of_the_tick_counts() {
        let fading = Profile::Sampled { step: 0.5, values: vec![0.4, 0.1, 0.3] };
        let limits = Limits::of(&slider(-9.0, 9.0, 1.0)).replace(Field::Velocity, vec![fading]).unwrap();
        assert_eq!(limits.velocity_over(0, 0.0, 1.0, LimitAt::Interval), 0.1);
        assert_eq!(limits.velocity_over(0, 0.0, 1.0, LimitAt::Start), 0.4);
    }

    #[test]
    fn the_reach_is_the_same_at_any_time() {
        let limits = Limits::of(&slider(-9.0, 9.0, 2.0));
        let dt = 0.0005;
        for i in (0..60_000).step_by(7) {
            let mut tick = TickBox::around(&[0.1]);
            let ends = [f64::from(i) * dt, f64::from(i + 1) * dt];
            limits.narrow(&[0.1], ends, dt, LimitAt::Interval, &mut tick);
            assert!(tick.bounds.upper()[0] - 0.1 <= 2.0 * dt && 0.1 - tick.bounds.lower()[0] <= 2.0 * dt, "{ends:?}");
        }
    }

    proptest! {
        #[test]
        fn no_displacement_exceeds_the_reach(q in -3.0..3.0, velocity in 0.0..2.0, dt in 1e-4..0.5) {
            let limits = Limits::of(&slider(-9.0, 9.0, velocity));
            let (_, lower, upper) = tick(&limits, q, dt);
            prop_assert!(upper - q <= velocity * dt && q - lower <= velocity * dt);
        }
    }
}
