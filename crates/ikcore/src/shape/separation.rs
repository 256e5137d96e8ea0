//! Witness of a distance: where a capsule is nearest to a shape, and along which normal.

use nalgebra::Vector3;

use super::along_segment::LineSegment;
use super::checked_shape::Shape;
use super::segment_distance::between;
use super::tangent::{Tangent, nearest_on_segment, point_between};

/// So far from the deepest point of an axis (as a fraction of its length) other faces are looked for.
const BESIDE: f64 = 1e-6;

/// Normals with less than this in common are of opposite faces: either leads out.
const LEAST_IN_COMMON: f64 = 0.05;

impl Shape {
    /// The point of a capsule that is nearest to the shape (m), and the derivative of the distance by the place of the capsule: the unit
    /// normal there, out of the shape. Where faces on both sides of the deepest point of the axis are equally near, it is what their
    /// normals have in common, and shorter.
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

/// The point of the first capsule (axis and radius) that is nearest to the other (m), and the unit normal from the other.
pub(crate) fn capsules_nearest(
    (own, radius): (&LineSegment, f64),
    (other, _): (&LineSegment, f64),
) -> (Vector3<f64>, Vector3<f64>) {
    let [a, b] = own;
    let on_axis = point_between(a, b, between(own, other).fraction);
    let away = on_axis - nearest_on_segment(&other[0], &other[1], &on_axis);
    // Axes that meet have no direction: at right angles to both.
    let across = (b - a).cross(&(other[1] - other[0]));
    let normal = away.try_normalize(0.0).or_else(|| across.try_normalize(0.0)).unwrap_or(Vector3::z());
    (on_axis - radius * normal, normal)
}
