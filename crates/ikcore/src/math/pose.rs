//! Construction of rigid transforms, and validation of 4x4 matrices.

use std::f64::consts::PI;
use std::fmt;

use nalgebra::{Matrix3, Matrix4, Quaternion, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};

use super::Pose;
use crate::error::{Error, Result, given, require_finite};

/// Largest deviation of R'R from the identity, entry by entry, for R to count as a rotation: that of three decimals.
const ORTHOGONALITY_TOLERANCE: f64 = 2e-3;

/// Largest deviation of a rotation that was multiplied for long and never made a rotation again.
const DRIFT_TOLERANCE: f64 = 0.25;

/// Rounding of the last row of a pose.
const LAST_ROW_TOLERANCE: f64 = 1e-6;

/// Deviation up to which Gram-Schmidt finds the nearest rotation but for rounding.
const GRAM_SCHMIDT: f64 = 1e-6;

/// Newton steps to the nearest rotation, from the largest drift; each squares the deviation.
const NEWTON_STEPS: usize = 5;

/// Builds a transform from its parts; `rotation` must be a rotation matrix.
pub fn from_parts(translation: [f64; 3], rotation: Matrix3<f64>) -> Pose {
    Pose::from_parts(Translation3::from(translation), Rotation3::from_matrix_unchecked(rotation))
}

/// Returns a pure translation (m).
pub fn translation(x: f64, y: f64, z: f64) -> Pose {
    from_parts([x, y, z], Matrix3::identity())
}

/// Returns a pure rotation by `angle` (rad) about a unit `axis`.
pub fn rotation(axis: Vector3<f64>, angle: f64) -> Pose {
    let axis = Unit::new_unchecked(axis);
    Pose::from_parts(Translation3::identity(), Rotation3::from_axis_angle(&axis, angle))
}

/// Rotation by the smallest angle that makes `axis` point along `direction`, both of any length but zero.
pub fn turning(axis: [f64; 3], direction: [f64; 3]) -> Pose {
    let [axis, direction] = [axis, direction].map(Vector3::from);
    let turn = Rotation3::rotation_between(&axis, &direction).unwrap_or_else(|| {
        // Opposite to each other: half a turn about any axis across, here one far from both.
        let across = axis.cross(&Vector3::ith(axis.iamin(), 1.0));
        Rotation3::from_axis_angle(&Unit::new_normalize(across), PI)
    });
    from_parts([0.0; 3], turn.into_inner())
}

/// Builds a transform from fixed-axis roll, pitch and yaw (rad), R = Rz(yaw) Ry(pitch) Rx(roll), as in URDF.
pub fn from_rpy(rpy: [f64; 3], translation: [f64; 3]) -> Pose {
    Pose::from_parts(Translation3::from(translation), Rotation3::from_euler_angles(rpy[0], rpy[1], rpy[2]))
}

/// Builds a transform from a quaternion (x, y, z, w) of any nonzero length.
///
/// # Errors
/// [`Error::OutOfRange`] for a zero quaternion.
pub fn from_quaternion(xyzw: [f64; 4], translation: [f64; 3]) -> Result<Pose> {
    let [x, y, z, w] = xyzw;
    let quaternion = Quaternion::new(w, x, y, z);
    let length = quaternion.norm();
    if !(length.is_finite() && length > 0.0) {
        return Err(Error::out_of_range("length of the quaternion", "positive and finite", length));
    }
    let rotation = UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix();
    Ok(Pose::from_parts(Translation3::from(translation), rotation))
}

/// Builds a transform from a rotation vector (rad), whose length is the angle about its direction.
pub fn from_rotation_vector(rotation_vector: [f64; 3], translation: [f64; 3]) -> Pose {
    Pose::from_parts(Translation3::from(translation), Rotation3::new(Vector3::from(rotation_vector)))
}

/// Builds a transform from a 3x3 rotation matrix; `what` names the matrix in errors.
///
/// # Errors
/// As [`from_matrix`].
pub fn from_rotation_matrix(what: &str, rotation: Matrix3<f64>, translation: [f64; 3]) -> Result<Pose> {
    let mut matrix = rotation.to_homogeneous();
    matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&Vector3::from(translation));
    from_matrix(what, &matrix)
}

/// Checks that a pose is finite.
///
/// # Errors
/// [`Error::NotFinite`]; `what` names the pose.
pub fn checked(what: &str, pose: Pose) -> Result<Pose> {
    require_finite(what, pose.to_homogeneous().as_slice(), |i| format!("entry ({}, {})", i % 4, i / 4))?;
    Ok(pose)
}

/// Checks that a point or three angles are finite.
///
/// # Errors
/// [`Error::NotFinite`]; `what` names the values.
pub fn finite(what: &str, values: [f64; 3]) -> Result<[f64; 3]> {
    require_finite(what, &values, |i| format!("entry {i}"))?;
    Ok(values)
}

