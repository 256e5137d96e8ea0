//! Symmetric positive definite systems with a few diagonals, as cubic splines have.

/// Number of diagonals beside the main one, on each side.
pub const SIDE_DIAGONALS: usize = 3;

/// Lower triangle of a symmetric matrix: row `j` holds the entries (j, j), (j + 1, j), (j + 2, j) and (j + 3, j).
pub type Band = Vec<[f64; SIDE_DIAGONALS + 1]>;

/// Solves A x = b by LDL' factorization; `band` and `b` are overwritten, `b` by the solution.
pub fn solve(band: &mut Band, b: &mut [f64]) {
    let n = b.len();
    for j in 0..n {
        let column = band[j];
        for below in 1..=SIDE_DIAGONALS.min(n - 1 - j) {
            let factor = column[below] / column[0];
            for further in below..=SIDE_DIAGONALS.min(n - 1 - j) {
                band[j + below][further - below] -= factor * column[further];
            }
            b[j + below] -= factor * b[j];
            band[j][below] = factor;
        }
    }
    for j in (0..n).rev() {
        b[j] /= band[j][0];
        for below in 1..=SIDE_DIAGONALS.min(n - 1 - j) {
            b[j] -= band[j][below] * b[j + below];
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    #[test]
    fn solves_as_a_dense_factorization_does() {
        for n in [1, 2, 3, 4, 9] {
            let entry = |i: usize, j: usize| match i.abs_diff(j) {
                0 => 5.0 + i as f64,
                d @ 1..=SIDE_DIAGONALS => 1.0 / (d as f64 + i.min(j) as f64),
                _ => 0.0,
            };
            let dense = DMatrix::from_fn(n, n, entry);
            let right = DVector::from_fn(n, |i, _| (i as f64).cos());
            let column = |j: usize| [0, 1, 2, 3].map(|below| if j + below < n { entry(j + below, j) } else { 0.0 });
            let mut band: Band = (0..n).map(column).collect();
            let mut solution = right.as_slice().to_vec();
            solve(&mut band, &mut solution);
            let expected = dense.cholesky().unwrap().solve(&right);
            assert!((DVector::from_vec(solution) - expected).amax() < 1e-14, "{n}");
        }
    }
}
