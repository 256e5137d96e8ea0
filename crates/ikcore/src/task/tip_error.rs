//! Errors of the tip, and tolerances on them.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::wording::number;

/// Tolerances within which a target counts as reached.
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
    /// Raises both tolerances to at least `least` (m, rad).
    #[inline]
    pub fn at_least(&self, least: f64) -> Self {
        Self { position: self.position.max(least), rotation: self.rotation.max(least) }
    }

    /// Checks that both tolerances are positive.
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

/// Squared errors, which save the square root in hot loops; `None` for a part that the target leaves free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquaredError {
    /// Squared distance (m^2).
    pub position: Option<f64>,
    /// Squared angle (rad^2): to the target's orientation, or to the direction of its axis.
    pub rotation: Option<f64>,
}

impl SquaredError {
    /// Sum of both squared errors.
    #[inline(always)]
    pub(crate) fn sum(&self) -> f64 {
        self.position.unwrap_or(0.0) + self.rotation.unwrap_or(0.0)
    }

    /// Whether both errors are within `tolerance`. Since sqrt(x * x) is x, this is equivalent to comparing the errors.
    #[inline]
    pub fn within(&self, tolerance: &Tolerance) -> bool {
        self.position.is_none_or(|position| position <= tolerance.position * tolerance.position)
            && self.rotation.is_none_or(|rotation| rotation <= tolerance.rotation * tolerance.rotation)
    }
}

/// Errors of the tip; NaN for a part that the target leaves free.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TipError {
    /// Distance (m).
    pub position: f64,
    /// Geodesic angle (rad).
    pub rotation: f64,
}

impl TipError {
    /// Whether the errors of the parts that the target includes are within `tolerance`.
    #[inline]
    pub fn within(&self, tolerance: &Tolerance) -> bool {
        let is_within = |error: f64, largest: f64| error.is_nan() || error <= largest;
        is_within(self.position, tolerance.position) && is_within(self.rotation, tolerance.rotation)
    }
}

impl From<SquaredError> for TipError {
    fn from(squared: SquaredError) -> Self {
        let root = |squared: Option<f64>| squared.map_or(f64::NAN, f64::sqrt);
        Self { position: root(squared.position), rotation: root(squared.rotation) }
    }
}

impl fmt::Display for TipError {
    /// Writes the errors of the parts that the target includes, with units.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { position, rotation } = *self;
        match (position.is_nan(), rotation.is_nan()) {
            (false, true) => write!(f, "{} m", number(position)),
            (true, false) => write!(f, "{} rad", number(rotation)),
            _ => write!(f, "{} m and {} rad", number(position), number(rotation)),
        }
    }
}
