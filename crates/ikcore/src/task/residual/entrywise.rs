//! Smooth error E of Yuan et al. 2016, eq. (11), and its negative gradient as a wrench on the tip. E is half the sum of squared
//! differences between the entries of the target's matrix and the tip's.
//!
//! A motion of the tip by v and a rotation by w change E by -(f . v + m . w). Here f = p_d - p; and since a rotation
//! moves the axis r_c by w x r_c, m is the sum of r_c x d_c over the columns r_c of the tip's rotation and d_c of the
//! target's.

use super::position;
use crate::kinematics::Wrench;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::so3::cross;
use crate::task::target::Target;

/// Error E over the parts of a pose that the target includes.
#[inline]
pub(crate) fn error(target: &Target, tip: &Frame) -> f64 {
    let away = target.position().map_or(0.0, |wanted| position::error(&wanted, &tip.origin));
    0.5 * (axes(target, tip).map(|(r, d)| position::error(&d, &r)).sum::<f64>() + away)
}

/// Wrench (f, m), minus the derivative of E.
#[inline]
pub(crate) fn wrench(target: &Target, tip: &Frame) -> Wrench {
    let [fx, fy, fz] = target.position().map_or([0.0; 3], |wanted| position::residual(&tip.origin, &wanted));
    let mut moment = [0.0; 3];
    for (r, d) in axes(target, tip) {
        let part = cross(&r, &d);
        (0..3).for_each(|k| moment[k] += part[k]);
    }
    [fx, fy, fz, moment[0], moment[1], moment[2]]
}

/// Axes of the tip that the target constrains, with their target directions.
#[inline]
fn axes(target: &Target, tip: &Frame) -> impl Iterator<Item = ([f64; 3], [f64; 3])> {
    let (pairs, count) = match target {
        Target::Position(_) => ([([0.0; 3], [0.0; 3]); 3], 0),
        Target::Pose(frame) | Target::Orientation(frame) => (std::array::from_fn(|c| (tip.axes[c], frame.axes[c])), 3),
        Target::Pointing { frame, axis } => ([(tip.turn::<NoFma>(axis), frame.turn::<NoFma>(axis)); 3], 1),
    };
    pairs.into_iter().take(count)
}
