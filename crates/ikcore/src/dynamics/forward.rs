//! Forward dynamics: the accelerations that torques cause, from the mass matrix and its Cholesky factor.

use super::inverse::DynamicState;
use super::rigid_bodies::Dynamics;
use super::scratch::DynamicsScratch;

/// Square of a pivot, relative to the entry of the mass matrix, below which its joint cannot be told from the others.
const SINGULAR: f64 = 1e-13;
/// Entry of the mass matrix, relative to the largest, that is rounding.
const ROUNDING: f64 = 1e-16;

impl Dynamics {
    /// Replaces the joint torques in `torques` by the accelerations that they cause at `q` and `qd` (rad/s^2, m/s^2), with the
    /// frames of all stages in `scratch`: the inverse of [`inverse`](Self::inverse), friction included.
    ///
    /// # Errors
    /// The joint whose motion others can cancel, where the mass matrix is singular.
    pub fn forward(
        &self,
        [q, qd]: [&[f64]; 2],
        scratch: &mut DynamicsScratch,
        torques: &mut [f64],
    ) -> Result<(), usize> {
        let n = torques.len();
        let (mut matrix, mut bias) = (std::mem::take(&mut scratch.matrix), std::mem::take(&mut scratch.bias));
        matrix.resize(n * n, 0.0);
        bias.resize(2 * n, 0.0);
        let (rest, bias_now) = bias.split_at_mut(n);
        rest.fill(0.0);
        self.inverse(&DynamicState { q, qd, qdd: rest }, &[], scratch, bias_now);
        self.mass_matrix(scratch, &mut matrix);
        for (torque, bias) in torques.iter_mut().zip(&*bias_now) {
            *torque -= bias;
        }
        let solved = solve(&mut matrix, torques);
        (scratch.matrix, scratch.bias) = (matrix, bias);
        solved
    }
}

/// Solves A x = b in place for a symmetric positive definite matrix, which becomes its Cholesky factor.
fn solve(matrix: &mut [f64], b: &mut [f64]) -> Result<(), usize> {
    let n = b.len();
    let rounding = ROUNDING * (0..n).fold(0.0, |largest, j| matrix[j * n + j].max(largest));
    for j in 0..n {
        let (above, from_j) = matrix.split_at_mut(j * n);
        let entry = from_j[j];
        for k in 0..j {
            let sum: f64 = (0..k).map(|i| from_j[i] * above[k * n + i]).sum();
            from_j[k] = (from_j[k] - sum) / above[k * n + k];
        }
        let pivot = entry - from_j[..j].iter().map(|x| x * x).sum::<f64>();
        if !(pivot > SINGULAR * entry + rounding) {
            return Err(j);
        }
        from_j[j] = pivot.sqrt();
        b[j] = (b[j] - from_j[..j].iter().zip(&b[..j]).map(|(x, y)| x * y).sum::<f64>()) / from_j[j];
    }
    for j in (0..n).rev() {
        let sum: f64 = (j + 1..n).map(|i| matrix[i * n + j] * b[i]).sum();
        b[j] = (b[j] - sum) / matrix[j * n + j];
    }
    Ok(())
}