/// Returns the 16 entries of a pose in row-major order.
pub fn rows(pose: &Pose) -> [f64; 16] {
    let (r, p) = (pose.rotation.matrix(), &pose.translation);
    [
        r.m11, r.m12, r.m13, p.x, //
        r.m21, r.m22, r.m23, p.y, //
        r.m31, r.m32, r.m33, p.z, //
        0.0, 0.0, 0.0, 1.0,
    ]
}

/// Reads a homogeneous 4x4 matrix; `what` names the matrix in errors.
///
/// # Errors
/// [`Error::NotFinite`] for NaN or infinity; [`Error::NotRigid`] if the last row is not (0, 0, 0, 1), or the rotation is not
/// orthonormal to 2e-3 or is a reflection. A matrix of three decimals is taken, as the nearest rotation.
pub fn from_matrix(what: &str, matrix: &Matrix4<f64>) -> Result<Pose> {
    check_to(what, matrix, ORTHOGONALITY_TOLERANCE).map(|deviation| nearest(matrix, deviation))
}

/// Drift of a rotation: largest entry of R'R less the identity, where it is more than that of rounded numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift(pub f64);

impl fmt::Display for Drift {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(deviation) = self;
        write!(
            f,
            "the rotation of the target has drifted: R'R differs from the identity by {deviation:.3e}; the nearest rotation is taken"
        )
    }
}

/// Reads a homogeneous 4x4 matrix as [`from_matrix`] does, and also one whose rotation has drifted by up to 0.25, as that of
/// turns multiplied in single precision for long. Returns the pose with the nearest rotation, and the drift.
///
/// # Errors
/// [`Error::NotFinite`] and [`Error::NotRigid`], as [`from_matrix`].
pub fn from_drifted(what: &str, matrix: &Matrix4<f64>) -> Result<(Pose, Option<Drift>)> {
    let deviation = check_to(what, matrix, DRIFT_TOLERANCE)?;
    let drift = (deviation > ORTHOGONALITY_TOLERANCE).then_some(Drift(deviation));
    Ok((nearest(matrix, deviation), drift))
}

/// Checks that a matrix is a pose; `what` names the matrix in errors.
///
/// # Errors
/// As [`from_matrix`].
pub fn check_matrix(what: &str, matrix: &Matrix4<f64>) -> Result<()> {
    check_to(what, matrix, ORTHOGONALITY_TOLERANCE).map(|_| ())
}

/// Checks that a matrix is a pose whose R'R differs from the identity by at most `tolerance`. Returns the difference.
fn check_to(what: &str, matrix: &Matrix4<f64>, tolerance: f64) -> Result<f64> {
    require_finite(what, matrix.as_slice(), |i| format!("entry ({}, {})", i % 4, i / 4))?;
    let not_rigid = |problem: String| Error::NotRigid { what: what.into(), problem };
    if let Some(problem) = fault_of_last_row(matrix) {
        return Err(not_rigid(problem));
    }
    let deviation = deviation(matrix);
    if deviation > tolerance {
        let remedy = "the nearest rotation is U V' of its singular value decomposition U S V'";
        return Err(not_rigid(format!("R'R differs from the identity by {deviation:.3e}; {remedy}")));
    }
    if matrix.fixed_view::<3, 3>(0, 0).determinant() < 0.0 {
        let remedy = "turn one of its axes round";
        return Err(not_rigid(format!("its rotation is a reflection (determinant -1): {remedy}")));
    }
    Ok(deviation)
}

/// Returns the largest entry of R'R less the identity.
#[inline]
fn deviation(matrix: &Matrix4<f64>) -> f64 {
    let rotation = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    (rotation.transpose() * rotation - Matrix3::identity()).amax()
}

/// Describes a last row that is not (0, 0, 0, 1), but for rounding.
fn fault_of_last_row(matrix: &Matrix4<f64>) -> Option<String> {
    let last_row = matrix.row(3);
    let off = last_row.iter().zip([0.0, 0.0, 0.0, 1.0]).any(|(entry, due)| (entry - due).abs() > LAST_ROW_TOLERANCE);
    if !off {
        return None;
    }
    let row = last_row.iter().map(|entry| given(*entry)).collect::<Vec<_>>().join(", ");
    let transposed = matrix.column(3).iter().zip([0.0, 0.0, 0.0, 1.0]).all(|(entry, due)| *entry == due);
    let remedy = if transposed { ": transpose it, so that the position is its last column" } else { "" };
    Some(format!("its last row is ({row}), not (0, 0, 0, 1){remedy}"))
}

