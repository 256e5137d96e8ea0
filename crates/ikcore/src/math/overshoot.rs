//! Weights of joints that make the ticks of a motion overshoot.
//!
//! Each tick makes the motion y = W dx of least |y|^2 that meets its task, y = -J' f with multipliers f. The next tick starts
//! elsewhere, with another J: a deviation d of this one that leaves the tip where it is changes its motion by -H d, where
//! H = sum_i f_i d^2 r_i / dy^2. Where H has an eigenvalue above 1, motions overshoot from side to side of the posture that costs
//! least, as in an explicit integration of a stiff equation. A stretched arm on a heavy base is such a posture: its elbow bends far
//! for little, and f grows with the square of the weights.

use smallvec::SmallVec;

use super::arithmetic::NoFma;
use super::box_step::ROWS;
use super::gram::gram;
use super::ldl;
use super::vector::squared_size;
use super::vector3::{cross, dot};
use super::{JointWeights, STACK_DOF};

/// Damping of the multipliers, relative to the squared size of the Jacobian.
const DAMPING: f64 = 1e-12;

/// Largest eigenvalue of H. A Jacobian that is extrapolated to the middle of a tick overshoots sooner than that of its start.
const LARGEST: f64 = 0.8;

/// Smallest and largest factor by which weights are lowered at once.
const LOWERED: [f64; 2] = [0.1, 0.8];

/// Symmetric matrix (n, n), row by row.
type Matrix = SmallVec<[f64; STACK_DOF * STACK_DOF / 4]>;

/// Motion of one tick.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TickMotion<'a> {
    /// Columns of the geometric Jacobian at its start.
    pub columns: &'a [[f64; ROWS]],
    pub from: &'a [f64],
    pub to: &'a [f64],
    /// Bounds of `to`.
    pub ends: [&'a [f64]; 2],
}

impl JointWeights {
    /// Largest weight with which ticks of the `motion`, made by these weights, might not overshoot; `None` if they do not.
    pub(crate) fn without_overshoot(&self, motion: &TickMotion<'_>) -> Option<f64> {
        let curvature = self.curvature(motion);
        if has_eigenvalue_above(LARGEST, &curvature, motion.to.len()) {
            let [least, most] = LOWERED;
            let size: f64 = curvature.iter().map(|entry| entry * entry).sum();
            let factor = (LARGEST / size.sqrt()).sqrt().max(least).min(most);
            return Some(factor * self.as_slice().iter().copied().fold(1.0, f64::max));
        }
        None
    }

    /// The matrix H. Joint j turns the lever of each joint k after it, and half its rotation.
    fn curvature(&self, motion: &TickMotion<'_>) -> Matrix {
        let (weights, n) = (self.as_slice(), motion.to.len());
        let [force, torque] = halves(&self.multipliers(motion));
        let mut curvature = Matrix::from_elem(0.0, n * n);
        for (j, k) in (0..n).flat_map(|j| (j..n).map(move |k| (j, k))) {
            let (axis, [lever, turned]) = (halves(&motion.columns[j])[1], halves(&motion.columns[k]));
            let second = dot(&force, &cross(&axis, &lever)) + 0.5 * dot(&torque, &cross(&axis, &turned));
            curvature[j * n + k] = second / (weights[j] * weights[k]);
            curvature[k * n + j] = curvature[j * n + k];
        }
        curvature
    }

    /// The multipliers f, from the motion of the joints that are not at a bound.
    fn multipliers(&self, motion: &TickMotion<'_>) -> [f64; ROWS] {
        let [lower, upper] = motion.ends;
        let (mut columns, mut right) = (SmallVec::<[[f64; ROWS]; STACK_DOF]>::new(), [0.0; ROWS]);
        for (j, weight) in self.as_slice().iter().enumerate() {
            if lower[j] < motion.to[j] && motion.to[j] < upper[j] {
                let column = motion.columns[j].map(|entry| entry / weight);
                let y = weight * (motion.to[j] - motion.from[j]);
                right.iter_mut().zip(&column).for_each(|(sum, entry)| *sum -= entry * y);
                columns.push(column);
            }
        }
        let lambda = DAMPING * squared_size(&columns);
        ldl::solve::<NoFma, ROWS>(gram::<NoFma, ROWS>(columns.into_iter(), lambda), right)
    }
}

/// Whether the symmetric matrix H (n, n) has an eigenvalue above `bound`: bound I - H has a negative pivot then.
fn has_eigenvalue_above(bound: f64, matrix: &[f64], n: usize) -> bool {
    let mut rest = Matrix::from_iter(matrix.iter().map(|entry| -entry));
    (0..n).for_each(|j| rest[j * n + j] += bound);
    for j in 0..n {
        let pivot = rest[j * n + j];
        if pivot < 0.0 {
            return true;
        }
        for i in j + 1..n {
            let factor = if pivot == 0.0 { 0.0 } else { rest[i * n + j] / pivot };
            for k in j + 1..n {
                rest[i * n + k] -= factor * rest[j * n + k];
            }
        }
    }
    false
}

/// Position rows and rotation rows.
fn halves([x, y, z, a, b, c]: &[f64; ROWS]) -> [[f64; 3]; 2] {
    [[*x, *y, *z], [*a, *b, *c]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn eigenvalues_above_a_bound_are_found(bound in 0.1..2.0_f64, entries in prop::collection::vec(-1.0..1.0, 25)) {
            let matrix = DMatrix::from_vec(5, 5, entries);
            let matrix = &matrix + matrix.transpose();
            let largest: f64 = matrix.clone().symmetric_eigen().eigenvalues.max();
            prop_assume!((largest - bound).abs() > 1e-9);
            prop_assert_eq!(has_eigenvalue_above(bound, matrix.as_slice(), 5), largest > bound);
        }
    }
}
