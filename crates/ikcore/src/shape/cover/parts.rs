//! Parts of a mesh, cut by planes.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use crate::math::vector::between;
use crate::shape::mesh::Mesh;

/// Polygons of a mesh on one side of the cutting planes.
#[derive(Debug, Clone)]
pub(super) struct CoveredPart {
    polygons: Vec<Vec<Vector3<f64>>>,
}

/// Plane of points x with normal . x = offset.
#[derive(Debug, Clone, Copy)]
pub(super) struct CuttingPlane {
    normal: Vector3<f64>,
    offset: f64,
}

/// Positions of candidate planes, as fractions of the extent of a part.
const PLACES: [f64; 7] = [0.15, 0.27, 0.38, 0.5, 0.62, 0.73, 0.85];

impl CoveredPart {
    /// Converts a whole mesh.
    pub fn of(mesh: &Mesh) -> Self {
        Self { polygons: (0..mesh.faces().len()).map(|i| mesh.triangle(i).to_vec()).collect() }
    }

    pub fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// Returns the corners of the polygons without duplicates.
    pub fn corners(&self) -> Vec<Vector3<f64>> {
        let mut corners: Vec<Vector3<f64>> = self.polygons.iter().flatten().copied().collect();
        let order = |p: &Vector3<f64>, q: &Vector3<f64>| {
            (0..3).map(|k| p[k].total_cmp(&q[k])).find(|order| order.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
        };
        corners.sort_unstable_by(order);
        corners.dedup();
        corners
    }

    /// Returns planes perpendicular to the principal axes of the corners.
    pub fn candidate_planes(&self) -> Vec<CuttingPlane> {
        let corners = self.corners();
        let axes = principal_axes(&corners);
        let planes = axes.iter().flat_map(|axis| {
            let (low, high) = extent(&corners, axis);
            PLACES.map(|place| CuttingPlane { normal: *axis, offset: between(low, high, place) })
        });
        planes.collect()
    }

    /// Splits the part at `plane`; polygons across the plane are cut, and both halves contain the new corners.
    pub fn cut(&self, plane: &CuttingPlane) -> [Self; 2] {
        [-1.0, 1.0].map(|side| {
            let halves = self.polygons.iter().map(|polygon| clipped(polygon, plane, side));
            Self { polygons: halves.filter(|polygon| polygon.len() > 2).collect() }
        })
    }
}

/// Clips a convex polygon to one side of the plane.
fn clipped(polygon: &[Vector3<f64>], plane: &CuttingPlane, side: f64) -> Vec<Vector3<f64>> {
    let height = |p: &Vector3<f64>| side * (plane.normal.dot(p) - plane.offset);
    if polygon.iter().all(|p| height(p) >= 0.0) {
        return polygon.to_vec();
    }
    let mut kept = vec![];
    for (i, here) in polygon.iter().enumerate() {
        let before = &polygon[(i + polygon.len() - 1) % polygon.len()];
        let (from, to) = (height(before), height(here));
        if (from < 0.0) != (to < 0.0) {
            kept.push(before + from / (from - to) * (here - before));
        }
        if to >= 0.0 {
            kept.push(*here);
        }
    }
    kept
}

/// Returns the smallest and the largest coordinate along `axis`.
pub(super) fn extent(points: &[Vector3<f64>], axis: &Vector3<f64>) -> (f64, f64) {
    let along = points.iter().map(|point| axis.dot(point));
    along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// Returns the principal axes of points.
pub(super) fn principal_axes(points: &[Vector3<f64>]) -> [Vector3<f64>; 3] {
    let middle = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let spread: Matrix3<f64> = points.iter().map(|p| (p - middle) * (p - middle).transpose()).sum();
    let axes = SymmetricEigen::new(spread).eigenvectors;
    [0, 1, 2].map(|k| axes.column(k).into_owned())
}
