//! Point cloud with a radius: balls about many points.

use std::fmt;

use nalgebra::Vector3;

use super::along_segment::SegmentDistance;
use super::bounding_tree::{Aabb, BoundingTree};
use super::nearest_piece::{PieceLanes, squared_bound};
use super::segment_lanes::{NearestFraction, to_point};
use super::tangent::Tangent;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::real::Four;
use crate::math::vec3::Vec3;

/// Balls of one radius about many points.
#[derive(Clone)]
pub struct PointCloud {
    points: Vec<[f64; 3]>,
    radius: f64,
    tree: BoundingTree<FourPoints>,
}

/// Four points, one per lane.
#[derive(Clone)]
struct FourPoints([F64x4; 3]);

impl PartialEq for PointCloud {
    /// Compares points and radius alone, since they determine all other fields.
    fn eq(&self, other: &Self) -> bool {
        self.points == other.points && self.radius == other.radius
    }
}

impl fmt::Debug for PointCloud {
    /// Omits the points, which may number thousands.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PointCloud {{ {} points, radius: {:?} }}", self.points.len(), self.radius)
    }
}

impl PointCloud {
    /// Builds the cloud of balls about `points`, at least one.
    pub(super) fn new(points: Vec<[f64; 3]>, radius: f64) -> Self {
        let boxes: Vec<Aabb> = points.iter().map(|point| Aabb::around([Vector3::from(*point)])).collect();
        let lanes = |lanes: [usize; 4]| FourPoints(std::array::from_fn(|k| F64x4(lanes.map(|i| points[i][k]))));
        let tree = BoundingTree::new(&boxes, lanes);
        Self { points, radius, tree }
    }

    /// Returns the points (m).
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// Returns the radius of the ball about each point (m).
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Visits all points within `reach` (m) of a segment, and possibly others, by their indices; `visit` returns the new
    /// reach.
    pub(super) fn each_near(&self, segment: &[Vector3<f64>; 2], reach: f64, visit: &mut dyn FnMut(usize) -> f64) {
        self.tree.each_near(segment, reach, visit);
    }

    /// Returns the signed distance of a point to the nearest ball, and its gradient.
    pub(super) fn tangent(&self, point: &Vector3<f64>) -> Tangent {
        let nearest = self.tree.nearest(&[*point; 2], f64::INFINITY, &mut |_| {});
        let away = point - Vector3::from(self.points[nearest.index.unwrap_or(0)]);
        Tangent { value: away.norm() - self.radius, normal: away.try_normalize(0.0).unwrap_or(Vector3::x()) }
    }

    /// Returns the signed distance of a segment, exact up to `enough`: inside it is minus the depth in the ball that it
    /// enters deepest.
    pub(super) fn approach(&self, segment: &[Vector3<f64>; 2], enough: f64) -> SegmentDistance {
        let nearest = self.tree.nearest(segment, squared_bound(enough + self.radius), &mut |_| {});
        SegmentDistance { distance: nearest.squared.sqrt() - self.radius, fraction: nearest.fraction }
    }
}

impl PieceLanes for FourPoints {
    #[inline(always)]
    fn nearest<A: Arithmetic>(&self, start: &[f64; 3], along: &[f64; 3]) -> NearestFraction<Four<A>> {
        to_point(Vec3::splat(start), Vec3::splat(along), Vec3::of(&self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::super::checked_shape::Shape;
    use super::super::tangent::nearest_on_segment;
    use super::*;
    use crate::rng;

    #[test]
    fn a_segment_is_as_far_from_a_cloud_as_from_its_nearest_ball() {
        let mut rng = rng::stream(1, 0);
        for count in [1, 3, 4, 5, 17, 1000] {
            let mut draw = || std::array::from_fn(|_| rng.uniform_in(-1.0, 1.0));
            let points: Vec<[f64; 3]> = (0..count).map(|_| draw()).collect();
            let cloud = Shape::point_cloud(points.clone(), 0.02).unwrap();
            for case in 0..200 {
                let (a, b) = (Vector3::from(draw()), Vector3::from(draw()));
                let segment = if case % 2 == 0 { [a, a] } else { [2.0 * a, 2.0 * b] };
                let far = |p: &[f64; 3]| {
                    let point = Vector3::from(*p);
                    (nearest_on_segment(&segment[0], &segment[1], &point) - point).norm() - 0.02
                };
                let exact = points.iter().map(far).fold(f64::INFINITY, f64::min);
                let found = cloud.distance_to_segment(&segment, f64::INFINITY);
                assert!(found <= exact && exact - found < 5e-12, "{count}: {found} for {exact}");
                assert_eq!(cloud.distance_to_segment(&segment, 0.05) >= 0.05, found >= 0.05);
            }
        }
    }

    #[test]
    fn mistakes_in_a_cloud_are_named() {
        let problem = |points: Vec<[f64; 3]>, radius| Shape::point_cloud(points, radius).unwrap_err().to_string();
        assert_eq!(problem(vec![], 0.1), "a point cloud needs at least one point, got none");
        assert_eq!(
            problem(vec![[0.0; 3]], -0.1),
            "radius of the point cloud must be zero or more and finite, got -0.1"
        );
    }
}
