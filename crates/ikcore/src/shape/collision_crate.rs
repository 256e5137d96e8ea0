//! The collision crate (parry): the only file that uses its types.

use nalgebra::Vector3;
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::ConvexPolyhedron;

/// A convex polyhedron.
#[derive(Debug, Clone)]
pub(super) struct Polyhedron(ConvexPolyhedron);

impl Polyhedron {
    /// The convex hull of `points`; `None` if they lie in a plane.
    pub fn hull_of(points: &[[f64; 3]]) -> Option<Self> {
        let given: Vec<Vector> = points.iter().map(|[x, y, z]| Vector::new(*x, *y, *z)).collect();
        let (vertices, triangles) = parry3d_f64::transformation::try_convex_hull(&given).ok()?;
        ConvexPolyhedron::from_convex_mesh(vertices, &triangles).map(Self)
    }

    /// Its corners.
    pub fn corners(&self) -> Vec<Vector3<f64>> {
        self.0.points().iter().map(|p| Vector3::new(p.x, p.y, p.z)).collect()
    }

    /// Outward normals of its faces.
    pub fn normals(&self) -> Vec<Vector3<f64>> {
        self.0.faces().iter().map(|face| Vector3::new(face.normal.x, face.normal.y, face.normal.z)).collect()
    }

    /// Corners of its triangles.
    pub fn triangles(&self) -> Vec<[[f64; 3]; 3]> {
        let (corners, triangles) = self.0.to_trimesh();
        let corner = |i: u32| <[f64; 3]>::from(corners[i as usize]);
        triangles.into_iter().map(|triangle| triangle.map(corner)).collect()
    }

    /// The point of the polyhedron nearest to `point`.
    pub fn nearest_point(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let nearest = self.0.project_local_point(Vector::new(point.x, point.y, point.z), true).point;
        Vector3::new(nearest.x, nearest.y, nearest.z)
    }
}
