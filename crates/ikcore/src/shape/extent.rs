//! Extents of bodies and shapes along a direction, which give separating planes.

use nalgebra::Vector3;

use super::checked_shape::Shape;
use super::convex::Convex;
use super::geometry::Geometry;
use super::posed_body::PosedBody;
use crate::math::Frame;

/// Largest difference, in each entry, between a normal and the normal of a half-space that count as equal.
const PARALLEL: f64 = 1e-14;

impl Shape {
    /// Returns an upper bound on n'x (m) over all points x of the shape; `None` for shapes that are not convex, and for a
    /// half-space whose normal differs from n.
    pub(crate) fn farthest_along(&self, normal: &Vector3<f64>) -> Option<f64> {
        if let Geometry::HalfSpace { normal: own, offset } = self.geometry() {
            return ((normal - Vector3::from(*own)).amax() <= PARALLEL).then(|| offset + self.rounding(offset.abs()));
        }
        let convex = Convex::of(self.geometry(), &Frame::IDENTITY)?;
        let farthest = normal.dot(&convex.support(normal)) + convex.radius() * normal.norm();
        Some(farthest + self.rounding(farthest.abs()))
    }
}

impl PosedBody<'_> {
    /// Returns the smallest n'x (m) over all points x of the body.
    pub fn least_along(&self, normal: &Vector3<f64>) -> f64 {
        let convex = self.convex();
        normal.dot(&convex.support(&-normal)) - convex.radius() * normal.norm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_ends_where_its_corner_does() {
        let shape = Shape::cuboid([1.0, 0.0, 0.0], [0.2, 0.4, 0.6], None).unwrap();
        assert!((shape.farthest_along(&Vector3::x()).unwrap() - 1.1).abs() < 1e-11);
        let slanted = Vector3::new(1.0, 1.0, 0.0).normalize();
        assert!((shape.farthest_along(&slanted).unwrap() - (1.1 + 0.2) / 2_f64.sqrt()).abs() < 1e-11);
        let axis = [Vector3::new(0.0, 0.0, 1.0), Vector3::new(0.0, 0.0, 2.0)];
        let body = PosedBody { axis: &axis, radius: 0.25, solid: None };
        assert_eq!(body.least_along(&Vector3::z()), 0.75);
    }

    #[test]
    fn a_half_space_ends_along_its_own_normal_alone() {
        let floor = Shape::half_space([0.0, 0.0, 2.0], -0.5).unwrap();
        assert!((floor.farthest_along(&Vector3::z()).unwrap() + 0.5).abs() < 1e-11);
        assert_eq!(floor.farthest_along(&Vector3::x()), None);
        let cloud = Shape::point_cloud(vec![[0.0; 3]], 0.1).unwrap();
        assert_eq!(cloud.farthest_along(&Vector3::z()), None);
    }
}
