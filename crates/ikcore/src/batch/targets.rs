//! Targets of a batch.

use nalgebra::Matrix4;

use crate::error::{Error, Result};
use crate::math::pose;
use crate::task::{Target, TargetRow, check_point};

/// Targets of a batch as arrays of m rows, not yet checked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Targets<'a> {
    /// Positions (m); the orientation is free.
    Positions(&'a [[f64; 3]]),
    /// Poses: homogeneous 4x4 matrices, each row-major.
    Poses(&'a [[f64; 16]]),
    /// Targets of several tips: one array per task, all of the same length.
    Tips(&'a [Targets<'a>]),
}

impl Targets<'_> {
    /// Number of targets.
    pub fn len(&self) -> usize {
        match self {
            Self::Positions(rows) => rows.len(),
            Self::Poses(rows) => rows.len(),
            Self::Tips(tasks) => tasks.first().map_or(0, Targets::len),
        }
    }

    /// Whether there are no targets.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Checks target `i`.
    ///
    /// # Errors
    /// As [`Target::validate`], and [`Error::NotRigid`] for a pose.
    pub(super) fn check(&self, i: usize) -> Result<()> {
        match self {
            Self::Positions(rows) => Target::Position(rows[i]).validate(),
            Self::Poses(rows) => {
                pose::check_matrix("target", &Matrix4::from_row_slice(&rows[i]))?;
                check_point("target", &[3, 7, 11].map(|entry| rows[i][entry]))
            }
            Self::Tips(tasks) => tasks.iter().try_for_each(|task| task.check(i)),
        }
    }

    /// Targets of row `i`, already checked: one for each task.
    #[inline]
    pub fn read(&self, i: usize) -> TargetRow {
        match self {
            Self::Positions(rows) => TargetRow::from_buf([Target::Position(rows[i])]),
            Self::Poses(rows) => {
                TargetRow::from_buf([Target::from(&pose::from_checked(&Matrix4::from_row_slice(&rows[i])))])
            }
            Self::Tips(tasks) => tasks.iter().flat_map(|task| task.read(i)).collect(),
        }
    }

    /// Checks that all tasks of several tips have the same number of targets.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub(super) fn require_even(&self) -> Result<()> {
        let Self::Tips(tasks) = self else { return Ok(()) };
        match tasks.iter().enumerate().find(|(_, task)| task.len() != self.len()) {
            None => Ok(()),
            Some((i, task)) => {
                let expected = format!("{} as for the first tip", self.len());
                Err(Error::WrongLength { what: format!("targets of task {i}").into(), expected, got: task.len() })
            }
        }
    }
}
