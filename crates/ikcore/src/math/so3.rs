//! Rotations: logarithm and the Jacobian that goes with it, safe at no turn and at half a turn.

use super::Frame;

/// Below this angle (rad) series replace quotients that lose their digits.
const SMALL: f64 = 1e-4;

/// The rotation vector phi (rad) of R R_d', with R the axes of `frame` and R_d those of `target`: the turn that leads
/// from the target to the frame, in base coordinates. Its length is the geodesic angle, at most pi.
#[inline]
pub fn rotation_between(target: &Frame, frame: &Frame) -> [f64; 3] {
    Turn::between(target, frame).vector(target, frame)
}

/// [`rotation_between`], and how it changes when a small turn is put before.
#[inline]
pub fn rotation_and_jacobian(target: &Frame, frame: &Frame) -> ([f64; 3], InverseLeftJacobian) {
    let turn = Turn::between(target, frame);
    let phi = turn.vector(target, frame);
    (phi, InverseLeftJacobian::at(&phi, turn.half_cotangent()))
}

/// R R_d' by sine and cosine of its angle theta.
struct Turn {
    /// sin(theta), times the axis.
    sine_axis: [f64; 3],
    sine: f64,
    cosine: f64,
}

impl Turn {
    #[inline(always)]
    fn between(target: &Frame, frame: &Frame) -> Self {
        // With R R_d' = sum of r_k d_k' over the columns: its trace is sum r_k . d_k, and the vector of its
        // antisymmetric part, sin(theta) axis, is half the sum of d_k x r_k.
        let (mut trace, mut sine_axis) = (0.0, [0.0; 3]);
        for (d, r) in target.axes.iter().zip(&frame.axes) {
            trace += d[0] * r[0] + d[1] * r[1] + d[2] * r[2];
            sine_axis[0] += 0.5 * (d[1] * r[2] - d[2] * r[1]);
            sine_axis[1] += 0.5 * (d[2] * r[0] - d[0] * r[2]);
            sine_axis[2] += 0.5 * (d[0] * r[1] - d[1] * r[0]);
        }
        Self { sine_axis, sine: norm(&sine_axis), cosine: 0.5 * (trace - 1.0) }
    }

    #[inline(always)]
    fn vector(&self, target: &Frame, frame: &Frame) -> [f64; 3] {
        let Self { sine_axis, sine, cosine } = *self;
        if cosine < -0.9 {
            return near_half_turn(target, frame, sine.atan2(cosine), &sine_axis);
        }
        let factor = if sine < SMALL { 1.0 + sine * sine / 6.0 } else { sine.atan2(cosine) / sine };
        sine_axis.map(|v| factor * v)
    }

    /// cot(theta/2), by the quotient that keeps its digits; infinite without a turn.
    #[inline(always)]
    fn half_cotangent(&self) -> f64 {
        if self.cosine > 0.0 { (1.0 + self.cosine) / self.sine } else { self.sine / (1.0 - self.cosine) }
    }
}

/// Near half a turn the antisymmetric part vanishes: the axis comes from the symmetric part,
/// (R R_d' + R_d R')/2 = cos I + (1 - cos) a a'.
#[cold]
fn near_half_turn(target: &Frame, frame: &Frame, angle: f64, sine_axis: &[f64; 3]) -> [f64; 3] {
    let entry = |i: usize, j: usize| -> f64 { (0..3).map(|k| frame.axes[k][i] * target.axes[k][j]).sum() };
    let cosine = angle.cos();
    let largest = (0..3).max_by(|i, j| entry(*i, *i).total_cmp(&entry(*j, *j))).unwrap_or(0);
    let mut axis: [f64; 3] = std::array::from_fn(|i| {
        let diagonal = if i == largest { cosine } else { 0.0 };
        0.5 * (entry(i, largest) + entry(largest, i)) - diagonal
    });
    let length = norm(&axis);
    // The symmetric part leaves the sign open; the antisymmetric part, however small, decides it.
    let sign = if (0..3).map(|k| axis[k] * sine_axis[k]).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    axis.iter_mut().for_each(|v| *v *= sign * angle / length);
    axis
}

/// The inverse left Jacobian of SO(3) at a rotation vector: how the logarithm changes when a small turn is put before.
#[derive(Debug, Clone, Copy)]
pub struct InverseLeftJacobian {
    columns: [[f64; 3]; 3],
}

impl InverseLeftJacobian {
    /// I - [phi]/2 + quadratic * [phi]^2 at the rotation vector `phi` (rad), given the cotangent of half its length.
    #[inline(always)]
    fn at(phi: &[f64; 3], half_cotangent: f64) -> Self {
        let [x, y, z] = *phi;
        let squared = x * x + y * y + z * z;
        let quadratic = if squared < SMALL {
            1.0 / 12.0 + squared * (1.0 / 720.0 + squared / 30240.0)
        } else {
            (1.0 - 0.5 * squared.sqrt() * half_cotangent) / squared
        };
        // [phi]^2 = phi phi' - |phi|^2 I
        let diagonal = 1.0 - quadratic * squared;
        let [qx, qy, qz] = [quadratic * x, quadratic * y, quadratic * z];
        let [xy, yz, zx] = [qx * y, qy * z, qz * x];
        let [hx, hy, hz] = [0.5 * x, 0.5 * y, 0.5 * z];
        Self {
            columns: [
                [diagonal + qx * x, xy - hz, zx + hy],
                [xy + hz, diagonal + qy * y, yz - hx],
                [zx - hy, yz + hx, diagonal + qz * z],
            ],
        }
    }

    /// Its product with `w`.
    #[inline(always)]
    pub fn apply(&self, w: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = &self.columns;
        std::array::from_fn(|k| a[k] * w[0] + b[k] * w[1] + c[k] * w[2])
    }
}

/// `v`, turned by the rotation vector `phi` (rad): Rodrigues' formula.
#[inline]
pub fn rotated(v: &[f64; 3], phi: &[f64; 3]) -> [f64; 3] {
    let squared = phi.iter().map(|entry| entry * entry).sum::<f64>();
    // sin(x) / x and (1 - cos x) / x^2.
    let (first, second) = if squared < SMALL {
        (1.0 - squared / 6.0 * (1.0 - squared / 20.0), 0.5 - squared / 24.0 * (1.0 - squared / 30.0))
    } else {
        let angle = squared.sqrt();
        (angle.sin() / angle, (1.0 - angle.cos()) / squared)
    };
    let once = cross(phi, v);
    let twice = cross(phi, &once);
    std::array::from_fn(|k| v[k] + first * once[k] + second * twice[k])
}

/// Euclidean length.
#[inline(always)]
pub fn norm(v: &[f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// a x b.
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
                let (_, jacobian) = rotation_and_jacobian(&Frame::IDENTITY, &frame(Rotation3::new(phi)));
                for w in directions() {
                    let after = |s: f64| {
                        let turned = Rotation3::new(w * s) * Rotation3::new(phi);
                        Vector3::from(rotation_between(&Frame::IDENTITY, &frame(turned)))
                    };
                    let difference = (after(h) - after(-h)) / (2.0 * h);
                    let predicted = Vector3::from(jacobian.apply(w.into()));
                    assert!((difference - predicted).norm() < 1e-8, "{axis} {angle}: {difference} {predicted}");
                }
            }
        }
    }
}
