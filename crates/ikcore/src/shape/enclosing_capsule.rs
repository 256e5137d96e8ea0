//! Capsules that contain other shapes.

use nalgebra::{Point3, Vector3};

use super::checked_shape::Shape;
use super::cover::smallest_capsule;
use super::geometry::Geometry;
use crate::math::Pose;

/// Ends of the axis, and radius, of a capsule (m).
type CapsuleParts = ([f64; 3], [f64; 3], f64);

impl Shape {
    /// Returns a capsule that contains the shape: exact for spheres and capsules, small for other convex shapes, else the
    /// bounding ball.
    pub(crate) fn enclosing_capsule(&self) -> CapsuleParts {
        match self.geometry() {
            Geometry::Sphere { center, radius } => (*center, *center, *radius),
            Geometry::Capsule { a, b, radius } => (*a, *b, *radius),
            Geometry::Cylinder { center, axis, radius, length } => {
                let end = |side: f64| std::array::from_fn(|k| center[k] + side * length * axis[k]);
                (end(-0.5), end(0.5), *radius)
            }
            // Axis along the longest edge; the radius reaches the corners of the cross-section.
            Geometry::Box { pose, size } => along_longest(pose, &(0.5 * Vector3::from(*size)), |across| across.norm()),
            Geometry::Ellipsoid { pose, semi_axes } => {
                along_longest(pose, &Vector3::from(*semi_axes), |across| across.amax())
            }
            Geometry::ConvexMesh(hull) => smallest_capsule(hull.corners()).parts(),
            _ => {
                let ball = self.bounding_ball();
                (ball.center, ball.center, ball.radius)
            }
        }
    }
}

/// Returns the capsule along the longest of three half extents; `reach` computes its radius from the other two.
fn along_longest(pose: &Pose, half: &Vector3<f64>, reach: impl Fn(&Vector3<f64>) -> f64) -> CapsuleParts {
    let longest = half.imax();
    let (mut axis, mut across) = (Vector3::zeros(), *half);
    axis[longest] = half[longest];
    across[longest] = 0.0;
    let end = |side: f64| (pose * Point3::from(side * axis)).coords.into();
    (end(-1.0), end(1.0), reach(&across))
}
