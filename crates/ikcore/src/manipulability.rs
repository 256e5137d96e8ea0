//! How well a posture lets the tip move.

use crate::error::Result;
use crate::robot::Robot;

/// Yoshikawa's manipulability sqrt(det(J J')) of the 6 x n Jacobian at `q` (n,); for fewer than six joints, where that
/// vanishes, sqrt(det(J' J)).
///
/// # Errors
/// As [`Robot::jacobian`].
pub fn manipulability(robot: &Robot, q: &[f64]) -> Result<f64> {
    let jacobian = robot.jacobian(q)?;
    // The product of the singular values is that root, without squaring small numbers away.
    Ok(jacobian.singular_values().product())
}
