//! Triangle meshes, not necessarily convex.

use std::fmt;

use nalgebra::Vector3;

use super::along_segment::SegmentDistance;
use super::enclosure::Enclosure;
use super::nearest_piece::squared_bound;
use super::segment_lanes::TOUCHING;
use super::tangent::{Tangent, point_between};
use super::triangle::nearest_on_triangle;
use super::triangle_surface::TriangleSurface;

/// Triangle mesh, together with the interior of its closed pieces.
#[derive(Clone)]
pub struct Mesh {
    surface: TriangleSurface,
    enclosure: Enclosure,
}

/// Accuracy of the depth of a segment inside a closed mesh, relative to the depth.
const DEPTH_ACCURACY: f64 = 0.01;
/// Absolute accuracy of the depth of a segment (m).
const SMALLEST_DEPTH_ACCURACY: f64 = 1e-4;
/// Largest number of points evaluated for the depth of a segment.
const MOST_DEPTHS: usize = 400;

impl PartialEq for Mesh {
    /// Compares vertices and faces alone, since they determine all other fields.
    fn eq(&self, other: &Self) -> bool {
        self.vertices() == other.vertices() && self.faces() == other.faces()
    }
}

impl fmt::Debug for Mesh {
    /// Omits the pieces, which may number thousands.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (vertices, faces) = (self.vertices().len(), self.faces().len());
        write!(f, "Mesh {{ {vertices} vertices, {faces} faces, closed: {} }}", self.is_closed())
    }
}

impl Mesh {
    /// Builds the mesh; the error describes the problem with the triangles.
    pub(super) fn new(vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) -> Result<Self, String> {
        if faces.is_empty() {
            return Err("a mesh needs at least one triangle, got none".into());
        }
        for (i, face) in faces.iter().enumerate() {
            if let Some(index) = face.iter().find(|index| **index as usize >= vertices.len()) {
                let count = vertices.len();
                return Err(format!("face {i} of the mesh names vertex {index}, but it has {count} (from 0)"));
            }
        }
        let surface = TriangleSurface::new(vertices, faces);
        Ok(Self { enclosure: Enclosure::of(&surface), surface })
    }

