//! Bounded step: damped least squares on six rows within a box. Joints that reach a bound are fixed there, and the step is
//! solved again.

use super::arithmetic::{Arithmetic, by_instructions};
use super::comparison::{larger, smaller};
use super::gram::gram;
use super::ldl;
use super::vector::squared_size;

/// Number of task rows of every least-squares problem; unused rows are zero.
pub const ROWS: usize = 6;

/// Number of position rows, which come first.
pub(super) const POSITION_ROWS: usize = 3;

/// Damping, relative to the squared size of the Jacobian, that keeps a singular system solvable and has no other effect.
pub const LEAST_DAMPING: f64 = 1e-10;

/// Number of rounds in which joints may reach their bounds; after that the step is clipped to the box.
pub(super) const ROUNDS: usize = 4;

/// Damped least-squares step in a box: moves to the point x + dx in \[`lower`, `upper`\] that (approximately) minimises
/// |residual + J dx|^2 + lambda |dx|^2.
///
/// dx = -J' (J J' + lambda I)^-1 residual over the free joints. A joint that would leave the box is fixed at its bound, its
/// contribution is subtracted from the residual, and the step of the other joints is solved again.
#[derive(Debug, Clone, Copy)]
pub struct BoxStep<'a> {
    /// Columns of J, at least one per entry of `x`.
    pub columns: &'a [[f64; ROWS]],
    /// Residual to be removed by the step.
    pub residual: &'a [f64; ROWS],
    /// Damping factor.
    pub lambda: f64,
    /// Current point.
    pub x: &'a [f64],
    /// Lower bounds, one per entry of `x`.
    pub lower: &'a [f64],
    /// Upper bounds, one per entry of `x`.
    pub upper: &'a [f64],
}

/// Returns [`LEAST_DAMPING`] times the squared size of the Jacobian with these columns.
pub fn least_damping(columns: &[[f64; ROWS]]) -> f64 {
    LEAST_DAMPING * squared_size(columns)
}

impl BoxStep<'_> {
    /// Writes the point after the step into `out`.
    pub fn write(&self, out: &mut [f64]) {
        write_step(self, out);
    }

    /// Writes the point in the box that (approximately) solves residual + J (out - x) = 0 and is nearest to `preferred`,
    /// which must be in the box.
    pub fn write_near(&self, preferred: &[f64], out: &mut [f64]) {
        let mut there = *self.residual;
        for ((column, x), preferred) in self.columns.iter().zip(self.x).zip(preferred) {
            for (entry, slope) in there.iter_mut().zip(column) {
                *entry += slope * (preferred - x);
            }
        }
        BoxStep { residual: &there, x: preferred, ..*self }.write(out);
    }

    /// Solves only the position rows if the angular rows are zero: half the rows take less than half the time.
    #[inline(always)]
    fn write_rows_in_use<A: Arithmetic>(&self, out: &mut [f64]) {
        let moves_position_alone = |column: &[f64; ROWS]| column[POSITION_ROWS..] == [0.0; ROWS - POSITION_ROWS];
        if self.columns[..self.x.len()].iter().all(moves_position_alone) {
            self.write_first_rows::<A, POSITION_ROWS>(out);
        } else {
            self.write_first_rows::<A, ROWS>(out);
        }
    }

    /// Solves the first `R` rows.
    #[inline(always)]
    fn write_first_rows<A: Arithmetic, const R: usize>(&self, out: &mut [f64]) {
        let Self { columns, lambda, x, lower, upper, .. } = *self;
        let n = x.len();
        let mut remaining = *self.residual;
        // Bit j is set if joint j is fixed at a bound.
        let mut fixed = 0_u64;
        for _ in 0..ROUNDS {
            let mut right = [0.0; R];
            right.copy_from_slice(&remaining[..R]);
            let free = (0..n).filter(|j| fixed & (1 << j) == 0).map(|j| columns[j]);
            let z = ldl::solve::<A, R>(gram::<A, R>(free, lambda), right);
            let fixed_before = fixed;
            for j in (0..n).filter(|j| fixed_before & (1 << j) == 0) {
                let wanted = x[j] - dot::<A, R>(&columns[j], &z);
                let bounded = smaller(larger(wanted, lower[j]), upper[j]);
                out[j] = bounded;
                if bounded != wanted {
                    fixed |= 1 << j;
                    for (rest, column) in remaining.iter_mut().zip(&columns[j]) {
                        *rest = A::mul_add(*column, bounded - x[j], *rest);
                    }
                }
            }
            if fixed == fixed_before {
                return;
            }
        }
    }
}

by_instructions! {
    fn write_step(step: &BoxStep<'_>, out: &mut [f64]) {
        step.write_rows_in_use::<A>(out);
    }
}

