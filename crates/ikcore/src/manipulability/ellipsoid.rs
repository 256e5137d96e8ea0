//! Ellipsoid of tip velocities.

use serde::{Deserialize, Serialize};

use crate::math::singular_values::SingularValues;

/// Ellipsoid of tip velocities for unit joint speeds, |q'| = 1: semi-axes, the longest first, one per direction of motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ellipsoid {
    /// Lengths of the semi-axes (m/s, rad/s).
    pub lengths: Vec<f64>,
    /// Directions of the semi-axes: linear, then angular part, in base coordinates.
    pub axes: Vec<[f64; 6]>,
}

impl Ellipsoid {
    pub(super) fn new(values: &SingularValues, directions: usize) -> Self {
        Self { lengths: values.lengths[..directions].to_vec(), axes: values.left[..directions].to_vec() }
    }

    /// Yoshikawa's index: the product of the lengths.
    pub fn index(&self) -> f64 {
        self.lengths.iter().product()
    }

    /// Condition number, the longest length over the shortest; infinite if a direction is lost.
    pub fn condition(&self) -> f64 {
        match (self.lengths.first(), self.lengths.last()) {
            (Some(longest), Some(shortest)) if *shortest > 0.0 => longest / shortest,
            _ => f64::INFINITY,
        }
    }

    /// Isotropy, the geometric over the arithmetic mean of the squared lengths (Kim and Khosla 1991): 1 for a sphere, 0 if a
    /// direction is lost.
    pub fn isotropy(&self) -> f64 {
        let m = self.lengths.len() as f64;
        let mean = self.lengths.iter().map(|length| length * length).sum::<f64>() / m;
        if mean > 0.0 { self.index().powf(2.0 / m) / mean } else { 0.0 }
    }
}
