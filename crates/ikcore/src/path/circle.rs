//! The circle of Cheng et al., IEEE Access 2020.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{Curve, Plane};
use crate::error::{Result, require_positive};

/// One turn of a circle at constant speed, from the axis a towards b: p(t) = p0 + D/2 cos(2 pi t/T) A + D/2 sin(2 pi
/// t/T) B (Cheng et al. 2020, eq. (14); the paper does not state that A and B must be orthonormal).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Circle {
    plane: Plane,
    radius: f64,
    duration: f64,
}

impl Circle {
    /// The circle of this `diameter` (m) about the plane's centre, in `duration` (s).
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a diameter or duration that is not positive.
    pub fn new(plane: Plane, diameter: f64, duration: f64) -> Result<Self> {
        require_positive("diameter", diameter)?;
        require_positive("duration", duration)?;
        Ok(Self { plane, radius: 0.5 * diameter, duration })
    }

    fn angle(&self, t: f64) -> f64 {
        TAU * t.clamp(0.0, self.duration) / self.duration
    }
}

impl Curve for Circle {
    fn duration(&self) -> f64 {
        self.duration
    }

    fn position(&self, t: f64) -> [f64; 3] {
        let (sine, cosine) = self.angle(t).sin_cos();
        self.plane.point([self.radius * cosine, self.radius * sine])
    }

    fn velocity(&self, t: f64) -> [f64; 3] {
        let (sine, cosine) = self.angle(t).sin_cos();
        let speed = self.radius * TAU / self.duration;
        self.plane.vector([-speed * sine, speed * cosine])
    }
}
