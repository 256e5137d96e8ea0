//! Newton's method from a candidate with a small error.

use super::residuals::difference;
use super::stiffness::{compliance, stiffness};
use crate::closed_form::axis_chain::{AxisChain, AxisKind};
use crate::closed_form::branches::BranchFit;
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::real::{One, Real};
use crate::math::vector::{dot, norm};
use crate::math::vector3::{Vector, add, cross, scaled, sub};

/// Largest residual of a branch, in position (m) and rotation (rad).
pub const TOLERANCE: f64 = 1e-10;

const ITERATIONS: usize = 24;

/// Refines `q` by Newton's method until the tip is at `target`; on failure returns the smallest residual (m, rad) and where it
/// was.
///
/// Each step adds one to `evaluations`. Damping by the squared error keeps steps short near a double root, where the Jacobian
/// is singular.
pub fn polished<const N: usize>(
    chain: &AxisChain<N>,
    target: &Frame,
    mut q: [f64; N],
    evaluations: &mut usize,
) -> Result<([f64; N], BranchFit), (f64, [f64; N])> {
    let mut last = f64::INFINITY;
    let mut best = (f64::INFINITY, q, BranchFit::default());
    for _ in 0..ITERATIONS {
        *evaluations += 1;
        let (tip, columns) = jacobian(chain, &q);
        let residual = difference(&tip, target);
        let error = error(&tip, target);
        if residual < best.0 {
            let (position, rotation) = (norm(&error[..3]), norm(&error[3..]));
            best = (residual, q, BranchFit { position, rotation, stiffness: stiffness_of(&columns) });
        }
        // Stop only when further steps no longer pay, even within the tolerance.
        if !(residual.is_finite()) || residual <= TOLERANCE && residual > 0.1 * last || residual < 1e-14 {
            break;
        }
        last = residual;
        let square = dot(&error, &error);
        let step = damped_step(&columns, &error, 1e-3 * square.min(1.0) + 1e-16);
        (0..N).for_each(|k| q[k] += step[k]);
    }
    let (residual, q, error) = best;
    let turns = |k: usize| chain.joints[k].motion == AxisKind::Turns;
    let q = std::array::from_fn(|k| if turns(k) { wrapped(q[k]) } else { q[k] });
    if residual <= TOLERANCE { Ok((q, error)) } else { Err((residual, q)) }
}

/// Wraps the angle to (-pi, pi].
fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let rest = angle.rem_euclid(TAU);
    if rest > PI { rest - TAU } else { rest }
}

/// Returns the position (m) and rotation error (rad) from tip to target.
fn error(tip: &Frame, target: &Frame) -> [f64; 6] {
    let [px, py, pz] = sub(&target.origin, &tip.origin);
    let sum = (0..3).fold([0.0; 3], |sum: Vector, k| add(&sum, &cross(&tip.axes[k], &target.axes[k])));
    let [rx, ry, rz] = scaled(&sum, 0.5);
    [px, py, pz, rx, ry, rz]
}

fn stiffness_of<const N: usize>(columns: &[[f64; 6]; N]) -> f64 {
    let of_columns = || compliance(&columns.map(|column| column.map(One::<Baseline>::of))).stored();
    if N <= 6 { stiffness(of_columns()) } else { 0.0 }
}

/// Returns the tip frame and its geometric Jacobian, one column per joint.
fn jacobian<const N: usize>(chain: &AxisChain<N>, q: &[f64; N]) -> (Frame, [[f64; 6]; N]) {
    let mut moved = [Frame::IDENTITY; N];
    let mut sum = Frame::IDENTITY;
    for k in 0..N {
        moved[k] = sum;
        sum = sum.then::<Baseline>(&chain.joints[k].displacement(q[k]));
    }
    let tip = sum.then::<Baseline>(&chain.tip);
    let columns = std::array::from_fn(|k| {
        let joint = chain.joints[k].moved(&moved[k]);
        let [hx, hy, hz] = joint.axis;
        match joint.motion {
            AxisKind::Turns => {
                let [vx, vy, vz] = cross(&joint.axis, &sub(&tip.origin, &joint.point));
                [vx, vy, vz, hx, hy, hz]
            }
            AxisKind::Slides => [hx, hy, hz, 0.0, 0.0, 0.0],
        }
    });
    (tip, columns)
}

/// Solves for the damped step: (J'J + damping) step = J'error, or J'(JJ' + damping)^-1 error, whichever system is smaller;
/// the larger one is singular.
fn damped_step<const N: usize>(columns: &[[f64; 6]; N], error: &[f64; 6], damping: f64) -> [f64; N] {
    let along = |v: &[f64; 6]| columns.map(|column| (0..6).map(|k| column[k] * v[k]).sum::<f64>());
    if N <= 6 {
        let entry = |i: usize, j: usize| (0..6).map(|k| columns[i][k] * columns[j][k]).sum();
        return solved(entry, damping, along(error));
    }
    let entry = |i: usize, j: usize| columns.iter().map(|column| column[i] * column[j]).sum();
    along(&solved(entry, damping, *error))
}

/// Solves (A + damping) x = b by Cholesky decomposition.
fn solved<const N: usize>(a: impl Fn(usize, usize) -> f64, damping: f64, b: [f64; N]) -> [f64; N] {
    let mut factor = [[0.0; N]; N];
    let mut x = b;
    for i in 0..N {
        for j in 0..=i {
            let mut sum = a(i, j) + if i == j { damping } else { 0.0 };
            for k in 0..j {
                sum -= factor[i][k] * factor[j][k];
            }
            factor[i][j] = if i == j { sum.max(1e-30).sqrt() } else { sum / factor[j][j] };
        }
        for k in 0..i {
            x[i] -= factor[i][k] * x[k];
        }
        x[i] /= factor[i][i];
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            x[i] -= factor[k][i] * x[k];
        }
        x[i] /= factor[i][i];
    }
    x
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::closed_form::seven_joint_arms::{PANDA, random_angles};

    #[test]
    fn a_redundant_arm_moves_as_little_as_it_must() {
        let chain = AxisChain::of_rows(&PANDA);
        for mut q in random_angles(100) {
            // Configuration away from singularities.
            (q[3], q[5]) = (-1.5 + 0.3 * q[3], 1.5 + 0.3 * q[5]);
            let start: [f64; 7] = std::array::from_fn(|k| q[k] + 1e-4 * (k as f64 - 3.0));
            let mut evaluations = 0;
            let (found, error) = polished(&chain, &chain.tip_at(&q), start, &mut evaluations).expect("it is near");
            let moved = |to: &[f64; 7]| {
                let off = |k: usize| wrapped(to[k] - start[k]);
                (0..7).map(|k| off(k) * off(k)).sum::<f64>().sqrt()
            };
            assert!(error.position < 1e-10 && error.rotation < 1e-10 && evaluations < 8, "{evaluations}");
            assert!(moved(&found) < 1.01 * moved(&q), "{} {}", moved(&found), moved(&q));
        }
    }
}
