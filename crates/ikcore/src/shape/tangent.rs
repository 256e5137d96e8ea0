//! Signed distance of a point to a set, with its gradient.
//!
//! The signed distance to a convex set (negative inside) is a convex function of the point, so each of its tangents is a
//! lower bound everywhere. All certificates for convex shapes rely on that.

use nalgebra::Vector3;

/// Tangent of the signed distance. For a convex set and every point x: signed distance of x >= value + normal . (x - point),
/// with equality at the point up to rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tangent {
    /// Signed distance of the point (m).
    pub value: f64,
    /// Gradient: unit length, out of the set.
    pub normal: Vector3<f64>,
}

/// Returns the fraction of the segment from `a` to `b` at which it is nearest to `point`.
pub(super) fn nearest_fraction(a: &Vector3<f64>, b: &Vector3<f64>, point: &Vector3<f64>) -> f64 {
    let along = b - a;
    let squared = along.norm_squared();
    if squared > 0.0 { ((point - a).dot(&along) / squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// Returns the point at `fraction` of the way from `a` to `b`.
#[inline]
pub(super) fn point_between(a: &Vector3<f64>, b: &Vector3<f64>, fraction: f64) -> Vector3<f64> {
    a + fraction * (b - a)
}

/// Returns the point of the segment from `a` to `b` nearest to `point`.
pub(super) fn nearest_on_segment(a: &Vector3<f64>, b: &Vector3<f64>, point: &Vector3<f64>) -> Vector3<f64> {
    point_between(a, b, nearest_fraction(a, b, point))
}