    /// Returns the corners of the triangles (m).
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.surface.vertices
    }

    /// Returns the corner indices of each triangle.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.surface.faces
    }

    /// Whether the interior is fully known: the mesh has no boundary, and no two layers coincide. Triangles may have either
    /// orientation where each edge belongs to exactly two.
    pub fn is_closed(&self) -> bool {
        self.enclosure.certain
    }

    /// Returns the volume enclosed by the closed pieces (m^3); overlaps count once per piece.
    pub fn volume(&self) -> f64 {
        let origin = Vector3::from(self.vertices()[self.faces()[0][0] as usize]);
        let cone = |(i, turn): (usize, &i8)| {
            let [a, b, c] = self.triangle(i).map(|corner| corner - origin);
            f64::from(*turn) * a.dot(&b.cross(&c)) / 6.0
        };
        self.enclosure.turns.iter().enumerate().map(cone).sum()
    }

    /// Returns the corners of face `i`.
    pub(super) fn triangle(&self, i: usize) -> [Vector3<f64>; 3] {
        self.surface.triangle(i)
    }

    /// Whether a closed piece encloses `point`.
    pub(super) fn encloses(&self, point: &Vector3<f64>) -> bool {
        let Enclosure { turns, .. } = &self.enclosure;
        !turns.is_empty() && self.surface.winding_number(point, |face| turns[face].into()) != 0
    }

    /// Visits all triangles within `reach` (m) of a segment, and possibly others, by their indices; `visit` returns the new
    /// reach.
    pub(super) fn each_near(&self, segment: &[Vector3<f64>; 2], reach: f64, visit: &mut dyn FnMut(usize) -> f64) {
        self.surface.tree.each_near(segment, reach, visit);
    }

    /// Returns the signed distance of a point, and its gradient.
    pub(super) fn tangent(&self, point: &Vector3<f64>) -> Tangent {
        let nearest = self.surface.tree.nearest(&[*point; 2], f64::INFINITY, &mut |_| {});
        let [a, b, c] = self.triangle(nearest.index.unwrap_or(0));
        let away = point - nearest_on_triangle(point, &[a, b, c]);
        let distance = away.norm();
        let sign = if self.encloses(point) { -1.0 } else { 1.0 };
        let across = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or(Vector3::x());
        let normal = if distance > 1e-12 { sign * away / distance } else { across };
        Tangent { value: sign * distance, normal }
    }

    /// Returns the signed distance of a segment: inside a closed piece it is minus the depth of the deepest point. Exact up
    /// to `enough` outside, a lower bound inside.
    pub(super) fn approach(&self, segment: &[Vector3<f64>; 2], enough: f64) -> SegmentDistance {
        let surface = self.surface.tree.nearest(segment, squared_bound(enough).max(TOUCHING), &mut |_| {});
        let touches = surface.index.is_some() && surface.squared <= TOUCHING;
        if (touches && !self.enclosure.turns.is_empty()) || self.encloses(&segment[0]) {
            return self.depth(segment);
        }
        SegmentDistance { distance: surface.squared.sqrt(), fraction: surface.fraction }
    }

    /// Returns a lower bound on the signed distance along a segment, by branch and bound: the distance changes no faster than
    /// the length along the segment, so between two points it lies above a wedge.
    fn depth(&self, [a, b]: &[Vector3<f64>; 2]) -> SegmentDistance {
        let length = (b - a).norm();
        let at =
            |fraction: f64| SegmentDistance { distance: self.tangent(&point_between(a, b, fraction)).value, fraction };
        let [first, last] = [at(0.0), at(1.0)];
        let deeper =
            |one: SegmentDistance, other: SegmentDistance| if other.distance < one.distance { other } else { one };
        let mut seen = deeper(first, last);
        let mut wedges = vec![Wedge::between(first, last, length)];
        for _ in 0..MOST_DEPTHS {
            let accuracy = SMALLEST_DEPTH_ACCURACY.max(-DEPTH_ACCURACY * seen.distance);
            let by_bound = |i: &usize, j: &usize| wedges[*i].bound.total_cmp(&wedges[*j].bound);
            match (0..wedges.len()).min_by(by_bound) {
                Some(lowest) if seen.distance - wedges[lowest].bound > accuracy => {
                    let Wedge { left, right, .. } = wedges[lowest];
                    let middle =
                        at(0.5 * (left.fraction + right.fraction) + 0.5 * (left.distance - right.distance) / length);
                    seen = deeper(seen, middle);
                    wedges[lowest] = Wedge::between(left, middle, length);
                    wedges.push(Wedge::between(middle, right, length));
                }
                _ => break,
            }
        }
        let distance = wedges.iter().fold(seen.distance, |lowest, wedge| lowest.min(wedge.bound));
        SegmentDistance { distance, ..seen }
    }
}

/// Part of a segment, with a lower bound on the signed distance in it.
#[derive(Clone, Copy)]
struct Wedge {
    left: SegmentDistance,
    right: SegmentDistance,
    bound: f64,
}

impl Wedge {
    fn between(left: SegmentDistance, right: SegmentDistance, length: f64) -> Self {
        let bound = 0.5 * (left.distance + right.distance - length * (right.fraction - left.fraction));
        Self { left, right, bound }
    }
}

#[cfg(test)]
mod tests {
    use super::super::checked_shape::Shape;
    use super::super::test_shapes::{as_mesh, mesh_of, point};
    use super::super::triangle::nearest_on_triangle;
    use super::*;
    use crate::rng::{self, LazyRng};

    fn random_soup(rng: &mut LazyRng, count: u32) -> Shape {
        let triangles = (0..count).map(|_| {
            let (corner, size) = (point(rng, 1.0), rng.uniform_in(0.01, 0.4));
            [(); 3].map(|()| <[f64; 3]>::from(corner + size * point(rng, 1.0)))
        });
        mesh_of(&triangles.collect::<Vec<_>>())
    }

    #[test]
    fn a_mesh_of_a_box_is_as_far_as_the_box() {
        let mut rng = rng::stream(1, 0);
        let turn = Some(*nalgebra::Rotation3::new(Vector3::new(0.4, -0.7, 0.2)).matrix());
        let cuboid = Shape::cuboid([0.1, -0.2, 0.3], [0.5, 0.7, 0.9], turn).unwrap();
        let mesh = mesh_of(&cuboid.triangles());
        assert!(as_mesh(&mesh).is_closed());
        let mut inside = 0;
        for case in 0..4000 {
            let a = point(&mut rng, 1.2);
            let b = if case % 3 == 0 { a } else { point(&mut rng, 1.2) };
            let segment = [a, b];
            let exact = cuboid.distance_to_segment(&segment, f64::INFINITY);
            let found = mesh.distance_to_segment(&segment, f64::INFINITY);
            let slack = if exact > 0.0 { 2e-12 } else { 2.0 * SMALLEST_DEPTH_ACCURACY.max(-DEPTH_ACCURACY * exact) };
            inside += usize::from(exact < 0.0);
            assert!(found <= exact + 2e-9 && found >= exact - slack, "case {case}: {found} for {exact}");
            // The result lies on the same side of `enough` as the distance.
            let enough = rng.uniform_in(-0.2, 0.6);
            let short = mesh.distance_to_segment(&segment, enough);
            assert!(short <= exact + 2e-9 && (short >= enough) == (found >= enough), "{short} {found} {enough}");
        }
        assert!(inside > 500, "{inside}");
    }

