//! Pointing residual of the tip, for a position and the direction of one axis: r = (p - p_d, a - d), in base coordinates. The
//! rotation about the axis is free.
//!
//! a is the axis of the tip and d the target direction. Unlike the angle between them, their difference is smooth
//! everywhere; its length is 2 sin(angle / 2), and a small rotation w of the tip changes it by w x a.

use super::position;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::so3::{cross, norm};
use crate::objective::TaskBlock;
use crate::task::tip_error::SquaredError;

/// Squared distance and squared angle between the axes, and the sum of squares r'r.
#[inline]
pub(crate) fn error(target: &Frame, axis: &[f64; 3], tip: &Frame) -> (SquaredError, f64) {
    errors(target, tip, &difference(target, axis, tip))
}

/// Writes residual and derivative from the tip's geometric Jacobian, given in `out`.
#[inline]
pub(crate) fn linearize(
    target: &Frame,
    axis: &[f64; 3],
    tip: &Frame,
    dof: usize,
    out: &mut TaskBlock,
) -> (SquaredError, f64) {
    let a = tip.turn::<NoFma>(axis);
    for column in &mut out.columns[..dof] {
        let moved = cross(&[column[3], column[4], column[5]], &a);
        column[3..].copy_from_slice(&moved);
    }
    let difference = difference(target, axis, tip);
    out.residual[..3].copy_from_slice(&position::residual(&target.origin, &tip.origin));
    out.residual[3..].copy_from_slice(&difference);
    errors(target, tip, &difference)
}

/// Difference a - d of the axes.
#[inline(always)]
fn difference(target: &Frame, axis: &[f64; 3], tip: &Frame) -> [f64; 3] {
    position::residual(&target.turn::<NoFma>(axis), &tip.turn::<NoFma>(axis))
}

fn errors(target: &Frame, tip: &Frame, difference: &[f64; 3]) -> (SquaredError, f64) {
    let (distance, chord) = (position::error(&target.origin, &tip.origin), norm(difference));
    let angle = 2.0 * (0.5 * chord).min(1.0).asin();
    (SquaredError { position: Some(distance), rotation: Some(angle * angle) }, distance + chord * chord)
}
