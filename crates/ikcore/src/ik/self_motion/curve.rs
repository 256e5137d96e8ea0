//! Curve of a self-motion.

use serde::{Deserialize, Serialize};

use crate::math::vector::distance;

/// Curve of configurations, all with the tip at the target and within the limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SelfMotion {
    pub(super) joints: usize,
    /// Configurations (k, n), row by row.
    pub(super) values: Vec<f64>,
    /// Whether the last configuration is followed by the first, whole turns of joints without limits aside.
    pub closed: bool,
    /// Joint whose limit ends the curve at its first configuration.
    pub lower_cut: Option<usize>,
    /// Joint whose limit ends the curve at its last configuration.
    pub upper_cut: Option<usize>,
    /// Whether the closed form proves that there is no other curve: each passes every arm angle, and none crosses another, as at a
    /// singular pose.
    pub complete: bool,
}

impl SelfMotion {
    /// Single configuration, through which no curve could be followed.
    pub(super) fn single(q: &[f64]) -> Self {
        Self { joints: q.len(), values: q.to_vec(), closed: false, lower_cut: None, upper_cut: None, complete: false }
    }

    /// Configurations (k, n), row by row (rad, m).
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Iterates over the configurations in order (rad, m).
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.values.chunks_exact(self.joints)
    }

    /// Length in joint space (rad, m).
    pub fn length(&self) -> f64 {
        self.iter().zip(self.iter().skip(1)).map(|(a, b)| distance(a, b)).sum()
    }
}
