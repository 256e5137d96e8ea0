//! Triangles of a mesh, with a bounding volume hierarchy over them.

use nalgebra::Vector3;

use super::bounding_tree::{Aabb, BoundingTree};
use super::nearest_piece::PieceLanes;
use super::segment_lanes::{NearestFraction, TriangleLanes, point_to_triangle, to_triangle};
use super::winding::winding;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::vec3::Vec3;

/// Triangles that share vertices.
#[derive(Clone)]
pub(super) struct TriangleSurface {
    /// Corners of the triangles (m).
    pub vertices: Vec<[f64; 3]>,
    /// Corner indices of each triangle.
    pub faces: Vec<[u32; 3]>,
    /// Hierarchy over the triangles.
    pub tree: BoundingTree<FourTriangles>,
}

/// A corner and two edges of four triangles, one per lane.
#[derive(Clone)]
pub(super) struct FourTriangles {
    corner: [F64x4; 3],
    edges: [[F64x4; 3]; 2],
}

impl TriangleSurface {
    /// Prepares at least one triangle.
    pub fn new(vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) -> Self {
        let corners = |face: &[u32; 3]| face.map(|i| Vector3::from(vertices[i as usize]));
        let boxes: Vec<Aabb> = faces.iter().map(|face| Aabb::around(corners(face))).collect();
        let tree = BoundingTree::new(&boxes, |lanes| FourTriangles::new(lanes.map(|face| corners(&faces[face]))));
        Self { vertices, faces, tree }
    }

    /// Returns the corners of a triangle.
    pub fn triangle(&self, face: usize) -> [Vector3<f64>; 3] {
        self.faces[face].map(|corner| self.vertices[corner as usize].into())
    }

    /// Returns the winding number of the triangles about `point`, with each triangle weighted by `count`.
    pub fn winding_number(&self, point: &Vector3<f64>, count: impl Fn(usize) -> i32) -> i32 {
        let bounds = self.tree.bounds();
        if !(0..3).all(|k| (bounds.lower[k]..=bounds.upper[k]).contains(&point[k])) {
            return 0;
        }
        let mut turns = 0;
        self.tree.along_x(point, |face| turns += count(face) * winding(point, &self.triangle(face)));
        turns
    }
}

impl FourTriangles {
    fn new(triangles: [[Vector3<f64>; 3]; 4]) -> Self {
        let lanes = |value: &dyn Fn(&[Vector3<f64>; 3]) -> Vector3<f64>| {
            let vectors = triangles.each_ref().map(value);
            std::array::from_fn(|k| F64x4(vectors.map(|vector| vector[k])))
        };
        let edges = [lanes(&|[a, b, _]| b - a), lanes(&|[a, _, c]| c - a)];
        Self { corner: lanes(&|[a, _, _]| *a), edges }
    }
}

impl PieceLanes for FourTriangles {
    #[inline(always)]
    fn nearest<A: Arithmetic>(&self, start: &[f64; 3], along: &[f64; 3]) -> NearestFraction<Four<A>> {
        let triangle = TriangleLanes::new(Vec3::of(&self.corner), Vec3::of(&self.edges[0]), Vec3::of(&self.edges[1]));
        let start = Vec3::splat(start);
        if *along == [0.0; 3] {
            let squared = point_to_triangle(start, &triangle);
            return NearestFraction { squared, fraction: Four::splat(0.0) };
        }
        to_triangle(start, Vec3::splat(along), &triangle)
    }
}
