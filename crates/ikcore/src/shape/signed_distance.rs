//! Signed distance of a point to a shape, with its gradient.

use nalgebra::{Rotation3, Vector3};

use super::bounding_tree::Aabb;
use super::ellipsoid;
use super::geometry::Geometry;
use super::tangent::{Tangent, nearest_on_segment};

impl Geometry {
    /// Returns the signed distance of `point` (m). For a convex shape the result is a tangent: a lower bound everywhere.
    pub(super) fn tangent(&self, point: &Vector3<f64>) -> Tangent {
        match self {
            Geometry::Sphere { center, radius } => of_ball(point - Vector3::from(*center), *radius),
            Geometry::Capsule { a, b, radius } => {
                of_ball(point - nearest_on_segment(&(*a).into(), &(*b).into(), point), *radius)
            }
            Geometry::Box { pose, size } => {
                let local =
                    of_box(&pose.inverse_transform_point(&(*point).into()).coords, &(0.5 * Vector3::from(*size)));
                Tangent { normal: pose.rotation * local.normal, ..local }
            }
            Geometry::Ellipsoid { pose, semi_axes } => {
                let local = ellipsoid::tangent(&pose.inverse_transform_point(&(*point).into()).coords, semi_axes);
                Tangent { normal: pose.rotation * local.normal, ..local }
            }
            Geometry::Ellipse { center, semi_axes: [a, b], angle } => {
                // Section of an ellipsoid: in the plane z = 0 their distances agree.
                let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), *angle);
                let local = turn.inverse() * (point - Vector3::new(center[0], center[1], 0.0));
                let tangent = ellipsoid::tangent(&local, &[*a, *b, a.max(*b)]);
                Tangent { normal: turn * tangent.normal, ..tangent }
            }
            Geometry::Cylinder { center, axis, radius, length } => {
                of_cylinder(&(point - Vector3::from(*center)), &Vector3::from(*axis), *radius, 0.5 * length)
            }
            Geometry::HalfSpace { normal, offset } => {
                let normal = Vector3::from(*normal);
                Tangent { value: normal.dot(point) - offset, normal }
            }
            Geometry::ConvexMesh(hull) => hull.tangent(point),
            Geometry::Mesh(mesh) => mesh.tangent(point),
            Geometry::PointCloud(cloud) => cloud.tangent(point),
            Geometry::Grid(grid) => grid.tangent(point),
        }
    }
}

/// Computes the tangent of a ball; `offset` is the point relative to its centre.
fn of_ball(offset: Vector3<f64>, radius: f64) -> Tangent {
    let length = offset.norm();
    let normal = if length > 0.0 { offset / length } else { Vector3::x() };
    Tangent { value: length - radius, normal }
}

/// Computes the tangent of a box about the origin: outside the distance to the nearest point, inside to the nearest face.
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

/// Computes the tangent of a cylinder about the origin, along `axis`.
fn of_cylinder(point: &Vector3<f64>, axis: &Vector3<f64>, radius: f64, half_length: f64) -> Tangent {
    let along = axis.dot(point);
    let outward = point - along * axis;
    let from_axis = outward.norm();
    let radial = if from_axis > 0.0 { outward / from_axis } else { at_right_angles(axis) };
    let axial = axis * 1.0_f64.copysign(along);
    let (beside, beyond) = (from_axis - radius, along.abs() - half_length);
    if beside > 0.0 && beyond > 0.0 {
        let value = beside.hypot(beyond);
        return Tangent { value, normal: (beside * radial + beyond * axial) / value };
    }
    if beside > beyond { Tangent { value: beside, normal: radial } } else { Tangent { value: beyond, normal: axial } }
}

/// Returns a unit vector perpendicular to `axis`.
pub(super) fn at_right_angles(axis: &Vector3<f64>) -> Vector3<f64> {
    axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize()
}

