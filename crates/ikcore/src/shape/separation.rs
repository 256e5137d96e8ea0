//! Witness points and normals of the distance of a capsule.

use nalgebra::Vector3;

use super::along_segment::LineSegment;
use super::checked_shape::Shape;
use super::segment_distance::between;
use super::tangent::{Tangent, nearest_on_segment, point_between};

/// Distance from the deepest point of an axis, as a fraction of its length, at which other faces are looked for.
const BESIDE: f64 = 1e-6;

/// Length of the combined normal below which two normals belong to opposite faces, so that either leads out.
const LEAST_IN_COMMON: f64 = 0.05;

impl Shape {
    /// Returns the point of a capsule nearest to the shape (m), and the gradient of the distance with respect to the
    /// capsule's position: the unit normal there, out of the shape. If faces on both sides of the deepest point of the axis
    /// are equally near, the gradient is the convex combination of their normals with zero slope along the axis, which is
    /// shorter.
    pub(crate) fn nearest_to_capsule(&self, segment: &LineSegment, radius: f64) -> (Vector3<f64>, Vector3<f64>) {
        let [a, b] = segment;
        let fraction = self.geometry().approach(segment, f64::INFINITY).fraction;
        let on_axis = point_between(a, b, fraction);
        let Tangent { value, normal } = self.geometry().tangent(&on_axis);
        if value >= 0.0 || fraction <= 0.0 || fraction >= 1.0 {
            return (on_axis - radius * normal, normal);
        }
        let beside = |fraction: f64| self.geometry().tangent(&point_between(a, b, fraction)).normal;
        let [before, after] = [fraction - BESIDE, fraction + BESIDE].map(beside);
        let [falls, rises] = [before, after].map(|normal| normal.dot(&(b - a)));
        let common = before + (after - before) * (falls / (falls - rises));
        let is_corner = falls < 0.0 && rises > 0.0 && common.norm() > LEAST_IN_COMMON;
        let slope = if is_corner { common } else { normal };
        (on_axis - radius * slope.normalize(), slope)
    }
}

/// Returns the point of the first capsule (axis and radius) nearest to the second (m), and the unit normal from the second.
pub(crate) fn capsules_nearest(
    (own, radius): (&LineSegment, f64),
    (other, _): (&LineSegment, f64),
) -> (Vector3<f64>, Vector3<f64>) {
    let [a, b] = own;
    let on_axis = point_between(a, b, between(own, other).fraction);
    let away = on_axis - nearest_on_segment(&other[0], &other[1], &on_axis);
    // Intersecting axes have no direction of separation; use the normal of both.
    let across = (b - a).cross(&(other[1] - other[0]));
    let normal = away.try_normalize(0.0).or_else(|| across.try_normalize(0.0)).unwrap_or(Vector3::z());
    (on_axis - radius * normal, normal)
}
