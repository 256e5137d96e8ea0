//! The box of one tick: the position limits intersected with the range that the velocity limits allow from the accepted
//! configuration.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::field::Field;
use super::joint_limits::Limits;
use super::profile::Profile;
use crate::math::JointWeights;
use crate::math::comparison::{larger, smaller};
use crate::objective::{Bounds, Point};
use crate::wording::words;

/// The time within a tick at which its limit is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum LimitAt {
    /// The smallest limit over the tick; it then holds at every instant.
    #[default]
    Interval,
    /// The limit at the start of the tick, as in Cheng et al. (2020).
    Start,
}

words!("limit_at": LimitAt { Interval => "interval", Start => "start" });

impl LimitAt {
    /// Returns the value of `limit` for the tick from `from` to `to` (s).
    fn of(self, limit: &Profile, from: f64, to: f64) -> f64 {
        match self {
            Self::Interval => limit.smallest(from, to).1,
            Self::Start => limit.at(from),
        }
    }
}

/// The box of joint positions at the end of one tick, and the limits that it comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TickBox {
    /// The box of the joints (rad, m).
    pub bounds: Bounds,
    /// The velocity limit of each joint for this tick (rad/s, m/s).
    pub velocity: Point,
    /// The lower position limits over the tick (rad, m).
    pub floor: Point,
    /// The upper position limits over the tick (rad, m).
    pub ceiling: Point,
    varying: [Varying; 3],
    /// Whether every tick has this box, whatever the configuration.
    lasting: bool,
}

/// Variation over time of one kind of limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Varying {
    /// None: all are constant.
    Not,
    /// All alike: joints share one profile.
    Together,
    /// Joints vary apart from each other.
    Apart,
}

impl Varying {
    fn of(limits: &[Profile]) -> Self {
        match limits {
            _ if limits.iter().all(|limit| matches!(limit, Profile::Constant(_))) => Self::Not,
            [first, rest @ ..] if rest.iter().all(|limit| limit == first) => Self::Together,
            _ => Self::Apart,
        }
    }

    /// Updates the values that vary.
    #[inline]
    fn update(self, values: &mut [f64], limits: &[Profile], value: impl Fn(&Profile) -> f64) {
        match self {
            Self::Not => {}
            Self::Together => values.fill(value(&limits[0])),
            Self::Apart => values.iter_mut().zip(limits).for_each(|(out, limit)| *out = value(limit)),
        }
    }
}

impl TickBox {
    /// Returns the box of an arm at `q`, to be narrowed in every tick by the same limits.
    pub(crate) fn around(q: &[f64], limits: &Limits) -> Self {
        let Limits { lower, upper, velocity, acceleration, jerk, .. } = limits;
        let fields = [velocity, lower, upper];
        let [velocity, floor, ceiling] = fields.map(|field| field.iter().map(|limit| limit.at(0.0)).collect::<Point>());
        let varying = fields.map(|field| Varying::of(field));
        let limited_steps = limits.is_finite(Field::Velocity) || acceleration.is_some() || jerk.is_some();
        let lasting = varying == [Varying::Not; 3] && !limited_steps;
        let ranges = q.iter().zip(floor.iter().zip(&ceiling));
        let bounds = ranges.map(|(q, (floor, ceiling))| if lasting { (*floor, *ceiling) } else { (*q, *q) });
        Self { bounds: Bounds::from_ranges(bounds), velocity, floor, ceiling, varying, lasting }
    }

    /// The box with these weights of the joints.
    pub(crate) fn weighted(self, weights: Option<Arc<JointWeights>>) -> Self {
        Self { bounds: self.bounds.weighted(weights), ..self }
    }
}

impl Limits {
    /// Writes the velocity limits of each of `ticks`, (from, to) (s), one row (n,) per tick.
    pub(crate) fn write_velocities(&self, ticks: impl Iterator<Item = [f64; 2]>, at: LimitAt, rows: &mut [f64]) {
        // Determined once, since comparing limits of many samples is slow.
        let varying = match Varying::of(&self.velocity) {
            Varying::Together => Varying::Together,
            // Constant limits are written too, because the rows are still empty.
            Varying::Not | Varying::Apart => Varying::Apart,
        };
        for (row, [from, to]) in rows.chunks_exact_mut(self.velocity.len()).zip(ticks) {
            varying.update(row, &self.velocity, |limit| at.of(limit, from, to));
        }
    }

    /// The position range of joint `j` that holds at every instant from `from` to `to` (s).
    pub(crate) fn position_range(&self, j: usize, from: f64, to: f64) -> [f64; 2] {
        [self.lower[j].largest(from, to).1, self.upper[j].smallest(from, to).1]
    }

