//! Rates of a subject per unit of a joint, as its target sees them.

use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::real::One;
use crate::math::so3::{axes_of, cross, norm, rotation_and_jacobian};
use crate::math::vec3::Vec3;
use crate::math::vector::dot;
use crate::task::Target;

/// Rates of a subject as its target sees it, per unit of a joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeenRates {
    /// Of the position, in the frame that the subject is seen from.
    pub origin: [f64; 3],
    /// Of the position along the axes of the target, or of the base if it has none.
    pub offset: [f64; 3],
    /// Angular velocity along the same axes.
    pub spin: [f64; 3],
    /// Of the rotation vector from the target, along the same axes.
    pub turn: [f64; 3],
    /// Of the angle between both axes of a pointing target.
    pub tilt: f64,
}

impl SeenRates {
    /// The rates of the subject at `frame`, for `column` of its geometric Jacobian.
    pub fn of(target: &Target, frame: &Frame, column: &[f64; 6]) -> Self {
        let [x, y, z, u, v, w] = *column;
        let (origin, spin) = ([x, y, z], [u, v, w]);
        let still = Self { origin, offset: origin, spin: [0.0; 3], turn: [0.0; 3], tilt: 0.0 };
        match target {
            Target::Position(_) => still,
            Target::Pose(to) | Target::Orientation(to) => {
                let jacobian = rotation_and_jacobian::<One<NoFma>>(&axes_of(to), &axes_of(frame)).1;
                let turn = to.turn_back(&jacobian.apply(Vec3::of(&spin)).stored());
                Self { offset: to.turn_back(&origin), spin: to.turn_back(&spin), turn, ..still }
            }
            Target::Pointing { frame: to, axis } => {
                let [one, other] = [frame, to].map(|frame| frame.turn::<NoFma>(axis));
                let normal = cross(&one, &other);
                let sine = norm(&normal);
                let tilt = if sine > 0.0 { -dot(&spin, &normal) / sine } else { 0.0 };
                Self { offset: to.turn_back(&origin), spin: to.turn_back(&spin), tilt, ..still }
            }
        }
    }
}
