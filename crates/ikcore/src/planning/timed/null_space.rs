//! What moves the joints and leaves the tip where it is.

use nalgebra::DMatrix;

/// Singular values below this share of the largest count as zero: a joint motion that leaves the tip where it is.
const NULL: f64 = 1e-6;

/// An orthonormal basis of what the Jacobian maps to zero.
pub fn null_space(jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let gram = jacobian.transpose() * jacobian;
    let eigen = gram.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let null: Vec<usize> =
        (0..eigen.eigenvalues.len()).filter(|i| eigen.eigenvalues[*i] <= NULL * NULL * largest.max(1e-300)).collect();
    eigen.eigenvectors.select_columns(&null)
}

/// A basis of the space of `null` near `before`, with `count` columns: where a singularity adds a direction, it is left
/// out.
pub fn turned(null: &DMatrix<f64>, before: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let shadow = null * (null.transpose() * before);
    let mut basis = DMatrix::zeros(before.nrows(), count);
    for k in 0..count {
        let mut column = shadow.column(k).into_owned();
        for other in 0..k {
            let along: f64 = basis.column(other).dot(&column);
            column -= basis.column(other) * along;
        }
        let length = column.norm();
        // A direction that has no shadow is kept as it was: the projection brings it back onto the path.
        let kept = if length > NULL { column / length } else { before.column(k).into_owned() };
        basis.set_column(k, &kept);
    }
    basis
}
