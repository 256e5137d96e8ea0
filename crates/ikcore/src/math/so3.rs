//! Logarithm of rotations and its Jacobian, accurate from zero to half a turn.

use super::Frame;
use super::arctangent::angle_of;
use super::arithmetic::NoFma;
use super::real::{One, Real};
use super::vec3::Vec3;

/// Angle (rad) below which series replace quotients that would lose digits.
const SMALL: f64 = 1e-4;

/// Cosine below which a rotation counts as near half a turn.
const NEAR_HALF_TURN: f64 = -0.9;

/// Columns of rotations: their axes in base coordinates.
pub type Axes<R> = [Vec3<R>; 3];

/// Returns the axes of `frame`.
#[inline(always)]
pub fn axes_of(frame: &Frame) -> Axes<One<NoFma>> {
    let [x, y, z] = &frame.axes;
    [Vec3::of(x), Vec3::of(y), Vec3::of(z)]
}

/// Returns the rotation vector phi (rad) of R R_d', with R the axes of `frame` and R_d the axes of `target`: the rotation
/// from the target to the frame, in base coordinates. Its length is the geodesic angle, at most pi.
#[inline]
pub fn rotation_between(target: &Frame, frame: &Frame) -> [f64; 3] {
    let (target, frame) = (axes_of(target), axes_of(frame));
    Turn::between(&target, &frame).vector(&target, &frame).stored()
}

/// Returns [`rotation_between`], and its derivative with respect to a small rotation applied on the left.
#[inline(always)]
pub fn rotation_and_jacobian<R: Real>(target: &Axes<R>, frame: &Axes<R>) -> (Vec3<R>, InverseLeftJacobian<R>) {
    let turn = Turn::between(target, frame);
    let phi = turn.vector(target, frame);
    (phi, InverseLeftJacobian::at(phi, turn.half_cotangent()))
}

/// Rotation R R_d', given by sine and cosine of its angle theta.
struct Turn<R> {
    /// Vector sin(theta) times the axis.
    sine_axis: Vec3<R>,
    sine: R,
    cosine: R,
}

impl<R: Real> Turn<R> {
    #[inline(always)]
    fn between(target: &Axes<R>, frame: &Axes<R>) -> Self {
        // Identities for R R_d' = sum of r_k d_k' over the columns: its trace is sum r_k . d_k, and the vector of its
        // antisymmetric part, sin(theta) axis, is half the sum of d_k x r_k.
        let half = R::splat(0.5);
        let ([dx, dy, dz], [rx, ry, rz]) = (target, frame);
        let trace = dx.dot(*rx) + dy.dot(*ry) + dz.dot(*rz);
        let sine_axis = dx.cross(*rx) * half + dy.cross(*ry) * half + dz.cross(*rz) * half;
        Self { sine_axis, sine: sine_axis.dot(sine_axis).sqrt(), cosine: half * (trace - R::splat(1.0)) }
    }

    #[inline(always)]
    fn vector(&self, target: &Axes<R>, frame: &Axes<R>) -> Vec3<R> {
        let Self { sine_axis, sine, cosine } = *self;
        let angle = angle_of(sine, cosine);
        let series = R::splat(1.0) + sine * sine / R::splat(6.0);
        let mut vector = sine_axis * sine.choose_below(R::splat(SMALL), series, angle / sine);
        for lane in 0..R::LANES {
            if cosine.lane(lane) < NEAR_HALF_TURN {
                let ([dx, dy, dz], [rx, ry, rz]) = (target, frame);
                let target = [dx.lane(lane), dy.lane(lane), dz.lane(lane)];
                let frame = [rx.lane(lane), ry.lane(lane), rz.lane(lane)];
                let exact = near_half_turn(&target, &frame, angle.lane(lane), &sine_axis.lane(lane));
                vector = vector.with_lane(lane, &exact);
            }
        }
        vector
    }

    /// Returns cot(theta/2), by the quotient without cancellation; infinite for the identity.
    #[inline(always)]
    fn half_cotangent(&self) -> R {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let Self { sine, cosine, .. } = *self;
        zero.choose_below(cosine, one + cosine, sine) / zero.choose_below(cosine, sine, one - cosine)
    }
}

