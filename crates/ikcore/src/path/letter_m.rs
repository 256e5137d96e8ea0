//! The letter M of Khan et al., EAI Transactions on AI and Robotics 2022.

use super::{Plane, Polyline};
use crate::error::{Result, require_positive};

impl Polyline {
    /// The letter M, from its lower left corner, centred in the plane: `width` (m) along a, `height` (m) along b, in
    /// `duration` (s).
    ///
    /// The segments are those of Khan et al. 2022, eq. (19). The paper leaves their times open: here they take equal
    /// times, so the two short segments are slower.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a width, height or duration that is not positive.
    pub fn letter_m(plane: &Plane, width: f64, height: f64, duration: f64) -> Result<Self> {
        require_positive("width", width)?;
        require_positive("height", height)?;
        let corners = [[-0.5, -0.5], [-0.5, 0.5], [0.0, 0.0], [0.5, 0.5], [0.5, -0.5]];
        let vertices = corners.map(|[a, b]| plane.point([a * width, b * height]));
        Self::equal_times(vertices, duration)
    }
}
