//! The tip's orientation: r = phi = log(R R_d'), in base coordinates.
//!
//! A small turn w of the tip changes phi by the inverse left Jacobian of SO(3) at phi times w; with it the derivative is
//! exact at any distance from the target, not only near it.

use crate::math::Frame;
use crate::math::so3::{rotation_and_jacobian, rotation_between};
use crate::objective::Linearization;

/// The squared geodesic angle.
#[inline(always)]
pub fn error(target: &Frame, tip: &Frame) -> f64 {
    squared(&rotation_between(target, tip))
}

/// Angular rows of residual and derivative from the tip's geometric Jacobian, which stands in `out`; the squared angle.
#[inline(always)]
pub fn linearize(target: &Frame, tip: &Frame, dof: usize, out: &mut Linearization) -> f64 {
    let (phi, inverse) = rotation_and_jacobian(target, tip);
    for column in &mut out.columns[..dof] {
        let turned = inverse.apply([column[3], column[4], column[5]]);
        column[3..].copy_from_slice(&turned);
    }
    out.residual[3..].copy_from_slice(&phi);
    squared(&phi)
}

#[inline(always)]
fn squared(phi: &[f64; 3]) -> f64 {
    phi[0] * phi[0] + phi[1] * phi[1] + phi[2] * phi[2]
}