/// Returns the dot product a'b, summed in pairs.
#[inline(always)]
fn dot<A: Arithmetic, const N: usize>(a: &[f64; ROWS], b: &[f64; N]) -> f64 {
    let pair = |k: usize| {
        if k + 1 < N { A::mul_add(a[k], b[k], a[k + 1] * b[k + 1]) } else { a[k] * b[k] }
    };
    (2..N).step_by(2).fold(pair(0), |sum, k| sum + pair(k))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    const FREE: f64 = f64::INFINITY;

    fn step_in<'a>(
        [lower, upper]: [&'a [f64]; 2],
        (columns, residual, lambda): (&'a [[f64; 6]], &'a [f64; 6], f64),
        x: &'a [f64],
    ) -> BoxStep<'a> {
        BoxStep { columns, residual, lambda, x, lower, upper }
    }

    fn damped_step(columns: &[[f64; 6]], residual: &[f64; 6], lambda: f64) -> DVector<f64> {
        let j = DMatrix::from_fn(6, columns.len(), |i, k| columns[k][i]);
        let normal = &j * j.transpose() + DMatrix::identity(6, 6) * lambda;
        -j.transpose() * normal.lu().solve(&DVector::from_row_slice(residual)).unwrap()
    }

    proptest! {
        #[test]
        fn without_bounds_it_is_the_damped_pseudo_inverse(
            columns in prop::collection::vec(prop::array::uniform6(-1.0..1.0), 1..10),
            residual in prop::array::uniform6(-1.0..1.0),
            lambda in 1e-3..1.0,
        ) {
            let n = columns.len();
            let mut out = vec![0.0; n];
            let (x, lower, upper) = (vec![0.0; n], vec![-FREE; n], vec![FREE; n]);
            step_in([&lower, &upper], (&columns, &residual, lambda), &x).write(&mut out);
            let expected = damped_step(&columns, &residual, lambda);
            prop_assert!((DVector::from_vec(out) - expected).norm() < 1e-10);
        }

        #[test]
        fn never_leaves_the_box(
            columns in prop::collection::vec(prop::array::uniform6(-1.0..1.0), 1..10),
            residual in prop::array::uniform6(-5.0..5.0),
            width in 0.0_f64..0.5,
        ) {
            let n = columns.len();
            let (lower, upper) = (vec![-width; n], vec![0.5 * width; n]);
            let mut out = vec![0.0; n];
            step_in([&lower, &upper], (&columns, &residual, 1e-6), &vec![0.0; n]).write(&mut out);
            prop_assert!(out.iter().zip(&lower).zip(&upper).all(|((x, l), u)| l <= x && x <= u));
        }
    }

    #[test]
    fn what_a_stuck_joint_cannot_do_the_others_take_over() {
        // Both joints push along x; the first may move by 0.1 only, so the second contributes the remaining 0.9.
        let columns = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]; 2];
        let residual = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut out = [0.0; 2];
        step_in([&[-0.1, -FREE], &[0.1, FREE]], (&columns, &residual, 1e-12), &[0.0; 2]).write(&mut out);
        assert!((out[0] - 0.1).abs() < 1e-15 && (out[1] - 0.9).abs() < 1e-9, "{out:?}");
    }

    #[test]
    fn what_the_task_leaves_free_goes_where_it_is_preferred() {
        // Target x + y = 1: of all such points the nearest to (0.8, 0.6) is (0.6, 0.4), and with x <= 0.4 it is (0.4, 0.6).
        let columns = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]; 2];
        let residual = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let near = |upper: f64| {
            let mut out = [0.0; 2];
            let preferred = [0.8_f64.min(upper), 0.6];
            step_in([&[-FREE; 2], &[upper, FREE]], (&columns, &residual, 1e-12), &[0.0; 2])
                .write_near(&preferred, &mut out);
            out
        };
        assert!(near(FREE).iter().zip([0.6, 0.4]).all(|(x, e)| (x - e).abs() < 1e-9), "{:?}", near(FREE));
        assert!(near(0.4).iter().zip([0.4, 0.6]).all(|(x, e)| (x - e).abs() < 1e-9), "{:?}", near(0.4));
    }

    #[test]
    fn a_direction_that_no_joint_moves_gets_no_step() {
        let mut out = [0.0];
        let column = [0.0, 2.0, 0.0, 0.0, 0.0, 0.0];
        step_in([&[-FREE], &[FREE]], (&[column], &[1.0; 6], 0.0), &[0.0]).write(&mut out);
        assert!((out[0] + 0.5).abs() < 1e-15, "{out:?}");
    }
}
