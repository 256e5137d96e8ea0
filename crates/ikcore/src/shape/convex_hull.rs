//! Convex hulls of points.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::bounding_ball::BoundingBall;
use super::bounding_tree::Aabb;
use super::collision_crate::Polyhedron;
use super::tangent::Tangent;

/// Convex hull of a set of points.
#[derive(Debug, Clone)]
pub struct Hull {
    points: Vec<[f64; 3]>,
    corners: Vec<Vector3<f64>>,
    /// Outward normal n and offset d of each face: n . x <= d inside.
    faces: Vec<(Vector3<f64>, f64)>,
    polyhedron: Polyhedron,
}

impl PartialEq for Hull {
    /// Compares the points alone, since they determine all other fields.
    fn eq(&self, other: &Self) -> bool {
        self.points == other.points
    }
}

/// Thickness below which a body is flat, relative to its size.
const THINNEST: f64 = 1e-6;

/// Range of extents (m) whose products neither vanish nor overflow.
const EXTENTS: [f64; 2] = [1e-75, 1e75];

/// Distance by which rounding may leave a point outside, relative to the size.
const STICKING_OUT: f64 = 1e-9;

impl Hull {
    /// Builds the hull; the error describes the problem with the points.
    pub(super) fn new(points: &[[f64; 3]]) -> Result<Self, String> {
        let flat = || "the points of a convex mesh lie in a plane: it needs at least 4 that do not".to_string();
        if points.len() < 4 {
            return Err(format!(
                "a convex mesh needs at least 4 points that do not lie in a plane, got {}",
                points.len()
            ));
        }
        let Aabb { lower, upper } = Aabb::around(points.iter().map(|point| Vector3::from(*point)));
        let extent = (upper - lower).amax();
        let [smallest, largest] = EXTENTS;
        if extent > 0.0 && !(smallest..=largest).contains(&extent) {
            return Err(format!("a convex mesh must measure {smallest:e} to {largest:e} m, got {extent:e}"));
        }
        let stretch = stretch(points).ok_or_else(flat)?;
        let polyhedron = Polyhedron::hull_of(points, &stretch).ok_or_else(flat)?;
        let corners = polyhedron.corners();
        let with_offset = |normal: Vector3<f64>| (normal, support(&corners, &normal));
        let faces = polyhedron.normals().into_iter().map(with_offset).collect();
        Ok(Self { points: points.to_vec(), faces, corners, polyhedron })
    }

    /// Returns the points as given (m).
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// Returns the corners (m).
    pub(super) fn corners(&self) -> &[Vector3<f64>] {
        &self.corners
    }

    /// Returns the corners of the hull's triangles (m), for drawing.
    pub fn triangles(&self) -> Vec<[[f64; 3]; 3]> {
        self.polyhedron.triangles()
    }

    /// Whether the hull contains all points up to rounding.
    pub(super) fn holds(&self, points: &[[f64; 3]]) -> bool {
        let size = self.bounding_ball().radius;
        self.faces.iter().all(|(normal, offset)| {
            points.iter().all(|point| normal.dot(&Vector3::from(*point)) - offset <= STICKING_OUT * size)
        })
    }

    /// Returns a ball that contains the hull.
    pub(super) fn bounding_ball(&self) -> BoundingBall {
        let middle = self.corners.iter().sum::<Vector3<f64>>() / self.corners.len() as f64;
        let radius = self.corners.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max);
        BoundingBall { center: middle.into(), radius }
    }

    /// Returns the signed distance of `point` with its gradient. The crate proposes the nearest point; the plane through the
    /// corners bounds the distance whatever the error of the crate.
    pub(super) fn tangent(&self, point: &Vector3<f64>) -> Tangent {
        let beyond =
            |(normal, offset): &(Vector3<f64>, f64)| Tangent { value: normal.dot(point) - offset, normal: *normal };
        let of_face = self.faces.iter().map(beyond).fold(None, |best: Option<Tangent>, next| match best {
            Some(best) if best.value >= next.value => Some(best),
            _ => Some(next),
        });
        let of_face = of_face.unwrap_or(Tangent { value: f64::NEG_INFINITY, normal: Vector3::x() });
        if of_face.value <= 0.0 {
            return of_face;
        }
        let away = point - self.polyhedron.nearest_point(point);
        let normal = away.normalize();
        let value = normal.dot(point) - support(&self.corners, &normal);
        if value > of_face.value { Tangent { value, normal } } else { of_face }
    }
}

/// Returns the largest coordinate of the corners along `normal`.
fn support(corners: &[Vector3<f64>], normal: &Vector3<f64>) -> f64 {
    corners.iter().map(|corner| corner.dot(normal)).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the map that makes the points about equally wide in all directions; `None` if they lie in a plane.
fn stretch(points: &[[f64; 3]]) -> Option<Matrix3<f64>> {
    let middle = points.iter().map(|p| Vector3::from(*p)).sum::<Vector3<f64>>() / points.len() as f64;
    let spread: Matrix3<f64> = points.iter().map(|p| Vector3::from(*p) - middle).map(|v| v * v.transpose()).sum();
    let SymmetricEigen { eigenvalues: squared, eigenvectors: axes } = spread.symmetric_eigen();
    let extents = squared.map(|squared| squared.max(0.0).sqrt());
    let thick = extents.min() > THINNEST * extents.max() && extents.max().is_finite();
    thick.then(|| axes * Matrix3::from_diagonal(&extents.map(f64::recip)) * axes.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;

    #[test]
    fn thin_hulls_hold_all_their_points() {
        let mut rng = rng::stream(1, 0);
        for round in 0..2000 {
            let thickness = 10.0_f64.powf(rng.uniform_in(-5.0, 0.0));
            let count = 4 + rng.below(30);
            let turn = nalgebra::Rotation3::from_euler_angles(rng.uniform(), rng.uniform(), rng.uniform());
            let box_like = round % 2 == 0;
            let points: Vec<[f64; 3]> = (0..count)
                .map(|_| {
                    let any = Vector3::from_fn(|_, _| rng.uniform_in(-1.0, 1.0));
                    let point = if box_like { any.map(f64::signum) } else { any };
                    (turn * point.component_mul(&Vector3::new(1.0, 0.7, thickness))).into()
                })
                .collect();
            let Ok(hull) = Hull::new(&points) else { continue };
            for _ in 0..20 {
                let normal = Vector3::from_fn(|_, _| rng.uniform_in(-1.0, 1.0)).normalize();
                let farthest = points.iter().map(|p| Vector3::from(*p).dot(&normal)).fold(f64::NEG_INFINITY, f64::max);
                assert!((support(hull.corners(), &normal) - farthest).abs() < 1e-12, "{points:?}");
            }
            assert!(hull.holds(&points));
        }
    }
}
