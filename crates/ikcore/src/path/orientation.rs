//! Checks that the orientations of a path are rotations.

use nalgebra::Matrix3;

use crate::error::Result;
use crate::interrupt::checkpoint_at;
use crate::math::pose;

/// Returns the rotation, made exactly orthonormal; `what` names it in errors.
pub(super) fn check_rotation(what: &str, rotation: &Matrix3<f64>) -> Result<Matrix3<f64>> {
    Ok(pose::from_matrix(what, &rotation.to_homogeneous())?.rotation.into_inner())
}

/// Returns the rotations of all rows, made exactly orthonormal; errors name the row.
pub(super) fn check_rotations(rows: impl Iterator<Item = Matrix3<f64>>) -> Result<Vec<Matrix3<f64>>> {
    let check = |(row, rotation)| {
        checkpoint_at(row)?;
        check_rotation(&format!("path rotation of row {row}"), &rotation)
    };
    rows.enumerate().map(check).collect()
}
