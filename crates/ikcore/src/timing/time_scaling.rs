//! Scaling of a whole motion in time, by one factor.

use super::constant_limits::ConstantLimits;
use crate::constraint::TIGHT;
use crate::error::{Error, Result};
use crate::limits::{ROUNDING, no_pace};
use crate::message::{Setting, message};
use crate::trajectory::Trajectory;
use crate::wording::{number, time};

/// Durations exceed the exact ones by this factor, so that rounding violates no limit.
pub(super) const CAUTION: f64 = 1.0 + 1e-12;

/// Jumps of an acceleration at a knot that count as rounding, relative to the largest acceleration of the joint.
const JUMP_ROUNDING: f64 = 1e-6;

/// Longest segment, as a fraction of the duration, that the rounding of times may take beyond its limits.
const SHORT: f64 = 1e-6;

/// Maximum number of times that a motion is slowed, because slower times are rounded anew.
const SLOWINGS: usize = 20;

impl ConstantLimits {
    /// Factor by which `motion` must be slowed down to keep the limits of its joints on velocity, acceleration and jerk, and those of
    /// tips; below 1 it can be faster.
    pub(super) fn slowdown(&self, motion: &Trajectory) -> f64 {
        let extremes = [motion.max_velocity(), motion.max_acceleration(), motion.max_jerk()];
        let of_joint = |j: usize| self.joint_slowdown(j, extremes.each_ref().map(|of| of[j]));
        let of_joints = (0..self.dof()).map(of_joint).fold(0.0, f64::max);
        let of_whole = if self.limit_whole() { self.whole_slowdown(motion, of_joints) } else { 0.0 };
        if of_whole > of_joints { of_whole * (1.0 + TIGHT) } else { of_joints }
    }

    /// Slowdown factor of one joint with these velocity, acceleration and jerk: the k-th derivative scales with the
    /// k-th power of time. A joint that may not move does not.
    pub(super) fn joint_slowdown(&self, joint: usize, [velocity, acceleration, jerk]: [f64; 3]) -> f64 {
        let ratio = |value: f64, limit: f64| if limit > 0.0 { value.abs() / limit } else { 0.0 };
        ratio(velocity, self.velocity[joint])
            .max(ratio(acceleration, self.acceleration[joint]).sqrt())
            .max(ratio(jerk, self.jerk[joint]).cbrt())
    }
}

/// Returns the motion, faster or slower by one factor, as fast as the limits on velocity, acceleration and jerk allow.
pub(crate) fn scaled(motion: &Trajectory, limits: &ConstantLimits) -> Result<Trajectory> {
    if limits.limit_jerk() {
        refuse_jumps(motion, limits)?;
    }
    let factor = limits.slowdown(motion);
    limits.require_holdable(factor)?;
    if factor == 0.0 {
        return Err(no_pace(&[limits.joint_name(0)], ""));
    }
    within_limits(motion.slowed(factor * CAUTION)?, limits)
}

/// Slows a motion from rest to rest where it exceeds the limits of tips or torques, or where the rounding of its times makes it exceed
/// those on velocity, acceleration and jerk of its joints.
pub(super) fn within_limits(motion: Trajectory, limits: &ConstantLimits) -> Result<Trajectory> {
    without_rounding(limits.slowed_as_a_whole(motion)?, limits)
}

/// Slows a motion from rest to rest where the rounding of its times makes it exceed the limits.
pub(super) fn without_rounding(mut motion: Trajectory, limits: &ConstantLimits) -> Result<Trajectory> {
    let shortest = motion.knots().windows(2).map(|ends| ends[1] - ends[0]).fold(f64::INFINITY, f64::min);
    if shortest > SHORT * motion.duration() {
        return Ok(motion);
    }
    for _ in 0..SLOWINGS {
        let factor = limits.slowdown(&motion);
        if factor <= 1.0 + ROUNDING {
            break;
        }
        motion = motion.slowed(factor)?;
    }
    Ok(motion)
}

/// Checks that the acceleration does not jump, neither at a knot nor from or to rest.
fn refuse_jumps(motion: &Trajectory, limits: &ConstantLimits) -> Result<()> {
    let (n, largest, steepest) = (limits.dof(), motion.max_acceleration(), motion.max_jerk());
    let [mut before, mut after, mut at_end] = [(); 3].map(|()| vec![0.0; n]);
    for (i, &t) in motion.knots().iter().enumerate() {
        after.fill(0.0);
        if i + 1 < motion.knots().len() {
            motion.end_accelerations(i, &mut after, &mut at_end);
        }
        // The end of a short segment late in a motion is rounded with its time.
        let rounding = |j: usize| JUMP_ROUNDING * largest[j] + 4.0 * f64::EPSILON * t * steepest[j];
        let jump = |j: &usize| (after[*j] - before[*j]).abs() > rounding(*j).max(f64::MIN_POSITIVE);
        let limited = (0..n).filter(|j| limits.jerk[*j].is_finite());
        if let Some(j) = limited.filter(|j| largest[*j] > 0.0).find(jump) {
            let (joint, t) = (limits.joint_name(j), time(t));
            let (from, to) = (number(before[j]), number(after[j]));
            let jump = format!(
                "the acceleration of joint '{joint}' jumps from {from} to {to} at t = {t} s, which no jerk limit allows: plan with "
            );
            let problem = message![jump, Setting::Limit("jerk"), " instead"];
            return Err(Error::Infeasible { problem });
        }
        std::mem::swap(&mut before, &mut at_end);
    }
    Ok(())
}
