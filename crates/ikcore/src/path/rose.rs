//! The rose.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use super::{Curve, Plane};
use crate::error::{Error, Result, require_positive};

/// A rose: r = radius cos(k u) at the angle u from the axis a; u grows at a constant rate. For odd k it has k petals,
/// drawn in half a turn; for even k it has 2 k, drawn in a full turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rose {
    plane: Plane,
    radius: f64,
    k: f64,
    end_angle: f64,
    duration: f64,
}

impl Rose {
    /// The closed rose with petals of length `radius` (m) about the plane's centre, in `duration` (s).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a radius or duration that is not positive, or k = 0.
    pub fn new(plane: Plane, radius: f64, k: u32, duration: f64) -> Result<Self> {
        require_positive("radius", radius)?;
        require_positive("duration", duration)?;
        if k == 0 {
            return Err(Error::out_of_range("k", "at least 1 (a rose without petals is a circle)", 0.0));
        }
        let end_angle = if k % 2 == 1 { PI } else { TAU };
        Ok(Self { plane, radius, k: f64::from(k), end_angle, duration })
    }

    fn angle(&self, t: f64) -> f64 {
        self.end_angle * t.clamp(0.0, self.duration) / self.duration
    }
}

impl Curve for Rose {
    fn duration(&self) -> f64 {
        self.duration
    }

    fn position(&self, t: f64) -> [f64; 3] {
        let u = self.angle(t);
        let r = self.radius * (self.k * u).cos();
        self.plane.point([r * u.cos(), r * u.sin()])
    }

    fn velocity(&self, t: f64) -> [f64; 3] {
        let u = self.angle(t);
        let rate = self.end_angle / self.duration;
        let r = self.radius * (self.k * u).cos();
        let dr = -self.radius * self.k * (self.k * u).sin();
        self.plane.vector([rate * (dr * u.cos() - r * u.sin()), rate * (dr * u.sin() + r * u.cos())])
    }
}
