//! The tip at a pose: r = (p - p_d, phi) with phi = log(R R_d'), in base coordinates.
//!
//! A small turn w of the tip changes phi by the inverse left Jacobian of SO(3) at phi times w; with it the derivative is
//! exact at any distance from the target, not only near it.

use super::{TipError, position};
use crate::math::Frame;
use crate::math::so3::{self, InverseLeftJacobian};
use crate::objective::Linearization;

/// Residual and derivative from the tip's geometric Jacobian, which stands in `out`.
#[inline]
pub fn linearize(target: &Frame, tip: &Frame, dof: usize, out: &mut Linearization) -> TipError {
    let distance = position::residual(&target.origin, &tip.origin);
    let phi = so3::rotation_between(target, tip);
    let inverse = InverseLeftJacobian::at(phi);
    for column in &mut out.columns[..dof] {
        let turned = inverse.apply([column[3], column[4], column[5]]);
        column[3..].copy_from_slice(&turned);
    }
    out.residual = [distance[0], distance[1], distance[2], phi[0], phi[1], phi[2]];
    TipError { position: so3::norm(&distance), rotation: so3::norm(&phi) }
}
