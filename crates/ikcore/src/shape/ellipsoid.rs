//! Signed distance of a point to an ellipsoid.

use nalgebra::Vector3;

use super::tangent::Tangent;

/// Largest number of Newton steps; a few are enough.
const STEPS: usize = 40;

/// Returns the signed distance to an ellipsoid about the origin with these semi-axes e along x, y, z.
///
/// The nearest surface point is x_i = e_i^2 y_i / (t + e_i^2), with t the largest root of F(t) = sum (e_i y_i / (t +
/// e_i^2))^2 - 1 (Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", 2013). The outward normal
/// n there makes the result a lower bound whatever the error of the root: y lies n . y - |E n| outside the supporting plane
/// with normal n.
pub(super) fn tangent(point: &Vector3<f64>, semi_axes: &[f64; 3]) -> Tangent {
    let e = Vector3::from(*semi_axes);
    let shortest = e.imin();
    // Symmetry maps the point to the first octant; exactly on a plane of symmetry the normal would lose its direction inside.
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

/// Finds the root of F by Newton's method on 1/sqrt(F + 1) - 1, which is concave and increasing, so that steps from the left
/// never pass the root.
fn largest_root(y: &Vector3<f64>, e: &Vector3<f64>) -> f64 {
    let shortest = e.imin();
    let squared = e[shortest] * e[shortest];
    // Starting point at which one term of F alone makes F zero.
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
