//! The tip at a pose: r = (p - p_d, phi) with phi = log(R R_d'), in base coordinates.
//!
//! A small turn w of the tip changes phi by the inverse left Jacobian of SO(3) at phi times w; with it the derivative is
//! exact at any distance from the target, not only near it.

use super::{SquaredError, position};
use crate::math::Frame;
use crate::math::so3::{InverseLeftJacobian, rotation_between};
use crate::objective::Linearization;

/// Squared distance and squared angle.
#[inline]
pub fn error(target: &Frame, tip: &Frame) -> SquaredError {
    squared(target, tip, &rotation_between(target, tip))
}

/// Residual and derivative from the tip's geometric Jacobian, which stands in `out`.
#[inline]
pub fn linearize(target: &Frame, tip: &Frame, dof: usize, out: &mut Linearization) -> SquaredError {
    let [x, y, z] = position::residual(&target.origin, &tip.origin);
    let phi = rotation_between(target, tip);
    let inverse = InverseLeftJacobian::at(phi);
    for column in &mut out.columns[..dof] {
        let turned = inverse.apply([column[3], column[4], column[5]]);
        column[3..].copy_from_slice(&turned);
    }
    out.residual = [x, y, z, phi[0], phi[1], phi[2]];
    squared(target, tip, &phi)
}

#[inline(always)]
fn squared(target: &Frame, tip: &Frame, phi: &[f64; 3]) -> SquaredError {
    let rotation = phi[0] * phi[0] + phi[1] * phi[1] + phi[2] * phi[2];
    SquaredError { rotation: Some(rotation), ..position::error(&target.origin, &tip.origin) }
}
