//! Nearest point of a triangle.

use nalgebra::Vector3;

use super::tangent::nearest_on_segment;

/// Returns the point of the triangle nearest to `point`; the triangle may degenerate to a line or a point.
pub(super) fn nearest_on_triangle(point: &Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> Vector3<f64> {
    let (ab, ac, w) = (b - a, c - a, point - a);
    let normal = ab.cross(&ac);
    let squared = normal.norm_squared();
    if squared > 0.0 {
        let beta = normal.dot(&w.cross(&ac)) / squared;
        let gamma = normal.dot(&ab.cross(&w)) / squared;
        if beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0 {
            return a + beta * ab + gamma * ac;
        }
    }
    let edges = [(a, b), (b, c), (c, a)].map(|(from, to)| nearest_on_segment(from, to, point));
    let nearer = |p: &Vector3<f64>, q: &Vector3<f64>| (p - point).norm_squared() <= (q - point).norm_squared();
    edges.into_iter().reduce(|best, next| if nearer(&best, &next) { best } else { next }).unwrap_or(*a)
}
