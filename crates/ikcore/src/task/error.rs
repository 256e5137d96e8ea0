//! How far a tip is from its target, and when that is near enough.

use std::fmt;

use crate::error::{Error, Result};
use crate::wording::number;

/// When a target counts as reached.
#[derive(Debug, Clone, Copy, PartialEq)]
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

/// Squared errors, as solvers use them: no root is taken in hot loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquaredError {
    /// Squared distance (m^2).
    pub position: f64,
    /// Squared geodesic angle (rad^2); None where the target asks for no orientation.
    pub rotation: Option<f64>,
}

impl SquaredError {
    /// The sum of squares that solvers minimise.
    #[inline]
    pub fn sum(&self) -> f64 {
        self.position + self.rotation.unwrap_or(0.0)
    }

    /// Whether both errors are within `tolerance`. Since sqrt(x * x) is x, this is the comparison of the errors.
    #[inline]
    pub fn within(&self, tolerance: &Tolerance) -> bool {
        self.position <= tolerance.position * tolerance.position
            && self.rotation.is_none_or(|rotation| rotation <= tolerance.rotation * tolerance.rotation)
    }
}

/// The errors as a caller reads them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipError {
    /// Distance (m).
    pub position: f64,
    /// Geodesic angle (rad); NaN where the target asks for no orientation.
    pub rotation: f64,
}

impl From<SquaredError> for TipError {
    fn from(squared: SquaredError) -> Self {
        Self { position: squared.position.sqrt(), rotation: squared.rotation.map_or(f64::NAN, f64::sqrt) }
    }
}

impl fmt::Display for TipError {
    /// Both errors with their units; the angle only where it was asked for.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} m", number(self.position))?;
        if self.rotation.is_nan() { Ok(()) } else { write!(f, " and {} rad", number(self.rotation)) }
    }
}
