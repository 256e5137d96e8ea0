//! The signed distance of a point to an ellipsoid.

use nalgebra::Vector3;

use super::tangent::Tangent;

/// Steps for the one unknown; a few are enough.
const STEPS: usize = 40;

/// Of an ellipsoid about the origin with these semi-axes e along x, y, z.
///
/// The nearest surface point is x_i = e_i^2 y_i / (t + e_i^2), with t the largest root of F(t) = sum (e_i y_i / (t +
/// e_i^2))^2 - 1 (Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", 2013). Its outward
/// normal n makes the result a bound that holds for any error of the root: y lies n . y - |E n| outside the supporting
/// plane with normal n.
pub(super) fn tangent(point: &Vector3<f64>, semi_axes: &[f64; 3]) -> Tangent {
    let e = Vector3::from(*semi_axes);
    let shortest = e.imin();
    // By symmetry in the first octant; exactly on a plane of symmetry the normal would lose its direction inside.
    let y = point.abs().sup(&(e * 1e-12));
    let t = largest_root(&y, &e);
    let mut direction = Vector3::from_fn(|i, _| y[i] / (t + e[i] * e[i]));
    if !(direction.norm() > 0.0 && direction.iter().all(|x| x.is_finite())) {
        direction = Vector3::zeros();
        direction[shortest] = 1.0;
    }
    let normal = direction.normalize().zip_map(point, |n, coordinate| n.copysign(coordinate));
    Tangent { value: normal.dot(point) - e.component_mul(&normal).norm(), normal }
}

/// The root of F. Newton's steps on 1/sqrt(F + 1) - 1, which is concave and rises, never pass it from the left.
fn largest_root(y: &Vector3<f64>, e: &Vector3<f64>) -> f64 {
    let shortest = e.imin();
    let squared = e[shortest] * e[shortest];
    // There one term of F alone makes it zero.
    let mut t = e[shortest] * y[shortest] - squared;
    for _ in 0..STEPS {
        let (mut sum, mut slope) = (0.0, 0.0);
        for k in 0..3 {
            let denominator = t + e[k] * e[k];
            let ratio = e[k] * y[k] / denominator;
            sum += ratio * ratio;
            slope -= 2.0 * ratio * ratio / denominator;
        }
        let step = 2.0 * sum * (1.0 - sum.sqrt()) / slope;
        if !(step > 1e-15 * (t.abs() + squared)) {
            break;
        }
        t += step;
    }
    t
}
