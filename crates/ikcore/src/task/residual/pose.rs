//! Pose residual of the tip: r = (p - p_d, log(R R_d')), in base coordinates.

use super::{orientation, position};
use crate::math::Frame;
use crate::math::real::Real;
use crate::math::so3::axes_of;
use crate::objective::TaskBlock;
use crate::task::tip_error::SquaredError;

/// Squared distance and squared angle.
#[inline]
pub(crate) fn error(target: &Frame, tip: &Frame) -> SquaredError {
    SquaredError {
        position: Some(position::error(&target.origin, &tip.origin)),
        rotation: Some(orientation::error(target, tip)),
    }
}

/// Writes residual and derivative from the tip's geometric Jacobian, given in `out`.
#[inline]
pub(crate) fn linearize(target: &Frame, tip: &Frame, dof: usize, out: &mut TaskBlock) -> SquaredError {
    out.residual[..3].copy_from_slice(&position::residual(&target.origin, &tip.origin));
    let TaskBlock { residual, columns, .. } = out;
    let rotation = orientation::linearize(&axes_of(target), &axes_of(tip), residual, &mut columns[..dof]).stored();
    SquaredError { position: Some(position::error(&target.origin, &tip.origin)), rotation: Some(rotation) }
}
