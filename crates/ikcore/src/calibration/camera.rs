//! The pinhole camera.

use nalgebra::{Matrix2x3, Vector3};

use crate::error::{Result, require_finite, require_positive};

/// Pinhole camera without distortion: u = fx x / z + cx, v = fy y / z + cy, with z along the view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinholeCamera {
    /// Focal lengths (pixels).
    pub focal: [f64; 2],
    /// Principal point (pixels).
    pub centre: [f64; 2],
}

/// Depth below which a point counts as behind the camera (m): its image then follows the tangent, so that a fit can recover.
const NEAREST: f64 = 1e-3;

impl PinholeCamera {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) or [`Error::NotFinite`](crate::Error::NotFinite).
    pub fn validate(&self) -> Result<()> {
        self.focal.iter().try_for_each(|focal| require_positive("focal length (pixels)", *focal))?;
        require_finite("principal point", &self.centre, |i| format!("entry {i}"))
    }

    /// Image of a point in the camera's frame, and its derivative.
    pub(super) fn image(&self, point: &Vector3<f64>) -> ([f64; 2], Matrix2x3<f64>) {
        let ([fx, fy], [cx, cy]) = (self.focal, self.centre);
        let near = point.z.max(NEAREST);
        // 1 / z and its derivative; behind the camera along the tangent.
        let slope = -1.0 / (near * near);
        let inverse = 1.0 / near + slope * (point.z - near);
        let slopes = Matrix2x3::new(fx * inverse, 0.0, fx * point.x * slope, 0.0, fy * inverse, fy * point.y * slope);
        ([fx * point.x * inverse + cx, fy * point.y * inverse + cy], slopes)
    }

    /// Direction of an image point, with depth one.
    pub(super) fn ray(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [(u - self.centre[0]) / self.focal[0], (v - self.centre[1]) / self.focal[1]]
    }

    /// Whether a point is in front of the camera and inside an image of which the principal point is the middle.
    pub(super) fn sees(&self, point: &Vector3<f64>) -> bool {
        let ([u, v], _) = self.image(point);
        let inside = |value: f64, centre: f64| (0.0..=2.0 * centre).contains(&value);
        point.z > NEAREST && inside(u, self.centre[0]) && inside(v, self.centre[1])
    }
}
