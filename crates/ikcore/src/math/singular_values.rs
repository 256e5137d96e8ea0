//! Singular values of a matrix with at most six rows, without allocation: one-sided Jacobi rotations (Hestenes 1958) make its
//! rows orthogonal. Small values keep their relative accuracy, which squaring the matrix would lose.

use super::MAX_DOF;
use super::box_step::ROWS;
use super::vector::dot;

/// Cosine below which two rows count as orthogonal.
const ORTHOGONAL: f64 = 4.0 * f64::EPSILON;

/// Length below which a row counts as rounding, relative to the longest row.
const NOTHING: f64 = 1e-14;

/// Maximum number of sweeps. Convergence is quadratic; six sweeps are typical.
const SWEEPS: usize = 30;

/// Decomposition J = sum of length\[i\] left\[i\] right\[i\]', largest first.
#[derive(Debug, Clone)]
pub struct SingularValues {
    /// Singular values; zero beyond the rank.
    pub lengths: [f64; ROWS],
    /// Left singular vectors, one entry per row of the matrix, mutually orthogonal.
    pub left: [[f64; ROWS]; ROWS],
    /// Right singular vectors, one entry per column of the matrix; zero for zero singular values.
    pub right: [[f64; MAX_DOF]; ROWS],
}

impl SingularValues {
    /// Decomposes the matrix with these columns, at most [`MAX_DOF`].
    pub fn of(columns: &[[f64; ROWS]]) -> Self {
        let n = columns.len();
        let mut left = [[0.0; ROWS]; ROWS];
        let mut rows = [[0.0; MAX_DOF]; ROWS];
        for i in 0..ROWS {
            left[i][i] = 1.0;
            for (entry, column) in rows[i].iter_mut().zip(columns) {
                *entry = column[i];
            }
        }
        for _ in 0..SWEEPS {
            let mut turned = false;
            for p in 0..ROWS {
                for q in p + 1..ROWS {
                    turned |= turn_apart(&mut rows, &mut left, p, q, n);
                }
            }
            if !turned {
                break;
            }
        }
        Self::sorted(rows, left, n)
    }

    fn sorted(mut right: [[f64; MAX_DOF]; ROWS], mut left: [[f64; ROWS]; ROWS], n: usize) -> Self {
        let mut lengths: [f64; ROWS] = std::array::from_fn(|i| dot(&right[i][..n], &right[i][..n]).sqrt());
        for i in 0..ROWS {
            let longest = (i..ROWS).fold(i, |best, k| if lengths[k] > lengths[best] { k } else { best });
            lengths.swap(i, longest);
            left.swap(i, longest);
            right.swap(i, longest);
            if lengths[i] <= NOTHING * lengths[0] {
                lengths[i] = 0.0;
                right[i][..n].fill(0.0);
            } else {
                right[i][..n].iter_mut().for_each(|entry| *entry /= lengths[i]);
            }
        }
        Self { lengths, left, right }
    }
}

/// Rotates rows `p` and `q` in their plane until they are orthogonal. Returns false if they already were.
fn turn_apart(rows: &mut [[f64; MAX_DOF]; ROWS], left: &mut [[f64; ROWS]; ROWS], p: usize, q: usize, n: usize) -> bool {
    let (squared_p, squared_q) = (dot(&rows[p][..n], &rows[p][..n]), dot(&rows[q][..n], &rows[q][..n]));
    let product = dot(&rows[p][..n], &rows[q][..n]);
    let (shorter, longer) = (squared_p.min(squared_q), squared_p.max(squared_q));
    if shorter <= NOTHING * NOTHING * longer || product.abs() <= ORTHOGONAL * (shorter * longer).sqrt() {
        return false;
    }
    // Smaller root of t^2 + 2 zeta t - 1 = 0: the rotation by less than 45 degrees.
    let zeta = (squared_q - squared_p) / (2.0 * product);
    let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = cosine * tangent;
    turn(rows, p, q, n, sine, cosine);
    turn(left, p, q, ROWS, sine, cosine);
    true
}

fn turn<const L: usize>(rows: &mut [[f64; L]; ROWS], p: usize, q: usize, n: usize, sine: f64, cosine: f64) {
    for k in 0..n {
        let (a, b) = (rows[p][k], rows[q][k]);
        rows[p][k] = cosine * a - sine * b;
        rows[q][k] = sine * a + cosine * b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn they_rebuild_the_matrix_and_agree_with_nalgebra(
            columns in prop::collection::vec(prop::array::uniform6(-1.0..1.0), 1..10),
            scale in prop::array::uniform6(prop::sample::select(vec![1.0, 1e-3, 1e-7, 0.0])),
        ) {
            let columns: Vec<[f64; 6]> = columns.iter().map(|c| std::array::from_fn(|i| c[i] * scale[i])).collect();
            let n = columns.len();
            let matrix = DMatrix::from_fn(6, n, |i, k| columns[k][i]);
            let found = SingularValues::of(&columns);
            let mut rebuilt = DMatrix::zeros(6, n);
            for i in 0..6 {
                let left = DVector::from_row_slice(&found.left[i]);
                rebuilt += found.lengths[i] * &left * DVector::from_row_slice(&found.right[i][..n]).transpose();
                prop_assert!((left.norm() - 1.0).abs() < 1e-13);
            }
            prop_assert!((&rebuilt - &matrix).norm() <= 1e-13, "{rebuilt} {matrix}");
            for (found, expected) in found.lengths.iter().zip(matrix.singular_values().iter()) {
                prop_assert!((found - expected).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_value_ten_decades_below_the_largest_keeps_its_digits() {
        let tiny = 3.25e-10;
        // Matrix with a second singular value equal to `tiny`.
        let columns = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, tiny, 0.0, 0.0, 0.0, 0.0]];
        let found = SingularValues::of(&columns);
        assert_eq!(found.lengths[..3], [1.0, tiny, 0.0]);
    }
}
