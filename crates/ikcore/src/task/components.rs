//! Weights and tolerances of a target's six components.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::math::box_step::ROWS;

/// Weights and tolerances of the components: x, y, z (m) and the three entries of the rotation vector (rad), along the axes of
/// the target frame, or of the base if the target is only a position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Components {
    /// Factors on the residuals; a component of weight zero is left free.
    pub weights: [f64; ROWS],
    /// Largest error of each component (m, rad), instead of [`Tolerance`](super::Tolerance). For a pointing target, the
    /// fourth entry is the angle between the axes.
    pub tolerance: Option<[f64; ROWS]>,
}

impl Components {
    /// Checks weights and tolerances.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the entry.
    pub fn validate(&self) -> Result<()> {
        check_weights(&self.weights)?;
        self.tolerance.as_ref().map_or(Ok(()), |tolerance| check_tolerances(tolerance))
    }
}

/// Checks that no weight is negative, and that at least one is positive.
pub(super) fn check_weights(weights: &[f64]) -> Result<()> {
    match weights.iter().position(|weight| !(*weight >= 0.0 && weight.is_finite())) {
        Some(i) => Err(Error::out_of_range(format!("weights[{i}]"), "zero or more, and finite", weights[i])),
        None if weights.iter().all(|weight| *weight == 0.0) => {
            Err(Error::out_of_range("the largest of weights", "positive", 0.0))
        }
        None => Ok(()),
    }
}

/// Checks that tolerances are positive; infinite ones are allowed.
pub(super) fn check_tolerances(tolerances: &[f64]) -> Result<()> {
    match tolerances.iter().position(|tolerance| !(*tolerance > 0.0)) {
        Some(i) => Err(Error::out_of_range(format!("tolerance[{i}]"), "positive", tolerances[i])),
        None => Ok(()),
    }
}
