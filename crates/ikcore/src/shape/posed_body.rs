//! Distances of a robot body, at its current frame, from shapes and other bodies.

use nalgebra::Vector3;

use super::along_segment::LineSegment;
use super::checked_shape::{LARGEST, Shape};
use super::convex::Convex;
use super::convex_distance::{Gap, gap};
use super::geometry::Geometry;
use super::segment_distance::distance_between;
use super::separation::capsules_nearest;
use crate::math::Frame;

/// Convex body at its current frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PosedBody<'a> {
    /// Axis of the enclosing capsule.
    pub axis: &'a LineSegment,
    /// Radius of the enclosing capsule (m).
    pub radius: f64,
    /// Shape and its frame; `None` if the body is the capsule.
    pub solid: Option<(&'a Shape, Frame)>,
}

impl<'a> PosedBody<'a> {
    pub(super) fn convex(&self) -> Convex<'a> {
        let solid = self.solid.as_ref().and_then(|(shape, frame)| Convex::of(shape.geometry(), frame));
        solid.unwrap_or_else(|| Convex::capsule(*self.axis, self.radius))
    }

    /// Whether the coordinates are too large for their products.
    fn is_huge(&self) -> bool {
        !(self.axis[0].amax().max(self.axis[1].amax()).max(self.radius) <= LARGEST)
    }

    /// Returns the signed distance (m) from another body: a lower bound, exact where it is below `enough`.
    #[inline]
    pub fn distance_to(&self, other: &PosedBody, enough: f64) -> f64 {
        let by_capsules = distance_between(other.axis, self.axis) - (other.radius + self.radius);
        if by_capsules >= enough || (self.solid.is_none() && other.solid.is_none()) {
            return by_capsules;
        }
        self.gap_to_body(other, enough).distance
    }

    fn gap_to_body(&self, other: &PosedBody, enough: f64) -> Gap {
        if self.is_huge() || other.is_huge() {
            return Gap::beyond(f64::NEG_INFINITY);
        }
        gap(&self.convex(), &other.convex(), enough)
    }

    /// Returns the point nearest to another body (m), and the unit normal from that body.
    pub fn nearest_to(&self, other: &PosedBody) -> (Vector3<f64>, Vector3<f64>) {
        if self.solid.is_none() && other.solid.is_none() {
            return capsules_nearest((self.axis, self.radius), (other.axis, other.radius));
        }
        let Gap { point, normal, .. } = self.gap_to_body(other, f64::INFINITY);
        (point, normal)
    }
}

impl Shape {
    /// Returns the signed distance (m) of a body: a lower bound. Below `enough` it is exact for a capsule, as
    /// [`distance_to_segment`](Self::distance_to_segment), and exact to about 1e-7 m for other bodies. For overlap it is
    /// minus the shortest translation that parts them; inside a closed mesh it is minus the depth of the enclosing capsule.
    #[inline]
    pub(crate) fn distance_to_body(&self, body: &PosedBody, enough: f64) -> f64 {
        let by_capsule = self.distance_to_segment(body.axis, enough + body.radius) - body.radius;
        if by_capsule >= enough || body.solid.is_none() {
            return by_capsule;
        }
        self.gap_to(body, enough).distance
    }

    /// Returns the point of a body nearest to the shape (m), and the gradient of the distance with respect to the body's
    /// position, as [`nearest_to_capsule`](Self::nearest_to_capsule) does.
    pub(crate) fn nearest_to_body(&self, body: &PosedBody) -> (Vector3<f64>, Vector3<f64>) {
        if body.solid.is_none() {
            return self.nearest_to_capsule(body.axis, body.radius);
        }
        let Gap { point, normal, .. } = self.gap_to(body, f64::INFINITY);
        (point, normal)
    }

    fn gap_to(&self, body: &PosedBody, enough: f64) -> Gap {
        if self.is_huge() || body.is_huge() {
            return Gap::beyond(f64::NEG_INFINITY);
        }
        let own = body.convex();
        let mut nearest = Gap::beyond(enough);
        // Boxes of a point cloud contain its points, not the balls about them.
        let ball = if let Geometry::PointCloud(cloud) = self.geometry() { cloud.radius() } else { 0.0 };
        let around = body.radius + ball;
        // Keeps the nearest piece; returns the largest distance from the capsule axis at which a nearer piece can lie.
        let mut compare = |piece: &Convex| {
            let next = gap(&own, piece, nearest.distance);
            if next.distance < nearest.distance {
                nearest = next;
            }
            nearest.distance + around
        };
        let reach = enough + around;
        match self.geometry() {
            Geometry::HalfSpace { normal, offset } => {
                let normal = Vector3::from(*normal);
                let point = own.support(&-normal) - own.radius() * normal;
                let distance = normal.dot(&point) - offset - self.rounding(point.amax());
                return Gap { distance, normal, point };
            }
            Geometry::Mesh(mesh) => {
                mesh.each_near(body.axis, reach, &mut |face| compare(&Convex::corners(&mesh.triangle(face))));
                if nearest.distance > 0.0 && mesh.encloses(&own.support(&Vector3::x())) {
                    return self.depth_of(body);
                }
            }
            Geometry::PointCloud(cloud) => cloud.each_near(body.axis, reach, &mut |index| {
                let center = Vector3::from(cloud.points()[index]);
                compare(&Convex::capsule([center; 2], cloud.radius()))
            }),
            Geometry::Grid(grid) => {
                grid.each_near(body.axis, reach, &mut |block| compare(&Convex::aligned(&grid.blocks()[block])));
            }
            geometry => match Convex::of(geometry, &Frame::IDENTITY) {
                Some(other) => return gap(&own, &other, enough),
                None => return self.depth_of(body),
            },
        }
        nearest
    }

