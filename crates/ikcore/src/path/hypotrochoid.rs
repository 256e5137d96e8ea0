//! The hypotrochoid: the star of Khan et al., EAI Transactions on AI and Robotics 2022.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{Curve, Plane};
use crate::error::{Error, Result, require_positive};

/// A curve that needs more turns than this counts as one that never closes.
const MAX_TURNS: u32 = 100;

/// The curve drawn by a pen at distance d from the centre of a circle of radius r that rolls inside a circle of radius
/// R:
///
/// a: (R - r) cos u + d cos((R - r)/r u),  b: (R - r) sin u - d sin((R - r)/r u),  u from 0 to 2 pi LCM(r, R)/R.
///
/// This is Khan et al. 2022, eq. (20), corrected: as printed, with its axes (0, 1, 0) and (0, 0, 1), the second term of
/// the first line and the first of the second vanish, and no star remains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hypotrochoid {
    plane: Plane,
    /// R - r (m).
    arm: f64,
    /// d (m).
    distance: f64,
    /// (R - r)/r, from the ratio of integers, so that the curve closes exactly.
    spin: f64,
    end_angle: f64,
    duration: f64,
}

impl Hypotrochoid {
    /// The closed curve with these radii and this pen `distance` (m) about the centre of the plane, in `duration` (s).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a length or duration that is not positive, or an inner radius that does not fit inside
    /// the outer one; [`Error::InvalidPath`] for radii whose ratio is not one of small integers.
    pub fn new(plane: Plane, outer_radius: f64, inner_radius: f64, distance: f64, duration: f64) -> Result<Self> {
        require_positive("outer_radius", outer_radius)?;
        require_positive("inner_radius", inner_radius)?;
        require_positive("distance", distance)?;
        require_positive("duration", duration)?;
        if inner_radius >= outer_radius {
            return Err(Error::out_of_range("inner_radius", "smaller than outer_radius", inner_radius));
        }
        let (laps, turns) = integer_ratio(outer_radius, inner_radius)?;
        let spin = (laps - turns) / turns;
        Ok(Self { plane, arm: outer_radius - inner_radius, distance, spin, end_angle: TAU * turns, duration })
    }

    fn angle(&self, t: f64) -> f64 {
        self.end_angle * t.clamp(0.0, self.duration) / self.duration
    }
}

impl Curve for Hypotrochoid {
    fn duration(&self) -> f64 {
        self.duration
    }

    fn position(&self, t: f64) -> [f64; 3] {
        let u = self.angle(t);
        let (arm_sine, arm_cosine) = u.sin_cos();
        let (pen_sine, pen_cosine) = (self.spin * u).sin_cos();
        self.plane
            .point([self.arm * arm_cosine + self.distance * pen_cosine, self.arm * arm_sine - self.distance * pen_sine])
    }

    fn velocity(&self, t: f64) -> [f64; 3] {
        let u = self.angle(t);
        let rate = self.end_angle / self.duration;
        let (arm_sine, arm_cosine) = u.sin_cos();
        let (pen_sine, pen_cosine) = (self.spin * u).sin_cos();
        let (arm_speed, pen_speed) = (rate * self.arm, rate * self.spin * self.distance);
        self.plane
            .vector([-arm_speed * arm_sine - pen_speed * pen_sine, arm_speed * arm_cosine - pen_speed * pen_cosine])
    }
}

/// R / r as a ratio of integers in lowest terms, whose denominator LCM(r, R)/R is the number of turns of the arm.
fn integer_ratio(outer_radius: f64, inner_radius: f64) -> Result<(f64, f64)> {
    let ratio = outer_radius / inner_radius;
    // Radii such as 0.04 and 0.024 are ratios of integers only up to rounding.
    let closes = |turns: &f64| (turns * ratio - (turns * ratio).round()).abs() <= 1e-9;
    match (1..=MAX_TURNS).map(f64::from).find(closes) {
        Some(turns) => Ok(((turns * ratio).round(), turns)),
        None => Err(Error::InvalidPath {
            problem: format!(
                "outer_radius / inner_radius = {ratio} is no ratio of integers with a denominator up to {MAX_TURNS}, \
                 so the hypotrochoid does not close"
            ),
        }),
    }
}
