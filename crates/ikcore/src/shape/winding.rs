//! Winding numbers: how many times a mesh encloses a point.
//!
//! A ray from the point along x crosses the surface; crossings outward and inward count with opposite signs. In the
//! projection along x, a triangle covers the point if its edges pass on the same side of it. Each edge is compared from its
//! lower to its upper end, so that both triangles of an edge agree to the bit, and a point on an edge counts for exactly one.

use nalgebra::Vector3;

/// Returns +1 or -1 if the ray from `point` along x crosses the triangle out of or into the surface, else 0.
pub(super) fn winding(point: &Vector3<f64>, corners: &[Vector3<f64>; 3]) -> i32 {
    let [a, b, c] = corners;
    let sides = [side(point, a, b), side(point, b, c), side(point, c, a)];
    // Winding of the triangle about the point in the projection along x.
    let turns: i32 = sides.iter().sum();
    if turns == 0 {
        return 0;
    }
    let normal = (b - a).cross(&(c - a));
    let beyond = (a - point).dot(&normal) * normal.x.signum();
    if beyond > 0.0 { turns } else { 0 }
}

/// Returns, in the projection along x, +1 if the edge passes upward in z on the positive y side of the point, -1 if downward,
/// else 0.
fn side(point: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> i32 {
    let above = |p: &Vector3<f64>| p.z > point.z;
    if above(from) == above(to) {
        return 0;
    }
    let (lower, upper, turn) = if above(to) { (from, to, 1) } else { (to, from, -1) };
    let left = (upper.y - lower.y) * (point.z - lower.z) - (point.y - lower.y) * (upper.z - lower.z);
    if left > 0.0 { turn } else { 0 }
}