    /// Returns the gap of the enclosing capsule, for a body inside a mesh.
    fn depth_of(&self, body: &PosedBody) -> Gap {
        let distance = self.distance_to_segment(body.axis, f64::INFINITY) - body.radius;
        let (point, normal) = self.nearest_to_capsule(body.axis, body.radius);
        Gap { distance: distance.min(0.0), normal, point }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;
    use crate::math::Pose;
    use crate::rng::{self, LazyRng};

    fn point(rng: &mut LazyRng, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| rng.uniform_in(-reach, reach))
    }

    fn frame(rng: &mut LazyRng) -> Frame {
        let turn = Rotation3::new(Vector3::from(point(rng, 2.0)));
        Frame::from(&Pose::from_parts(point(rng, 0.6).into(), turn))
    }

    fn solids(rng: &mut LazyRng) -> Vec<Shape> {
        let turn = Some(*Rotation3::new(Vector3::from(point(rng, 2.0))).matrix());
        let size = point(rng, 0.3).map(|x| 0.05 + x.abs());
        let corners: Vec<[f64; 3]> = (0..12).map(|_| point(rng, 0.3)).collect();
        let solids = [
            Shape::cuboid(point(rng, 0.2), size, turn),
            Shape::cylinder(point(rng, 0.2), point(rng, 1.0), size[0], size[1]),
            Shape::ellipsoid(point(rng, 0.2), size, turn),
            Shape::convex_mesh(&corners),
        ];
        solids.into_iter().map(Result::unwrap).collect()
    }

    /// Calls `check` with a body of each kind of shape at random poses.
    fn for_bodies(seed: u64, rounds: usize, mut check: impl FnMut(&mut LazyRng, &PosedBody)) {
        let mut rng = rng::stream(seed, 0);
        for _ in 0..rounds {
            for shape in solids(&mut rng) {
                let place = frame(&mut rng);
                let (a, b, radius) = shape.enclosing_capsule();
                let axis = [a, b].map(|end| Vector3::from(place.transform::<crate::math::arithmetic::NoFma>(&end)));
                check(&mut rng, &PosedBody { axis: &axis, radius, solid: Some((&shape, place)) });
            }
        }
    }

    #[test]
    fn a_solid_is_as_far_from_a_capsule_as_the_capsule_from_it() {
        let mut apart = 0;
        for_bodies(1, 300, |rng, body| {
            let (a, radius) = (point(rng, 0.8), rng.uniform_in(0.01, 0.2));
            let b = if rng.uniform() < 0.3 { a } else { point(rng, 0.8) };
            let obstacle = Shape::swept_ball(a, b, radius).unwrap();
            let found = obstacle.distance_to_body(body, f64::INFINITY);
            let (shape, place) = body.solid.unwrap();
            let back = place.inverse();
            let seen = [a, b].map(|p| Vector3::from(back.transform::<crate::math::arithmetic::NoFma>(&p)));
            let exact = shape.distance_to_segment(&seen, f64::INFINITY) - radius;
            let name = shape.name();
            if exact > -radius {
                apart += 1;
                assert!(found <= exact + 2e-9 && found >= exact - 2e-7, "{name}: {found} for {exact}");
            } else {
                assert!(found < 0.0, "{name}: {found} for {exact}");
            }
            // A smaller `enough` leaves distances below it unchanged, and never raises those above it.
            let short = obstacle.distance_to_body(body, 0.1);
            assert!(short <= exact + 2e-9 && (short < 0.1) == (found < 0.1), "{name}: {short} for {found}");
        });
        assert!(apart > 600, "{apart}");
    }

