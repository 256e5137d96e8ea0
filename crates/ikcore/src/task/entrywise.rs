//! E of Yuan et al. 2016, eq. (11): half the sum of squared differences between the entries of the wanted matrix and the
//! tip's, and the wrench that pulls the tip down its gradient.
//!
//! Moved by v and turned by w, the tip changes E by -(f . v + m . w). Here f = p_d - p, and, since a turn moves the axis
//! r_c by w x r_c, m is the sum of r_c x d_c over the columns r_c of its rotation and d_c of the wanted one.

use super::{Target, position};
use crate::math::Frame;
use crate::math::so3::cross;
use crate::robot::Wrench;

/// E.
#[inline]
pub fn error(target: &Target, tip: &Frame) -> f64 {
    match target {
        Target::Position(target) => 0.5 * position::error(target, &tip.origin).sum(),
        Target::Pose(target) => {
            let entries = target.axes.as_flattened().iter().zip(tip.axes.as_flattened());
            let turned: f64 = entries.map(|(d, r)| (d - r) * (d - r)).sum();
            0.5 * (turned + position::error(&target.origin, &tip.origin).sum())
        }
    }
}

/// The wrench (f, m), minus the derivative of E.
#[inline]
pub fn pull(target: &Target, tip: &Frame) -> Wrench {
    let (wanted, axes) = match target {
        Target::Position(target) => (target, None),
        Target::Pose(target) => (&target.origin, Some(&target.axes)),
    };
    let [fx, fy, fz] = position::residual(&tip.origin, wanted);
    let mut moment = [0.0; 3];
    for (d, r) in axes.into_iter().flatten().zip(&tip.axes) {
        let share = cross(r, d);
        (0..3).for_each(|k| moment[k] += share[k]);
    }
    [fx, fy, fz, moment[0], moment[1], moment[2]]
}
