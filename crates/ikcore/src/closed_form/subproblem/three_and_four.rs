//! Subproblem 4, rotation of a point into a plane, and subproblem 3, rotation of a point to a given distance.

use super::{Angles, line_on_circle};
use crate::math::vector3::{Vector, cross, dot};

/// Solves subproblem 4: angles about the unit vector `axis` with normal' rot(axis, q) point = height.
#[inline(always)]
pub fn subproblem4(normal: &Vector, axis: &Vector, point: &Vector, height: f64, floor: f64) -> Angles<2> {
    let across = cross(axis, point);
    let a = dot(&cross(axis, normal), &across);
    let b = dot(normal, &across);
    line_on_circle(a, b, height - dot(normal, axis) * dot(axis, point), floor)
}

/// Solves subproblem 3: angles about the unit vector `axis` with |rot(axis, q) point - other| = distance, given its square.
///
/// `floor` has the unit of `point` times that of `other`.
#[inline(always)]
pub fn subproblem3(axis: &Vector, point: &Vector, other: &Vector, squared_distance: f64, floor: f64) -> Angles<2> {
    let product = 0.5 * (dot(point, point) + dot(other, other) - squared_distance);
    subproblem4(other, axis, point, product, floor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::angle::Angle;
    use crate::math::vector3::{norm, sub, unit};

    #[test]
    fn both_meet_what_was_asked() {
        let axis = unit(&[0.3, -0.5, 0.8]);
        let (point, other) = ([0.2, 0.9, -0.4], [-0.6, 0.1, 0.5]);
        let turned = Angle::by(2.2).about(&axis, &point);
        let height = dot(&other, &turned);
        let found = subproblem4(&other, &axis, &point, height, 1e-12);
        assert!(found.iter().all(|t| (dot(&other, &t.about(&axis, &point)) - height).abs() < 1e-15));
        assert!(found.iter().any(|t| (t.angle() - 2.2).abs() < 1e-13));
        let distance = norm(&sub(&turned, &other));
        let found = subproblem3(&axis, &point, &other, distance * distance, 1e-12);
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|t| (norm(&sub(&t.about(&axis, &point), &other)) - distance).abs() < 1e-15));
    }
}
