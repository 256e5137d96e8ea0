//! Signed distance of a point to an obstacle, with its tangent.

use nalgebra::{Rotation3, Vector3};

use super::ellipsoid;
use super::shape::{Obstacle, Shape};
use super::tangent::{Tangent, nearest_on_segment};

impl Obstacle {
    /// Signed distance of `point` (m, the base's frame).
    pub(super) fn tangent(&self, point: &Vector3<f64>) -> Tangent {
        match self.shape() {
            Shape::Sphere { center, radius } => of_ball(point - Vector3::from(*center), *radius),
            Shape::Capsule { a, b, radius } => {
                of_ball(point - nearest_on_segment(&(*a).into(), &(*b).into(), point), *radius)
            }
            Shape::Box { pose, size } => {
                let local =
                    of_box(&pose.inverse_transform_point(&(*point).into()).coords, &(0.5 * Vector3::from(*size)));
                Tangent { normal: pose.rotation * local.normal, ..local }
            }
            Shape::Ellipsoid { pose, semi_axes } => {
                let local = ellipsoid::tangent(&pose.inverse_transform_point(&(*point).into()).coords, semi_axes);
                Tangent { normal: pose.rotation * local.normal, ..local }
            }
            Shape::Ellipse { center, semi_axes: [a, b], angle } => {
                // In its plane z = 0 it is the section of an ellipsoid, and there their distances agree.
                let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), *angle);
                let local = turn.inverse() * (point - Vector3::new(center[0], center[1], 0.0));
                let tangent = ellipsoid::tangent(&local, &[*a, *b, a.max(*b)]);
                Tangent { normal: turn * tangent.normal, ..tangent }
            }
            #[cfg(feature = "convex-mesh")]
            Shape::ConvexMesh(hull) => hull.tangent(point),
        }
    }
}

/// Of a ball: `offset` is the point seen from its centre.
fn of_ball(offset: Vector3<f64>, radius: f64) -> Tangent {
    let length = offset.norm();
    let normal = if length > 0.0 { offset / length } else { Vector3::x() };
    Tangent { value: length - radius, normal }
}

/// Of a box about the origin: outside the distance to its nearest point, inside that to the nearest face.
fn of_box(point: &Vector3<f64>, half: &Vector3<f64>) -> Tangent {
    let beyond = point.abs() - half;
    let outside = beyond.map(|excess| excess.max(0.0));
    let distance = outside.norm();
    let sign = point.map(|coordinate| 1.0_f64.copysign(coordinate));
    if distance > 0.0 {
        return Tangent { value: distance, normal: outside.component_mul(&sign) / distance };
    }
    let face = beyond.imax();
    let mut normal = Vector3::zeros();
    normal[face] = sign[face];
    Tangent { value: beyond[face], normal }
}
