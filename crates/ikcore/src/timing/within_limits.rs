//! Motions of short phases, slowed to their limits.

use crate::error::Result;
use crate::trajectory::Trajectory;

/// Below this fraction of the duration, the rounding of times may make a segment exceed its limits.
const SHORT: f64 = 1e-6;

/// Relative excess of a limit that rounding may leave.
const EXCESS: f64 = 1e-9;

/// Times that a motion is slowed, because slower times are rounded anew.
const SLOWINGS: usize = 20;

/// Slows a motion from rest to rest where the rounding of its times makes it exceed the limits on velocity, acceleration
/// and jerk of its joints (n each, or none).
pub(crate) fn within_limits(mut motion: Trajectory, limits: [&[f64]; 3]) -> Result<Trajectory> {
    let shortest = motion.knots().windows(2).map(|ends| ends[1] - ends[0]).fold(f64::INFINITY, f64::min);
    if shortest > SHORT * motion.duration() {
        return Ok(motion);
    }
    let excess = |largest: Vec<f64>, limits: &[f64]| {
        largest.iter().zip(limits).map(|(largest, limit)| ratio(*largest, *limit)).fold(1.0, f64::max)
    };
    for _ in 0..SLOWINGS {
        let [velocity, acceleration, jerk] = limits;
        let factor = excess(motion.max_velocity(), velocity)
            .max(excess(motion.max_acceleration(), acceleration).sqrt())
            .max(excess(motion.max_jerk(), jerk).cbrt());
        if factor <= 1.0 + EXCESS {
            break;
        }
        motion = motion.slowed(factor)?;
    }
    Ok(motion)
}

/// `largest` as a multiple of its limit; 1 for a joint that may not move and does not.
fn ratio(largest: f64, limit: f64) -> f64 {
    if limit > 0.0 { largest / limit } else { 1.0 }
}
