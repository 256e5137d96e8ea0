//! The five-pointed star, drawn in one line.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::{Plane, Polyline};
use crate::error::{Result, require_positive};

impl Polyline {
    /// The pentagram with its points at `radius` (m) from the centre of the plane, in `duration` (s): five segments of
    /// equal length and speed, starting and ending at the point along b.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a radius or duration that is not positive.
    pub fn pentagram(plane: &Plane, radius: f64, duration: f64) -> Result<Self> {
        require_positive("radius", radius)?;
        let vertices = [0, 2, 4, 1, 3, 0].map(|point| {
            let (sine, cosine) = (FRAC_PI_2 + TAU * f64::from(point) / 5.0).sin_cos();
            plane.point([radius * cosine, radius * sine])
        });
        Self::equal_times(vertices, duration)
    }
}
