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

    /// Checks target `i`.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite), or [`Error::NotRigid`](crate::Error::NotRigid) for a pose.
    pub(super) fn check(&self, i: usize) -> Result<()> {
        match self {
            Self::Positions(rows) => Target::Position(rows[i]).validate(),
            Self::Poses(rows) => pose::check_matrix("target", &Matrix4::from_row_slice(&rows[i])),
        }
    }

    /// Target `i`, which was checked.
    #[inline]
    pub(super) fn read(&self, i: usize) -> Target {
        match self {
            Self::Positions(rows) => Target::Position(rows[i]),
            Self::Poses(rows) => Target::from(&pose::from_checked(&Matrix4::from_row_slice(&rows[i]))),
        }
    }
}
