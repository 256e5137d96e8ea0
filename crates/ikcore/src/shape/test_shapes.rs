//! Points and meshes for the tests of shapes.

use nalgebra::Vector3;

use super::checked_shape::Shape;
use super::geometry::Geometry;
use super::mesh::Mesh;
use crate::rng::LazyRng;

/// Corners of the squares of a box: bit k of a number is set on the upper side along axis k.
pub const SQUARES: [[usize; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// Draws a point whose coordinates are at most `reach`.
pub fn point(rng: &mut LazyRng, reach: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.uniform_in(-reach, reach))
}

/// Returns these triangles as a mesh, with separate corners for each.
pub fn mesh_of(triangles: &[[[f64; 3]; 3]]) -> Shape {
    let faces = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Shape::mesh(triangles.as_flattened().to_vec(), faces).unwrap()
}

/// Returns the mesh of a shape that is one.
pub fn as_mesh(shape: &Shape) -> &Mesh {
    match shape.geometry() {
        Geometry::Mesh(mesh) => mesh,
        _ => unreachable!(),
    }
}
