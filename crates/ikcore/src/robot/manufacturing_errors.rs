//! Robots with random manufacturing errors.

use super::description::Element;
use super::model::Robot;
use crate::error::{Error, Result};
use crate::rng::LazyRng;

impl Robot {
    /// Copy of the robot with manufacturing errors: every constant offset between two joints is longer or shorter by up to
    /// `length` (m) along its own direction, and the zero of every rotating joint is off by up to `angle` (rad), all
    /// drawn uniformly. Base and tool are unchanged.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a length or angle that is negative or not finite; [`Error::SeveralTips`].
    pub fn with_errors(&self, length: f64, angle: f64, rng: &mut LazyRng) -> Result<Self> {
        self.require_one_tip("with_errors")?;
        for (name, size) in [("length", length), ("angle", angle)] {
            if !(size.is_finite() && size >= 0.0) {
                return Err(Error::out_of_range(name, "zero or more and finite", size));
            }
        }
        let mut parts = self.parts().clone();
        for element in &mut parts.description.elements {
            match element {
                Element::Fixed(transform) => {
                    let offset = &mut transform.translation.vector;
                    let distance = offset.norm();
                    if distance > 0.0 {
                        *offset *= 1.0 + rng.uniform_in(-length, length) / distance;
                    }
                }
                Element::Moving { turns: true, offset, .. } => *offset += rng.uniform_in(-angle, angle),
                Element::Moving { .. } | Element::Curved { .. } | Element::RotationVector { .. } | Element::Link(_) => {
                }
            }
        }
        Self::assembled(parts)
    }
}
