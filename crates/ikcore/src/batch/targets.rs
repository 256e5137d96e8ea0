//! The targets of a batch.

use nalgebra::Matrix4;

use crate::error::Result;
use crate::math::pose;
use crate::task::Target;

/// The targets of a batch as arrays of m rows, not yet checked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Targets<'a> {
    /// Positions (m); the orientation is free.
    Positions(&'a [[f64; 3]]),
    /// Poses: homogeneous 4x4 matrices, each row-major.
    Poses(&'a [[f64; 16]]),
}

impl Targets<'_> {
    /// Number of targets.
    pub fn len(&self) -> usize {
        match self {
            Self::Positions(rows) => rows.len(),
            Self::Poses(rows) => rows.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Target `i`; a pose is checked to be rigid.
    pub(super) fn read(&self, i: usize) -> Result<Target> {
        match self {
            Self::Positions(rows) => Ok(Target::Position(rows[i])),
            Self::Poses(rows) => {
                pose::from_matrix("target", &Matrix4::from_row_slice(&rows[i])).map(|pose| Target::from(&pose))
            }
        }
    }
}
