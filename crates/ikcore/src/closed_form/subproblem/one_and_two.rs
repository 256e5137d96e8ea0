//! Subproblem 1, one rotation that carries a vector onto another, and subproblem 2, two rotations that make two vectors meet.

use super::{Angles, subproblem4};
use crate::closed_form::angle::Angle;
use crate::math::vector3::{Vector, cross, dot};

/// Solves subproblem 1: the angle about the unit vector `axis` that carries `from` onto `to`.
///
/// Cross products are used because differences of dot products cancel where both vectors are nearly along the axis. A vector
/// along the axis leaves the angle free, represented by [`Angle::NONE`].
#[inline(always)]
pub fn subproblem1(axis: &Vector, from: &Vector, to: &Vector) -> Angle {
    let (from, to) = (cross(axis, from), cross(axis, to));
    Angle::towards(dot(&from, &to), dot(axis, &cross(&from, &to)))
}

/// Solves subproblem 2: angles (q1, q2) with rot(first, q1) from = rot(second, q2) to.
///
/// `floor` is in the unit of the vectors, see [`super::line_on_circle()`].
#[inline(always)]
pub fn subproblem2(first: &Vector, from: &Vector, second: &Vector, to: &Vector, floor: f64) -> (Angles<2>, [Angle; 2]) {
    let q1 = subproblem4(second, first, from, dot(second, to), floor);
    let mut q2 = [Angle::NONE; 2];
    for (q1, q2) in q1.iter().zip(&mut q2) {
        *q2 = subproblem1(second, to, &q1.about(first, from));
    }
    (q1, q2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector3::{norm, sub, unit};

    #[test]
    fn a_tiny_lever_keeps_its_digits() {
        let axis = unit(&[0.3, -0.5, 0.8]);
        for lever in [1.0, 1e-6, 1e-9] {
            let from = std::array::from_fn(|k| axis[k] + lever * [0.1, 0.7, -0.2][k]);
            let turn = Angle::by(1.2);
            let found = subproblem1(&axis, &from, &turn.about(&axis, &from));
            assert!((found.angle() - 1.2).abs() < 1e-15 / lever, "{lever}: {}", found.angle() - 1.2);
        }
    }

    #[test]
    fn two_axes_meet() {
        let (first, second) = (unit(&[0.3, -0.5, 0.8]), unit(&[0.9, 0.1, 0.2]));
        let from = [0.2, 0.4, -0.3];
        let to = Angle::by(0.4).back().about(&second, &Angle::by(-0.9).about(&first, &from));
        let (q1, q2) = subproblem2(&first, &from, &second, &to, 1e-12);
        assert_eq!(q1.len(), 2);
        for (q1, q2) in q1.iter().zip(&q2) {
            assert!(norm(&sub(&q1.about(&first, &from), &q2.about(&second, &to))) < 1e-15);
        }
        assert!(q1.iter().any(|q| (q.angle() + 0.9).abs() < 1e-12));
    }
}
