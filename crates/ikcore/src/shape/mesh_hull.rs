//! Convex hulls of meshes.

use std::cmp::Ordering;

use nalgebra::Point3;

use super::checked_shape::Shape;
use super::convex_hull::Hull;
use super::geometry::Geometry;
use super::mesh::Mesh;
use crate::math::Pose;

impl Mesh {
    /// Returns the convex hull, moved to `place`; `None` if it lies in a plane, or if rounding leaves a corner outside.
    pub fn convex_hull(&self, place: &Pose) -> Option<Shape> {
        let corners = (0..self.faces().len()).flat_map(|i| self.triangle(i));
        let mut points: Vec<[f64; 3]> = corners.map(|corner| (place * Point3::from(corner)).coords.into()).collect();
        points.sort_unstable_by(|one, other| one.partial_cmp(other).unwrap_or(Ordering::Equal));
        points.dedup();
        let corners: Vec<[f64; 3]> = Hull::new(&points).ok()?.corners().iter().map(|corner| (*corner).into()).collect();
        let hull = Shape::convex_mesh(&corners).ok()?;
        let holds_all = matches!(hull.geometry(), Geometry::ConvexMesh(hull) if hull.holds(&points));
        holds_all.then_some(hull)
    }
}
