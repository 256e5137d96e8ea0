//! A whole motion, faster or slower by one factor.

use super::motion_limits::MotionLimits;
use super::within_limits::within_limits;
use crate::error::{Error, Result};
use crate::message::{Setting, message};
use crate::trajectory::Trajectory;
use crate::wording::{number, time};

/// Slower than necessary by this factor, so that rounding violates no limit.
const CAUTION: f64 = 1.0 + 1e-12;

/// Jumps of an acceleration at a knot that count as rounding, relative to the largest acceleration of the joint.
const ROUNDING: f64 = 1e-6;

/// The motion, faster or slower by one factor, as fast as the limits on velocity, acceleration and jerk allow.
pub(crate) fn scaled(motion: &Trajectory, limits: &MotionLimits) -> Result<Trajectory> {
    if limits.limit_jerk() {
        refuse_jumps(motion, limits)?;
    }
    let largest = |reached: Vec<f64>, limits: &[f64]| {
        reached.iter().zip(limits).map(|(reached, limit)| reached / limit).fold(0.0, f64::max)
    };
    let factor = largest(motion.max_velocity(), &limits.velocity)
        .max(largest(motion.max_acceleration(), &limits.acceleration).sqrt())
        .max(largest(motion.max_jerk(), &limits.jerk).cbrt());
    if factor == 0.0 {
        return Err(Error::no_pace(limits.joint_name(0)));
    }
    within_limits(motion.slowed(factor * CAUTION)?, [&limits.velocity, &limits.acceleration, &limits.jerk])
}

/// Checks that the acceleration does not jump, neither at a knot nor from or to rest.
fn refuse_jumps(motion: &Trajectory, limits: &MotionLimits) -> Result<()> {
    let (n, largest, steepest) = (limits.dof(), motion.max_acceleration(), motion.max_jerk());
    let [mut before, mut after, mut at_end] = [(); 3].map(|()| vec![0.0; n]);
    for (i, &t) in motion.knots().iter().enumerate() {
        after.fill(0.0);
        if i + 1 < motion.knots().len() {
            motion.end_accelerations(i, &mut after, &mut at_end);
        }
        // The end of a short segment late in a motion is rounded with its time.
        let rounding = |j: usize| ROUNDING * largest[j] + 4.0 * f64::EPSILON * t * steepest[j];
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