    /// Narrows `tick` to the positions that joints at `q` may have at the end of the tick from `from` to `to` (s). `dt`
    /// is passed separately: `to - from` has a rounding error that grows with time, and the box must not depend on it.
    /// Returns false if a joint cannot be within its position limits by then; it is sent towards them as fast as its
    /// velocity limit allows.
    pub(crate) fn narrow(&self, q: &[f64], [from, to]: [f64; 2], dt: f64, at: LimitAt, tick: &mut TickBox) -> bool {
        if tick.lasting {
            return true;
        }
        let TickBox { bounds, velocity, floor, ceiling, varying, .. } = tick;
        varying[0].update(velocity, &self.velocity, |limit| at.of(limit, from, to));
        varying[1].update(floor, &self.lower, |limit| limit.largest(from, to).1);
        varying[2].update(ceiling, &self.upper, |limit| limit.smallest(from, to).1);
        let n = q.len();
        let (lower, upper) = bounds.parts_mut();
        let (lower, upper) = (&mut lower[..n], &mut upper[..n]);
        let (velocity, floor, ceiling) = (&velocity[..n], &floor[..n], &ceiling[..n]);
        for j in 0..n {
            // A varying limit may become negative at a time that was not checked beforehand; the joint then stands
            // still.
            let reach = larger(velocity[j] * dt, 0.0);
            let (slowest, fastest) = (reachable(q[j], -reach), reachable(q[j], reach));
            lower[j] = smaller(larger(slowest, floor[j]), fastest);
            // If limits cross at a time that was not checked, the box becomes a point between them, never empty.
            upper[j] = larger(larger(smaller(fastest, ceiling[j]), slowest), lower[j]);
        }
        (0..n).all(|j| floor[j] <= lower[j] && upper[j] <= ceiling[j])
    }
}

/// q + reach, rounded so that the displacement does not exceed `reach` by the last bit.
#[inline(always)]
fn reachable(q: f64, reach: f64) -> f64 {
    let end = q + reach;
    // Half of all ends are rounded too far, at random, so a branch would be mispredicted as often. In the bits of
    // `end`, the next number towards q is one lower if `end` and `reach` have the same sign, else one higher.
    let bits = end.to_bits() as i64;
    let towards_q = -(1 | ((bits ^ reach.to_bits() as i64) >> 63));
    let too_far = i64::from((end - q).abs() > reach.abs());
    f64::from_bits((bits + too_far * towards_q) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::{Field, Sinusoid};
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
        let mut tick = TickBox::around(&[q], limits);
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
        assert_eq!(LimitAt::Interval.of(&fading, 0.0, 1.0), 0.1);
        assert_eq!(LimitAt::Start.of(&fading, 0.0, 1.0), 0.4);
    }

    #[test]
    fn the_reach_is_the_same_at_any_time() {
        let limits = Limits::of(&slider(-9.0, 9.0, 2.0));
        let dt = 0.0005;
        for i in (0..60_000).step_by(7) {
            let mut tick = TickBox::around(&[0.1], &limits);
            let ends = [f64::from(i) * dt, f64::from(i + 1) * dt];
            limits.narrow(&[0.1], ends, dt, LimitAt::Interval, &mut tick);
            assert!(tick.bounds.upper()[0] - 0.1 <= 2.0 * dt && 0.1 - tick.bounds.lower()[0] <= 2.0 * dt, "{ends:?}");
        }
    }

    #[test]
    fn whatever_varies_is_found_anew_for_every_tick() {
        let wave =
            |phase: f64| Profile::Sinusoid(Sinusoid { mean: 2.0, amplitude: 0.5, angular_frequency: 3.0, phase });
        let numbers = vec![Profile::Constant(1.0), Profile::Constant(2.0), Profile::Constant(3.0)];
        let alike = vec![wave(0.0), wave(0.0), wave(0.0)];
        let apart = vec![wave(0.0), Profile::Constant(2.0), wave(1.0)];
        for (velocity, upper) in [(&alike, &numbers), (&apart, &alike), (&numbers, &apart)] {
            let limits = Limits::none_for(3).replace(Field::Velocity, velocity.clone());
            let limits = limits.and_then(|limits| limits.replace(Field::Upper, upper.clone())).unwrap();
            let mut tick = TickBox::around(&[0.0; 3], &limits);
            for i in 0..20 {
                let [from, to] = [i, i + 1].map(|i| f64::from(i) * 0.1);
                limits.narrow(&[0.0; 3], [from, to], 0.1, LimitAt::Interval, &mut tick);
                let mut written = [0.0; 3];
                limits.write_velocities([[from, to]].into_iter(), LimitAt::Interval, &mut written);
                for j in 0..3 {
                    let expected = LimitAt::Interval.of(&limits.velocity[j], from, to);
                    assert_eq!([tick.velocity[j], written[j]], [expected; 2], "joint {j} at {from} s");
                    assert_eq!([tick.floor[j], tick.ceiling[j]], limits.position_range(j, from, to));
                }
            }
        }
    }

    #[test]
    fn without_velocity_limits_every_box_is_that_of_the_positions() {
        let limits = Limits::of(&slider(-1.0, 2.0, f64::INFINITY));
        let mut tick = TickBox::around(&[0.3], &limits);
        for q in [0.3, -1.0, 2.0] {
            assert!(limits.narrow(&[q], [0.0, 0.1], 0.1, LimitAt::Interval, &mut tick));
            assert_eq!((tick.bounds.lower()[0], tick.bounds.upper()[0]), (-1.0, 2.0));
        }
    }

    proptest! {
        #[test]
        fn the_reach_is_used_to_the_last_bit(q in -3.0..3.0, reach in -1.0..1.0) {
            let end: f64 = reachable(q, reach);
            let beyond = if reach > 0.0 { end.next_up() } else { end.next_down() };
            prop_assert!((end - q).abs() <= reach.abs() && (beyond - q).abs() >= reach.abs());
        }

        #[test]
        fn no_displacement_exceeds_the_reach(q in -3.0..3.0, velocity in 0.0..2.0, dt in 1e-4..0.5) {
            let limits = Limits::of(&slider(-9.0, 9.0, velocity));
            let (_, lower, upper) = tick(&limits, q, dt);
            prop_assert!(upper - q <= velocity * dt && q - lower <= velocity * dt);
        }
    }
}