    #[test]
    fn a_segment_is_as_far_from_a_soup_as_from_its_nearest_triangle() {
        let mut rng = rng::stream(2, 0);
        for count in [1, 2, 5, 37, 400] {
            let soup = random_soup(&mut rng, count);
            assert!(!as_mesh(&soup).is_closed());
            for _ in 0..100 {
                let segment = [point(&mut rng, 1.5), point(&mut rng, 1.5)];
                let found = soup.distance_to_segment(&segment, f64::INFINITY);
                let far = |i: usize| sampled(&segment, &as_mesh(&soup).triangle(i));
                let nearest = (0..count as usize).map(far).fold(f64::INFINITY, f64::min);
                assert!(found <= nearest && nearest - found < 0.03, "{found}, sampled {nearest}");
            }
        }
    }

    /// Returns the distance of the triangle from sampled points of the segment.
    fn sampled([a, b]: &[Vector3<f64>; 2], triangle: &[Vector3<f64>; 3]) -> f64 {
        let at = |i: usize| a + i as f64 / 100.0 * (b - a);
        (0..=100).map(|i| (at(i) - nearest_on_triangle(&at(i), triangle)).norm()).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn points_on_rays_through_edges_and_corners_are_inside_or_not() {
        let cuboid = mesh_of(&Shape::cuboid([0.0; 3], [2.0, 2.0, 2.0], None).unwrap().triangles());
        let mesh = as_mesh(&cuboid);
        // Rays along x through the diagonals of the faces, and through edges and corners of the box.
        for (x, y, z) in [(0.0, 0.5, 0.5), (0.0, 0.5, -0.5), (0.0, 0.0, 0.0), (-0.9, 0.25, 0.25)] {
            assert!(mesh.encloses(&Vector3::new(x, y, z)));
            assert!(!mesh.encloses(&Vector3::new(-2.0, y, z)) && !mesh.encloses(&Vector3::new(2.0, y, z)));
        }
        for outside in [[-2.0, 1.0, 1.0], [-2.0, 1.0, 0.0], [-2.0, 0.0, 1.0], [0.0, 2.0, 0.0]] {
            assert!(!mesh.encloses(&outside.into()));
        }
    }

    #[test]
    fn what_lies_in_one_of_two_overlapping_bodies_is_inside() {
        let [one, other] = [[0.0; 3], [0.5, 0.0, 0.0]].map(|c| Shape::cuboid(c, [1.0; 3], None).unwrap().triangles());
        let triangles: Vec<_> = one.into_iter().chain(other).collect();
        let both = mesh_of(&triangles);
        // Point just outside the first box, but deep in the second.
        assert!(as_mesh(&both).encloses(&Vector3::new(0.501, 0.0, 0.0)));
        assert!(as_mesh(&both).encloses(&Vector3::zeros()) && !as_mesh(&both).encloses(&Vector3::new(1.1, 0.0, 0.0)));
    }

    #[test]
    fn mistakes_in_a_mesh_are_named() {
        let problem = |vertices: &[[f64; 3]], faces: &[[u32; 3]]| {
            Shape::mesh(vertices.to_vec(), faces.to_vec()).unwrap_err().to_string()
        };
        assert_eq!(problem(&[[0.0; 3]], &[]), "a mesh needs at least one triangle, got none");
        assert_eq!(
            problem(&[[0.0; 3]; 3], &[[0, 1, 2], [0, 3, 1]]),
            "face 1 of the mesh names vertex 3, but it has 3 (from 0)"
        );
        assert_eq!(
            problem(&[[0.0; 3], [0.0, f64::NAN, 0.0]], &[[0, 1, 1]]),
            "vertices of the mesh must be finite, but coordinate y of point 1 is NaN"
        );
    }
}
