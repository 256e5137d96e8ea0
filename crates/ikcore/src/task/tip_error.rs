//! How far a tip is from its target, and when that is near enough.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::wording::number;

/// When a target counts as reached.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tolerance {
    /// Largest distance of the tip from the target (m).
    pub position: f64,
    /// Largest geodesic angle to the target's orientation (rad).
    pub rotation: f64,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { position: 1e-6, rotation: 1e-6 }
    }
}

impl Tolerance {
    /// Checks that both are positive.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for zero, negative or NaN.
    pub fn validate(&self) -> Result<()> {
        for (what, value) in [("position_tolerance", self.position), ("rotation_tolerance", self.rotation)] {
            if value.is_nan() || value <= 0.0 {
                return Err(Error::out_of_range(what, "positive", value));
            }
        }
        Ok(())
    }
}

/// Squared errors, as solvers use them: no root is taken in hot loops. None is what a target does not ask for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquaredError {
    /// Squared distance (m^2).
    pub position: Option<f64>,
    /// Squared angle (rad^2): to the target's orientation, or to the direction that an axis is to have.
    pub rotation: Option<f64>,
}

impl SquaredError {
    /// The sum of both.
    #[inline(always)]
    pub(super) fn sum(&self) -> f64 {
        self.position.unwrap_or(0.0) + self.rotation.unwrap_or(0.0)
    }

    /// Whether both errors are within `tolerance`. Since sqrt(x * x) is x, this is the comparison of the errors.
    #[inline]
    pub fn within(&self, tolerance: &Tolerance) -> bool {
        self.position.is_none_or(|position| position <= tolerance.position * tolerance.position)
            && self.rotation.is_none_or(|rotation| rotation <= tolerance.rotation * tolerance.rotation)
    }
}

/// The errors as a caller reads them; NaN is what the target does not ask for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TipError {
    /// Distance (m).
    pub position: f64,
    /// Geodesic angle (rad).
    pub rotation: f64,
}

impl From<SquaredError> for TipError {
    fn from(squared: SquaredError) -> Self {
        let root = |squared: Option<f64>| squared.map_or(f64::NAN, f64::sqrt);
        Self { position: root(squared.position), rotation: root(squared.rotation) }
    }
}

impl fmt::Display for TipError {
    /// What was asked for, with its unit.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { position, rotation } = *self;
        match (position.is_nan(), rotation.is_nan()) {
            (false, true) => write!(f, "{} m", number(position)),
            (true, false) => write!(f, "{} rad", number(rotation)),
            _ => write!(f, "{} m and {} rad", number(position), number(rotation)),
        }
    }
}