/// Computes the rotation vector near half a turn, where the antisymmetric part vanishes: the axis comes from the symmetric
/// part, (R R_d' + R_d R')/2 = cos I + (1 - cos) a a'.
#[cold]
fn near_half_turn(target: &[[f64; 3]; 3], frame: &[[f64; 3]; 3], angle: f64, sine_axis: &[f64; 3]) -> [f64; 3] {
    let entry = |i: usize, j: usize| -> f64 { (0..3).map(|k| frame[k][i] * target[k][j]).sum() };
    let cosine = angle.cos();
    let largest = (0..3).max_by(|i, j| entry(*i, *i).total_cmp(&entry(*j, *j))).unwrap_or(0);
    let mut axis: [f64; 3] = std::array::from_fn(|i| {
        let diagonal = if i == largest { cosine } else { 0.0 };
        0.5 * (entry(i, largest) + entry(largest, i)) - diagonal
    });
    let length = norm(&axis);
    // The symmetric part does not determine the sign; the antisymmetric part, however small, does.
    let sign = if (0..3).map(|k| axis[k] * sine_axis[k]).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    axis.iter_mut().for_each(|v| *v *= sign * angle / length);
    axis
}

/// Inverse left Jacobian of SO(3) at a rotation vector: the derivative of the logarithm with respect to a small rotation
/// applied on the left.
#[derive(Debug, Clone, Copy)]
pub struct InverseLeftJacobian<R> {
    columns: [Vec3<R>; 3],
}

impl<R: Real> InverseLeftJacobian<R> {
    /// Computes I - \[phi\]/2 + quadratic \[phi\]^2 at the rotation vector `phi` (rad), given the cotangent of half its
    /// length.
    #[inline(always)]
    fn at(phi: Vec3<R>, half_cotangent: R) -> Self {
        let (half, one) = (R::splat(0.5), R::splat(1.0));
        let Vec3 { x, y, z } = phi;
        let squared = phi.dot(phi);
        let series = R::splat(1.0 / 12.0) + squared * (R::splat(1.0 / 720.0) + squared / R::splat(30240.0));
        let quotient = (one - half * squared.sqrt() * half_cotangent) / squared;
        let quadratic = squared.choose_below(R::splat(SMALL), series, quotient);
        // Identity [phi]^2 = phi phi' - |phi|^2 I.
        let diagonal = one - quadratic * squared;
        let [qx, qy, qz] = [quadratic * x, quadratic * y, quadratic * z];
        let [xy, yz, zx] = [qx * y, qy * z, qz * x];
        let [hx, hy, hz] = [half * x, half * y, half * z];
        Self {
            columns: [
                Vec3 { x: diagonal + qx * x, y: xy - hz, z: zx + hy },
                Vec3 { x: xy + hz, y: diagonal + qy * y, z: yz - hx },
                Vec3 { x: zx - hy, y: yz + hx, z: diagonal + qz * z },
            ],
        }
    }

    /// Returns the product with `w`.
    #[inline(always)]
    pub fn apply(&self, w: Vec3<R>) -> Vec3<R> {
        let [a, b, c] = self.columns;
        a * w.x + b * w.y + c * w.z
    }
}

/// Rotates `v` by the rotation vector `phi` (rad), by Rodrigues' formula.
#[inline]
pub fn rotated(v: &[f64; 3], phi: &[f64; 3]) -> [f64; 3] {
    let squared = dot(phi, phi);
    // Coefficients sin(x) / x and (1 - cos x) / x^2.
    let (first, second) = if squared < SMALL {
        (1.0 - squared / 6.0 * (1.0 - squared / 20.0), 0.5 - squared / 24.0 * (1.0 - squared / 30.0))
    } else {
        let angle = squared.sqrt();
        (angle.sin() / angle, (1.0 - angle.cos()) / squared)
    };
    turned_twice(v, phi, [first, second])
}

/// Returns the columns of the left Jacobian of SO(3) at `phi` (rad): the angular velocity per rate of each entry of phi.
pub fn left_jacobian(phi: &[f64; 3]) -> [[f64; 3]; 3] {
    let squared = dot(phi, phi);
    // Coefficients (1 - cos x) / x^2 and (x - sin x) / x^3.
    let by = if squared < SMALL {
        [0.5 - squared / 24.0 * (1.0 - squared / 30.0), 1.0 / 6.0 - squared / 120.0 * (1.0 - squared / 42.0)]
    } else {
        let angle = squared.sqrt();
        [(1.0 - angle.cos()) / squared, (1.0 - angle.sin() / angle) / squared]
    };
    Frame::IDENTITY.axes.map(|axis| turned_twice(&axis, phi, by))
}

