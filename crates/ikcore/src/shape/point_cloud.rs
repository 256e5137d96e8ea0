//! Point cloud with a radius: balls about many points.

use std::fmt;

use nalgebra::Vector3;

use super::along_segment::SegmentDistance;
use super::bounding_tree::{Aabb, BoundingTree, NONE, SegmentQuery};
use super::nearest_piece::{PieceLanes, squared_bound};
use super::segment_lanes::{NearestFraction, to_point};
use super::tangent::Tangent;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
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
    /// Builds the cloud of balls about `points`.
    pub(super) fn new(points: Vec<[f64; 3]>, radius: f64) -> Self {
        let boxes: Vec<Aabb> = points.iter().map(box_of).collect();
        let tree = BoundingTree::new(&boxes, |lanes| FourPoints::new(&points, lanes));
        Self { points, radius, tree }
    }

    /// Returns the cloud without the points that are `gone`.
    pub(super) fn without(&self, gone: &[bool]) -> Self {
        let mut points = Vec::with_capacity(self.points.len());
        let number = |(point, gone): (&[f64; 3], &bool)| {
            if *gone {
                return NONE;
            }
            points.push(*point);
            points.len() as u32 - 1
        };
        let numbers: Vec<u32> = self.points.iter().zip(gone).map(number).collect();
        let tree = self.tree.of_some(&numbers, |i| box_of(&points[i]), |lanes| FourPoints::new(&points, lanes));
        Self { points, radius: self.radius, tree }
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

    /// Visits all points whose distance from a segment is at most `reach` (m), with the distance squared (m^2), and possibly
    /// others.
    pub(super) fn each_within(&self, segment: &[Vector3<f64>; 2], reach: f64, visit: &mut dyn FnMut(usize, f64)) {
        each_within(&self.tree, segment, reach, visit);
    }

    /// Returns the signed distance of a point to the nearest ball, and its gradient.
    pub(super) fn tangent(&self, point: &Vector3<f64>) -> Tangent {
        let nearest = self.tree.nearest(&[*point; 2], f64::INFINITY, &mut |_| {});
        let Some(index) = nearest.index else { return Tangent { value: f64::INFINITY, normal: Vector3::x() } };
        let away = point - Vector3::from(self.points[index]);
        Tangent { value: away.norm() - self.radius, normal: away.try_normalize(0.0).unwrap_or(Vector3::x()) }
    }

    /// Returns the signed distance of a segment, exact up to `enough`: inside it is minus the depth in the ball that it
    /// enters deepest.
    pub(super) fn approach(&self, segment: &[Vector3<f64>; 2], enough: f64) -> SegmentDistance {
        let nearest = self.tree.nearest(segment, squared_bound(enough + self.radius), &mut |_| {});
        SegmentDistance { distance: nearest.squared.sqrt() - self.radius, fraction: nearest.fraction }
    }
}

fn box_of(point: &[f64; 3]) -> Aabb {
    Aabb::around([Vector3::from(*point)])
}

impl FourPoints {
    fn new(points: &[[f64; 3]], lanes: [usize; 4]) -> Self {
        Self(std::array::from_fn(|k| F64x4(lanes.map(|i| points[i][k]))))
    }
}

by_instructions! {
    fn each_within(
        tree: &BoundingTree<FourPoints>,
        segment: &[Vector3<f64>; 2],
        reach: f64,
        visit: &mut dyn FnMut(usize, f64),
    ) {
        let [start, along] = [segment[0].into(), (segment[1] - segment[0]).into()];
        tree.search::<A>(&SegmentQuery::new(segment), squared_bound(reach), |leaf, bound| {
            let squared = leaf.lanes.nearest::<A>(&start, &along).squared.stored().0;
            for lane in 0..4 {
                // A distance that is not a number counts as near.
                if let Some(index) = leaf.piece(lane) && !(squared[lane] > bound) {
                    visit(index, squared[lane]);
                }
            }
            bound
        });
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
        assert_eq!(
            problem(vec![[0.0; 3]], -0.1),
            "radius of the point cloud must be zero or more and finite, got -0.1"
        );
    }
}