/// Returns the pose of a matrix accepted by [`check_matrix`], orthonormalised.
#[inline]
pub fn from_checked(matrix: &Matrix4<f64>) -> Pose {
    nearest(matrix, deviation(matrix))
}

/// Returns the pose with the nearest rotation to that of a matrix, whose R'R differs from the identity by `deviation`. An exact rotation is
/// unchanged.
#[inline]
fn nearest(matrix: &Matrix4<f64>, deviation: f64) -> Pose {
    let rotation = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    let translation = matrix.fixed_view::<3, 1>(0, 3).into_owned();
    let r = if deviation > GRAM_SCHMIDT { polar(rotation) } else { rotation };
    let x = r.column(0).normalize();
    let y = r.column(1) - x * x.dot(&r.column(1));
    let y = y.normalize();
    from_parts(translation.into(), Matrix3::from_columns(&[x, y, x.cross(&y)]))
}

/// Returns the orthogonal factor of the polar decomposition, the nearest rotation, by Newton's iteration (Higham 1986).
#[cold]
fn polar(mut r: Matrix3<f64>) -> Matrix3<f64> {
    for _ in 0..NEWTON_STEPS {
        let Some(inverse) = r.try_inverse() else { break };
        r = 0.5 * (r + inverse.transpose());
    }
    r
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_of_three_decimals_is_taken_as_the_nearest_rotation() {
        for (angle, decimals) in [(0.3, 1e3_f64), (1.1, 1e3), (2.7, 1e4), (-0.9, 1e5)] {
            let axis = Unit::new_normalize(Vector3::new(1.0, angle, -0.4));
            let exact = Rotation3::from_axis_angle(&axis, angle).into_inner();
            let rounded = exact.map(|entry| (entry * decimals).round() / decimals);
            let taken = from_rotation_matrix("R", rounded, [0.0; 3]).unwrap().rotation.into_inner();
            let svd = rounded.svd(true, true);
            let nearest = svd.u.unwrap() * svd.v_t.unwrap();
            assert!((taken - nearest).amax() < 1e-14, "{}", taken - nearest);
            assert!((taken.transpose() * taken - Matrix3::identity()).amax() < 1e-15);
        }
    }

    #[test]
    fn a_drifted_rotation_is_taken_as_the_nearest_one() {
        let axis = Unit::new_normalize(Vector3::new(1.0, -2.0, 0.5));
        let exact = Rotation3::from_axis_angle(&axis, 1.2).into_inner();
        let strain = Matrix3::new(0.03, 0.01, -0.02, 0.0, -0.05, 0.04, 0.01, 0.0, 0.06);
        for size in [1e-3, 0.1, 1.0] {
            let matrix = (exact + strain * size).to_homogeneous();
            let (pose, drift) = from_drifted("target", &matrix).unwrap();
            let svd = matrix.fixed_view::<3, 3>(0, 0).into_owned().svd(true, true);
            let nearest = svd.u.unwrap() * svd.v_t.unwrap();
            assert!((pose.rotation.into_inner() - nearest).amax() < 1e-12, "{size}");
            assert_eq!(drift.is_some(), from_matrix("target", &matrix).is_err(), "{size}");
        }
        for (matrix, problem) in [
            (exact * 1.2, "R'R differs from the identity by 4.400e-1; "),
            (
                exact * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0)),
                "its rotation is a reflection (determinant -1): ",
            ),
        ] {
            let error = from_drifted("target", &matrix.to_homogeneous()).unwrap_err().to_string();
            assert!(error.starts_with(&format!("target is not a rigid transform: {problem}")), "{error}");
        }
    }

    #[test]
    fn a_transposed_pose_is_named_and_a_rounded_last_row_taken() {
        let mut matrix = translation(0.4, 0.0, 0.3).to_homogeneous();
        matrix[(3, 3)] = 1.0 - 1e-7;
        assert_eq!(from_matrix("T", &matrix).unwrap(), translation(0.4, 0.0, 0.3));
        let error = from_matrix("T", &translation(0.4, 0.0, 0.3).to_homogeneous().transpose()).unwrap_err();
        let expected = "T is not a rigid transform: its last row is (0.4, 0, 0.3, 1), not (0, 0, 0, 1): \
            transpose it, so that the position is its last column";
        assert_eq!(error.to_string(), expected);
    }

    #[test]
    fn a_matrix_of_two_decimals_is_no_rotation() {
        let rounded = Matrix3::new(0.99, -0.16, 0.0, 0.16, 0.99, 0.0, 0.0, 0.0, 1.0);
        let error = from_rotation_matrix("R", rounded, [0.0; 3]).unwrap_err();
        let expected = "R is not a rigid transform: R'R differs from the identity by 5.700e-3; \
            the nearest rotation is U V' of its singular value decomposition U S V'";
        assert_eq!(error.to_string(), expected);
    }
}