/// Returns the columns of the inverse of the right Jacobian of SO(3) at `phi` (rad), which must be shorter than 2 pi.
pub fn inverse_right_jacobian(phi: &[f64; 3]) -> [[f64; 3]; 3] {
    let squared = dot(phi, phi);
    let quadratic = if squared < SMALL {
        1.0 / 12.0 + squared * (1.0 / 720.0 + squared / 30240.0)
    } else {
        let half = 0.5 * squared.sqrt();
        (1.0 - half * half.cos() / half.sin()) / squared
    };
    Frame::IDENTITY.axes.map(|axis| turned_twice(&axis, phi, [0.5, quadratic]))
}

/// Returns v + a phi x v + b phi x (phi x v).
#[inline]
fn turned_twice(v: &[f64; 3], phi: &[f64; 3], [a, b]: [f64; 2]) -> [f64; 3] {
    let once = cross(phi, v);
    let twice = cross(phi, &once);
    std::array::from_fn(|k| v[k] + a * once[k] + b * twice[k])
}

/// a'b.
#[inline(always)]
pub fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the Euclidean length.
#[inline(always)]
pub fn norm(v: &[f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// Returns the cross product a x b.
#[inline(always)]
pub fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    use crate::math::pose;
    use nalgebra::{Rotation3, Vector3};

    fn frame(rotation: Rotation3<f64>) -> Frame {
        Frame::from(&pose::from_parts([0.0; 3], *rotation.matrix()))
    }

    fn directions() -> impl Iterator<Item = Vector3<f64>> {
        let axes = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.3, -0.5, 0.8], [-0.6, 0.6, 0.1], [1.0, 1.0, 1e-9]];
        axes.into_iter().map(|a| Vector3::from(a).normalize())
    }

    #[test]
    fn logarithm_of_exponential_is_the_rotation_vector() {
        for axis in directions() {
            for angle in [0.0, 1e-12, 1e-7, 1e-3, 0.5, 2.0, 2.69, 2.7, 3.0, PI - 1e-3, PI - 1e-7, PI - 1e-10] {
                let target = Rotation3::from_euler_angles(0.4, -1.1, 2.0);
                let turned = Rotation3::new(axis * angle) * target;
                let phi = Vector3::from(rotation_between(&frame(target), &frame(turned)));
                assert!(
                    (phi - axis * angle).norm() < 3e-15 + 1e-15 * angle / (3.15 - angle).max(1e-3),
                    "{axis} {angle} {phi}"
                );
            }
        }
    }

    #[test]
    fn half_a_turn_has_length_pi() {
        for axis in directions() {
            let turned = Rotation3::new(axis * PI);
            let phi = Vector3::from(rotation_between(&Frame::IDENTITY, &frame(turned)));
            assert!((phi.norm() - PI).abs() < 1e-14);
            assert!(phi.cross(&axis).norm() < 1e-7);
        }
    }

    #[test]
    fn turned_vectors_are_those_of_the_exponential() {
        for axis in directions() {
            for angle in [0.0, 1e-9, 1e-3, 0.0099, 0.0101, 1.0, 3.0, 6.0] {
                for v in directions() {
                    let turned = Vector3::from(rotated(&v.into(), &(axis * angle).into()));
                    assert!((turned - Rotation3::new(axis * angle) * v).norm() < 1e-14, "{axis} {angle}");
                }
            }
        }
    }

    #[test]
    fn jacobian_predicts_the_change_of_the_logarithm() {
        let h = 1e-6;
        for axis in directions() {
            for angle in [1e-6, 5e-3, 0.0101, 0.7, 2.5, 2.9] {
                let phi = axis * angle;
                let (_, jacobian) =
                    rotation_and_jacobian(&axes_of(&Frame::IDENTITY), &axes_of(&frame(Rotation3::new(phi))));
                for w in directions() {
                    let after = |s: f64| {
                        let turned = Rotation3::new(w * s) * Rotation3::new(phi);
                        Vector3::from(rotation_between(&Frame::IDENTITY, &frame(turned)))
                    };
                    let difference = (after(h) - after(-h)) / (2.0 * h);
                    let predicted = Vector3::from(jacobian.apply(Vec3::of(&w.into())).stored());
                    assert!((difference - predicted).norm() < 1e-8, "{axis} {angle}: {difference} {predicted}");
                }
            }
        }
    }
}
