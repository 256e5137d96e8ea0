//! The fastest motion along a straight line of all joints, in closed form.

use super::super::constant_limits::ConstantLimits;
use super::super::joint_path::JointPath;
use super::super::time_scaling::{CAUTION, without_rounding};
use crate::error::Result;
use crate::math::one_joint::{MotionState, Rates, Transfer};
use crate::trajectory::{Trajectory, polynomial};

/// Returns the fastest motion from rest to rest along a path of a single straight piece; `None` for other paths, and with limits of tips or
/// torques, which change along it.
///
/// # Errors
/// None in practice: the path is valid.
pub(super) fn straight_line(path: &JointPath, limits: &ConstantLimits) -> Result<Option<Trajectory>> {
    let [start, slope, second, third] = path.powers(0);
    let is_straight = path.pieces() == 1 && second.iter().chain(third).all(|power| *power == 0.0);
    if !is_straight || limits.limit_whole() {
        return Ok(None);
    }
    // Limits of the path parameter.
    let largest = |of_joints: &[f64]| {
        let of_joint = |(limit, slope): (&f64, &f64)| if *slope == 0.0 { f64::INFINITY } else { limit / slope.abs() };
        of_joints.iter().zip(slope).map(of_joint).fold(f64::INFINITY, f64::min) / CAUTION
    };
    let rates = Rates {
        velocity: largest(&limits.velocity).min(path.largest_speed(0)),
        acceleration: largest(&limits.acceleration),
        jerk: largest(&limits.jerk),
    };
    let is_limited = rates.acceleration > 0.0 && rates.jerk > 0.0 && rates.jerk.is_finite() && rates.velocity > 0.0;
    if !is_limited {
        return Ok(None);
    }
    let transfer = Transfer::new(MotionState::rest(0.0), MotionState::rest(path.length(0)), &rates);
    let profile = transfer.motion(transfer.duration(0.0));
    let mut knots: Vec<f64> = profile.segments.iter().map(|segment| segment.time).collect();
    knots.push(profile.duration);
    let coefficients = profile.segments.iter().flat_map(|segment| {
        let MotionState { q, v, a } = segment.state;
        let along = [q, v, 0.5 * a, segment.jerk / 6.0];
        start.iter().zip(slope).map(move |(start, slope)| {
            let [c0, c1, c2, c3] = along.map(|c| c * slope);
            polynomial([start + c0, c1, c2, c3])
        })
    });
    let motion = Trajectory::from_phases(path.joints().to_vec(), knots, coefficients.collect())?;
    without_rounding(motion, limits).map(Some)
}