impl Aabb {
    /// Returns the signed distance of a point to the box.
    pub(super) fn tangent(&self, point: &Vector3<f64>) -> Tangent {
        of_box(&(point - 0.5 * (self.lower + self.upper)), &(0.5 * (self.upper - self.lower)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::checked_shape::Shape;
    use super::super::test_shapes::point;
    use super::*;
    use crate::rng;

    fn shapes() -> Vec<Shape> {
        let turn = Some(*Rotation3::new(Vector3::new(0.4, -0.7, 0.2)).matrix());
        let shapes = [
            Shape::sphere([0.1, -0.2, 0.3], 0.4),
            Shape::capsule([0.1, 0.2, -0.3], [-0.4, 0.1, 0.5], 0.2),
            Shape::cuboid([0.1, -0.2, 0.3], [0.3, 0.6, 0.9], turn),
            Shape::ellipsoid([0.1, -0.2, 0.3], [0.2, 0.5, 0.7], turn),
            Shape::cylinder([0.1, -0.2, 0.3], [0.3, -0.8, 0.5], 0.3, 0.9),
            Shape::convex_mesh(&[[0.0; 3], [0.9, 0.1, 0.0], [0.1, 0.8, 0.2], [-0.1, 0.2, 0.7], [0.5, 0.5, 0.6]]),
        ];
        shapes.into_iter().map(|shape| shape.unwrap()).collect()
    }

    #[test]
    fn the_normal_is_the_gradient_of_the_distance() {
        let mut rng = rng::stream(1, 0);
        for shape in shapes() {
            for _ in 0..200 {
                let at = point(&mut rng, 1.5);
                let Tangent { value, normal } = shape.geometry().tangent(&at);
                assert!((normal.norm() - 1.0).abs() < 1e-9, "{}", shape.name());
                // Edges inside the shape, where the nearest face changes, are skipped.
                if value < 0.05 {
                    continue;
                }
                let h = 1e-5;
                for k in 0..3 {
                    let step = Vector3::from_fn(|i, _| if i == k { h } else { 0.0 });
                    let slope = (shape.geometry().tangent(&(at + step)).value
                        - shape.geometry().tangent(&(at - step)).value)
                        / (2.0 * h);
                    assert!((slope - normal[k]).abs() < 1e-3, "{}: {slope} for {}", shape.name(), normal[k]);
                }
            }
        }
    }

    #[test]
    fn the_tangent_bounds_the_distance_of_every_other_point() {
        let mut rng = rng::stream(2, 0);
        for shape in shapes() {
            for _ in 0..500 {
                let (here, there) = (point(&mut rng, 1.2), point(&mut rng, 1.2));
                let tangent = shape.geometry().tangent(&here);
                let bound = tangent.value + tangent.normal.dot(&(there - here));
                let distance = shape.geometry().tangent(&there).value;
                assert!(distance >= bound - 1e-9, "{}: {distance} below {bound}", shape.name());
            }
        }
    }

    #[test]
    fn the_bounding_sphere_holds_the_shape() {
        let mut rng = rng::stream(3, 0);
        for shape in shapes() {
            let center = Vector3::from(shape.bounding_ball().center);
            for at in (0..2000).map(|_| point(&mut rng, 1.5)).filter(|at| shape.geometry().tangent(at).value <= 0.0) {
                assert!((at - center).norm() <= shape.bounding_ball().radius, "{}", shape.name());
            }
        }
    }

    #[test]
    fn centers_have_a_depth_and_a_normal_too() {
        let ball = Shape::sphere([0.0; 3], 0.5).unwrap().geometry().tangent(&Vector3::zeros());
        assert_eq!((ball.value, ball.normal.norm()), (-0.5, 1.0));
        let cuboid = Shape::cuboid([0.0; 3], [2.0, 4.0, 6.0], None).unwrap().geometry().tangent(&Vector3::zeros());
        assert_eq!((cuboid.value, cuboid.normal.x.abs()), (-1.0, 1.0));
        let ellipsoid =
            Shape::ellipsoid([0.0; 3], [0.2, 0.3, 0.4], None).unwrap().geometry().tangent(&Vector3::zeros());
        assert!((ellipsoid.value + 0.2).abs() < 1e-9 && (ellipsoid.normal.x.abs() - 1.0).abs() < 1e-6);
    }
}
