//! How well a posture lets the tip move.

use crate::error::Result;
use crate::robot::Robot;

/// Yoshikawa's manipulability sqrt(det(J J')) of the 6 x n Jacobian at `q` (n,); for fewer than six joints, where that
/// vanishes, sqrt(det(J' J)).
///
/// # Errors
/// As [`Robot::jacobian`].
pub fn manipulability(robot: &Robot, q: &[f64]) -> Result<f64> {
    // The product of the singular values is that root, without squaring small numbers away.
    Ok(robot.jacobian(q)?.singular_values().product())
}

/// The same at `qs`, (m, n) row after row.
///
/// # Errors
/// As [`Robot::jacobian_all`].
pub fn manipulability_all(robot: &Robot, qs: &[f64]) -> Result<Vec<f64>> {
    robot.rows(qs)?.map(|q| manipulability(robot, q)).collect()
}

/// TEMP
pub fn add_log_gradient(_robot: &Robot, _q: &[f64], _factor: f64, _gradient: &mut [f64]) -> f64 {
    0.0
}
