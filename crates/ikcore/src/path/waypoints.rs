//! Points of a path without times.

use nalgebra::Matrix3;

use super::orientation::check_rotations;
use crate::error::{Error, Result, require_finite};
use crate::math::{Pose, pose};

/// Positions or poses, at least two, in the order in which the tip passes them.
#[derive(Debug, Clone, PartialEq)]
pub struct Waypoints {
    positions: Vec<[f64; 3]>,
    rotations: Option<Vec<Matrix3<f64>>>,
}

#[expect(clippy::len_without_is_empty, reason = "there are always at least two points")]
impl Waypoints {
    /// Waypoints at these positions (m), with one rotation each if `rotations` are given.
    ///
    /// # Errors
    /// [`Error::InvalidPath`] for fewer than 2 points, [`Error::WrongLength`] unless there is one rotation per position,
    /// [`Error::NotFinite`], [`Error::NotRigid`].
    pub fn new(positions: Vec<[f64; 3]>, rotations: Option<Vec<Matrix3<f64>>>) -> Result<Self> {
        check_points(&positions)?;
        let rotations = rotations.map(|rows| check_rotations(rows.into_iter())).transpose()?;
        match &rotations {
            Some(rows) if rows.len() != positions.len() => {
                let expected = format!("{}, one a position", positions.len());
                Err(Error::WrongLength { what: "path rotations".into(), expected, got: rows.len() })
            }
            _ => Ok(Self { positions, rotations }),
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// All positions (m).
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Position of point `i` (m).
    pub fn position(&self, i: usize) -> [f64; 3] {
        self.positions[i]
    }

    /// Rotation of point `i`, if there are rotations.
    pub fn rotation(&self, i: usize) -> Option<Matrix3<f64>> {
        self.rotations.as_ref().map(|rotations| rotations[i])
    }

    /// Position and rotation of point `i`, if there are rotations.
    pub fn pose(&self, i: usize) -> Option<Pose> {
        self.rotation(i).map(|rotation| pose::from_parts(self.position(i), rotation))
    }
}

/// Checks that there are at least two points and that all are finite.
pub(super) fn check_points(points: &[[f64; 3]]) -> Result<()> {
    if points.len() < 2 {
        let problem = format!("it needs at least 2 points, got {}", points.len());
        return Err(Error::InvalidPath { problem });
    }
    require_finite("path points", points.as_flattened(), |i| format!("{} of row {}", ["x", "y", "z"][i % 3], i / 3))
}