    #[test]
    fn solids_moved_apart_by_their_depth_no_longer_overlap() {
        let (mut inside, mut outside) = (0, 0);
        for_bodies(2, 60, |rng, body| {
            for other in solids(rng) {
                let gap = other.gap_to(body, f64::INFINITY);
                *(if gap.distance < 0.0 { &mut inside } else { &mut outside }) += 1;
                let own = body.convex();
                let fixed = Convex::of(other.geometry(), &Frame::IDENTITY).unwrap();
                // No direction separates the two sets by more.
                for _ in 0..100 {
                    let normal = Vector3::from(point(rng, 1.0)).normalize();
                    let along = normal.dot(&own.support(&-normal)) - normal.dot(&fixed.support(&normal));
                    assert!(along <= gap.distance + 1e-3 * gap.distance.abs() + 1e-6, "{along} {}", gap.distance);
                }
                let (shape, mut place) = body.solid.unwrap();
                let by = (1e-6 - gap.distance) * gap.normal;
                place.origin = (Vector3::from(place.origin) + by).into();
                let axis = body.axis.map(|end| end + by);
                let moved = PosedBody { axis: &axis, solid: Some((shape, place)), ..*body };
                let left = other.gap_to(&moved, f64::INFINITY).distance;
                assert!((5e-7..1e-5).contains(&left), "{} {}: {left}", shape.name(), other.name());
            }
        });
        assert!(inside > 100 && outside > 100, "{inside} {outside}");
    }

    #[test]
    fn things_of_many_pieces_are_as_near_as_their_nearest_piece() {
        for_bodies(3, 40, |rng, body| {
            let points: Vec<[f64; 3]> = (0..60).map(|_| point(rng, 0.8)).collect();
            let faces: Vec<[u32; 3]> = (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let cloud = Shape::point_cloud(points.clone(), 0.02).unwrap();
            let balls = points.iter().map(|p| Shape::sphere(*p, 0.02).unwrap().distance_to_body(body, f64::INFINITY));
            let occupied: Vec<bool> = (0..64).map(|_| rng.uniform() < 0.2).collect();
            let voxel = |i: usize| [i / 16, i / 4 % 4, i % 4].map(|k| -0.8 + 0.4 * (k as f64 + 0.5));
            let cubes = (0..64).filter(|i| occupied[*i]).map(|i| Shape::cuboid(voxel(i), [0.4; 3], None).unwrap());
            let cubes: Vec<f64> = cubes.map(|cube| cube.distance_to_body(body, f64::INFINITY)).collect();
            let soup = Shape::mesh(points.clone(), faces.clone()).unwrap();
            let corners = |face: &[u32; 3]| face.map(|i| Vector3::from(points[i as usize]));
            let triangles =
                faces.iter().map(|face| gap(&body.convex(), &Convex::corners(&corners(face)), f64::INFINITY).distance);
            let mut cases =
                vec![(soup, triangles.fold(f64::INFINITY, f64::min)), (cloud, balls.fold(f64::INFINITY, f64::min))];
            if !cubes.is_empty() {
                let grid = Shape::grid([-0.8; 3], 0.4, [4; 3], occupied).unwrap();
                cases.push((grid, cubes.into_iter().fold(f64::INFINITY, f64::min)));
            }
            for (shape, exact) in cases {
                let found = shape.distance_to_body(body, f64::INFINITY);
                // Merged voxels form blocks, in which a body is deeper.
                let same = (found - exact).abs() < 1e-6 || (exact < 0.0 && found <= exact + 1e-4);
                assert!(same, "{}: {found} for {exact}", shape.name());
                assert!((shape.distance_to_body(body, 0.05) < 0.05) == (found < 0.05));
            }
        });
    }

    #[test]
    fn a_solid_inside_a_closed_mesh_is_in_it() {
        let ball = Shape::sphere([0.0; 3], 3.0).unwrap();
        let triangles = ball.triangles();
        let faces = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let shell = Shape::mesh(triangles.as_flattened().to_vec(), faces).unwrap();
        for_bodies(4, 20, |_, body| {
            let distance = shell.distance_to_body(body, f64::INFINITY);
            assert!((-4.0..-1.0).contains(&distance), "{distance}");
            let (_, normal) = shell.nearest_to_body(body);
            assert!((normal.norm() - 1.0).abs() < 1e-9);
        });
    }

    #[test]
    fn coordinates_that_overflow_are_near() {
        let cube = Shape::cuboid([0.0; 3], [1.0; 3], None).unwrap();
        for far in [1e31, 1e100] {
            let place = Frame { origin: [far, 0.0, 0.0], ..Frame::IDENTITY };
            let axis = [Vector3::new(far, 0.0, 0.0); 2];
            let body = PosedBody { axis: &axis, radius: 1.0, solid: Some((&cube, place)) };
            let distance = cube.distance_to_body(&body, f64::INFINITY);
            assert!(distance <= far && !distance.is_nan(), "{far}: {distance}");
        }
    }
}
