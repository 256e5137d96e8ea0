//! Small capsules around given points.

use nalgebra::{Matrix3, Vector3};

use super::parts::{extent, principal_axes};
use crate::error::Result;
use crate::shape::checked_shape::Shape;
use crate::shape::collision_crate::Polyhedron;
use crate::shape::tangent::nearest_on_segment;

/// Capsule fitted around points (m).
#[derive(Debug, Clone, Copy)]
pub(in crate::shape) struct FittedCapsule {
    a: Vector3<f64>,
    b: Vector3<f64>,
    radius: f64,
}

impl FittedCapsule {
    pub fn volume(&self) -> f64 {
        let area = std::f64::consts::PI * self.radius * self.radius;
        area * ((self.b - self.a).norm() + 4.0 / 3.0 * self.radius)
    }

    /// Enlarges the radius if necessary to contain all `points`, so that the result does not rely on the accuracy of the fit.
    fn holding(self, points: &[Vector3<f64>]) -> Self {
        let apart = |point: &Vector3<f64>| (nearest_on_segment(&self.a, &self.b, point) - point).norm();
        let farthest = points.iter().map(apart).fold(0.0, f64::max);
        Self { radius: self.radius.max(farthest * GROWTH), ..self }
    }

    /// Returns the ends of the axis and the radius.
    pub fn parts(&self) -> ([f64; 3], [f64; 3], f64) {
        (self.a.into(), self.b.into(), self.radius)
    }

    /// Converts to a shape: a sphere if the axis has no length.
    pub fn shape(&self) -> Result<Shape> {
        let (a, b, radius) = self.parts();
        Shape::swept_ball(a, b, radius)
    }
}

/// Number of steps towards the centre of the smallest circle.
const CIRCLE_STEPS: usize = 40;
/// Number of steps for a rough fit.
const FEW_STEPS: usize = 10;
/// Number of points in a rough fit.
const FEW_POINTS: usize = 150;
/// Number of points above which only the corners of their hull are used.
const MANY_POINTS: usize = 60;
/// Radii tried, relative to the smallest circle: a larger radius makes a shorter capsule.
const RADII: [f64; 4] = [1.0, 1.03, 1.08, 1.18];
/// Successive rotations of the axis about the best one (rad).
const TURNS: [f64; 4] = [0.2, 0.1, 0.05, 0.02];
/// Relative enlargement, so that rounding leaves no point outside.
const GROWTH: f64 = 1.0 + 1e-9;
/// Smallest radius (m), for points on a straight line.
const THINNEST: f64 = 1e-6;

/// Returns the smallest capsule found that contains all points.
pub(in crate::shape) fn smallest_capsule(all: &[Vector3<f64>]) -> FittedCapsule {
    let hull = (all.len() > MANY_POINTS).then(|| hull_corners(all)).flatten();
    let points = hull.as_deref().unwrap_or(all);
    let along = |points: &[Vector3<f64>], axis: &Vector3<f64>| along(points, axis, CIRCLE_STEPS);
    let diagonal = |x: f64, y: f64, z: f64| Vector3::new(x, y, z).normalize();
    let others = [Vector3::x(), Vector3::y(), Vector3::z(), diagonal(1.0, 1.0, 0.0), diagonal(1.0, -1.0, 0.0)];
    let tried = principal_axes(points).into_iter().chain(others).map(|axis| (axis, along(points, &axis)));
    let smaller = |one: (Vector3<f64>, FittedCapsule), other: (Vector3<f64>, FittedCapsule)| {
        if other.1.volume() < one.1.volume() { other } else { one }
    };
    let first = (Vector3::z(), along(points, &Vector3::z()));
    let mut best = tried.fold(first, smaller);
    for turn in TURNS {
        let side = best.0.cross(&Vector3::ith(best.0.iamin(), 1.0)).normalize();
        let up = best.0.cross(&side);
        let turned = [side, -side, up, -up].map(|way| (best.0 + turn * way).normalize());
        best = turned.into_iter().map(|axis| (axis, along(points, &axis))).fold(best, smaller);
    }
    best.1.holding(all)
}

/// Estimates the volume of the smallest capsule (m^3).
pub(super) fn rough_volume(points: &[Vector3<f64>]) -> f64 {
    let few: Vec<Vector3<f64>> = points.iter().copied().step_by(points.len().div_ceil(FEW_POINTS).max(1)).collect();
    let volumes = principal_axes(&few).map(|axis| along(&few, &axis, FEW_STEPS).volume());
    volumes.into_iter().fold(f64::INFINITY, f64::min)
}

/// Returns the corners of the convex hull; `None` for points in a plane.
fn hull_corners(points: &[Vector3<f64>]) -> Option<Vec<Vector3<f64>>> {
    let points: Vec<[f64; 3]> = points.iter().map(|point| (*point).into()).collect();
    // Missing corners do no harm, since the capsule is enlarged afterwards.
    Polyhedron::hull_of(&points, &Matrix3::identity()).map(|hull| hull.corners())
}

/// Returns the smallest capsule found with its axis along `axis`.
fn along(points: &[Vector3<f64>], axis: &Vector3<f64>, steps: usize) -> FittedCapsule {
    let (center, circle) = smallest_circle(points, axis, steps);
    let capsules = RADII.map(|growth| {
        let radius = (circle * growth * GROWTH).max(THINNEST);
        // Containment: a point at `height` and at distance `aside` from the axis is inside if the axis extends to within
        // `rest` of that height.
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for point in points {
            let offset = point - center;
            let height = axis.dot(&offset);
            let aside = (offset - height * axis).norm_squared();
            let rest = (radius * radius - aside).max(0.0).sqrt() / GROWTH;
            low = low.min(height + rest);
            high = high.max(height - rest);
        }
        // All points are near one position on the axis.
        if low > high {
            (low, high) = (0.5 * (low + high), 0.5 * (low + high));
        }
        FittedCapsule { a: center + low * axis, b: center + high * axis, radius: radius * GROWTH }
    });
    capsules
        .into_iter()
        .reduce(|best, next| if next.volume() < best.volume() { next } else { best })
        .unwrap_or(capsules[0])
}

/// Returns a point of the axis and the radius of a small cylinder along `axis` around all points (Badoiu and Clarkson 2003).
fn smallest_circle(points: &[Vector3<f64>], axis: &Vector3<f64>, steps: usize) -> (Vector3<f64>, f64) {
    let first = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    let second = axis.cross(&first);
    let [(left, right), (lower, upper)] = [extent(points, &first), extent(points, &second)];
    let mut center = 0.5 * ((left + right) * first + (lower + upper) * second);
    let farthest = |center: &Vector3<f64>| {
        let aside = |point: &Vector3<f64>| {
            let offset = point - center;
            offset - axis.dot(&offset) * axis
        };
        let all = points.iter().map(aside);
        all.max_by(|one, other| one.norm_squared().total_cmp(&other.norm_squared())).unwrap_or_default()
    };
    let mut best = (center, farthest(&center).norm());
    for step in 1..=steps {
        center += farthest(&center) / (step + 1) as f64;
        let radius = farthest(&center).norm();
        if radius < best.1 {
            best = (center, radius);
        }
    }
    best
}
