//! Witness of a distance: where a capsule is nearest to a shape, and along which normal.

use nalgebra::Vector3;

use super::along_segment::LineSegment;
use super::checked_shape::Shape;
use super::segment_distance::between;
use super::tangent::nearest_on_segment;

impl Shape {
    /// The point of a capsule that is nearest to the shape (m), and the unit normal there, out of the shape.
    pub(crate) fn nearest_to_capsule(&self, segment: &LineSegment, radius: f64) -> (Vector3<f64>, Vector3<f64>) {
        let [a, b] = segment;
        let share = self.geometry().approach(segment, f64::INFINITY).share;
        let on_axis = a + share * (b - a);
        let normal = self.geometry().tangent(&on_axis).normal;
        (on_axis - radius * normal, normal)
    }
}

/// The point of the first capsule (axis and radius) that is nearest to the other (m), and the unit normal from the other.
pub(crate) fn capsules_nearest(
    (own, radius): (&LineSegment, f64),
    (other, _): (&LineSegment, f64),
) -> (Vector3<f64>, Vector3<f64>) {
    let [a, b] = own;
    let on_axis = a + between(own, other).share * (b - a);
    let away = on_axis - nearest_on_segment(&other[0], &other[1], &on_axis);
    // Axes that meet have no direction: at right angles to both.
    let across = (b - a).cross(&(other[1] - other[0]));
    let normal = away.try_normalize(0.0).or_else(|| across.try_normalize(0.0)).unwrap_or(Vector3::z());
    (on_axis - radius * normal, normal)
}
