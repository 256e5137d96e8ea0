//! The quintic from rest to rest: 10 t^3 - 15 t^4 + 6 t^5 of the displacement after the fraction t of the duration.

use super::constant_limits::ConstantLimits;
use crate::trajectory::{Coefficients, polynomial};

/// Largest speed, relative to displacement / duration.
const SPEED: f64 = 15.0 / 8.0;
/// Largest acceleration, relative to displacement / duration^2: 10 / sqrt(3).
const ACCELERATION: f64 = 5.773_502_691_896_258;
/// Largest jerk, relative to displacement / duration^3.
const JERK: f64 = 60.0;

/// Coefficients of the quintic from `start` over `displacement` in `duration` (s).
pub(super) fn quintic(start: f64, displacement: f64, duration: f64) -> Coefficients {
    let over = |power: i32| displacement / duration.powi(power);
    polynomial([start, 0.0, 0.0, 10.0 * over(3), -15.0 * over(4), 6.0 * over(5)])
}

/// Position, speed and acceleration of the quintic from 0 to 1 in unit time, at `t`.
pub(crate) fn unit_quintic(t: f64) -> [f64; 3] {
    let rest = 1.0 - t;
    [t * t * t * (10.0 + t * (6.0 * t - 15.0)), 30.0 * (t * rest).powi(2), 60.0 * t * rest * (1.0 - 2.0 * t)]
}

impl ConstantLimits {
    /// Returns the shortest time (s) in which a quintic from rest to rest covers these displacements (rad, m).
    pub(crate) fn quintic_duration(&self, displacement: impl Iterator<Item = f64>) -> f64 {
        let of_joint = |(j, displacement): (usize, f64)| {
            let size = displacement.abs();
            if size == 0.0 {
                return 0.0;
            }
            (SPEED * size / self.velocity[j])
                .max((ACCELERATION * size / self.acceleration[j]).sqrt())
                .max((JERK * size / self.jerk[j]).cbrt())
        };
        displacement.enumerate().map(of_joint).fold(0.0, f64::max)
    }

    /// Returns the displacement of joint `j` (rad, m) that a quintic can cover in `duration` (s).
    pub(crate) fn quintic_reach(&self, j: usize, duration: f64) -> f64 {
        let by_speed = self.velocity[j] * duration / SPEED;
        by_speed
            .min(self.acceleration[j] * duration * duration / ACCELERATION)
            .min(self.jerk[j] * duration.powi(3) / JERK)
    }
}
