//! Cholesky factorization A = L L' of small symmetric matrices, stored by rows.

/// Replaces the lower triangle of a matrix with rows of length `n` by its factor L; squared pivots are at least `least_pivot`.
pub fn factorize(matrix: &mut [f64], n: usize, least_pivot: f64) {
    for i in 0..n {
        for j in 0..=i {
            let mut entry = matrix[i * n + j];
            for k in 0..j {
                entry -= matrix[i * n + k] * matrix[j * n + k];
            }
            matrix[i * n + j] = if i == j { entry.max(least_pivot).sqrt() } else { entry / matrix[j * n + j] };
        }
    }
}

/// Solves L L' x = b in place.
pub fn solve(factor: &[f64], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        let known: f64 = (0..i).map(|k| factor[i * n + k] * x[k]).sum();
        x[i] = (x[i] - known) / factor[i * n + i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| factor[k * n + i] * x[k]).sum();
        x[i] = (x[i] - known) / factor[i * n + i];
    }
}
