//! Orientation residual of the tip: r = phi = log(R R_d'), in base coordinates.
//!
//! A small rotation w of the tip changes phi by J_l^-1(phi) w, with J_l the left Jacobian of SO(3). The derivative is
//! exact at any distance from the target.

use crate::math::Frame;
use crate::math::box_step::ROWS;
use crate::math::real::Real;
use crate::math::so3::{Axes, rotation_and_jacobian, rotation_between};
use crate::math::vec3::Vec3;

/// Squared geodesic angle.
#[inline(always)]
pub(crate) fn error(target: &Frame, tip: &Frame) -> f64 {
    let [x, y, z] = rotation_between(target, tip);
    x * x + y * y + z * z
}

/// Writes the angular rows of residual and derivative, from the tip's geometric Jacobian given in `columns`, and returns the
/// squared angle.
#[inline(always)]
pub(crate) fn linearize<R: Real>(
    target: &Axes<R>,
    tip: &Axes<R>,
    residual: &mut [R::Stored; ROWS],
    columns: &mut [[R::Stored; ROWS]],
) -> R {
    let (phi, inverse) = rotation_and_jacobian(target, tip);
    for column in columns {
        let [.., x, y, z] = *column;
        column[3..].copy_from_slice(&inverse.apply(Vec3::of(&[x, y, z])).stored());
    }
    residual[3..].copy_from_slice(&phi.stored());
    phi.dot(phi)
}
