//! Null space of the task's Jacobian: joint motions that leave the tip in place.

use nalgebra::DMatrix;

/// Largest singular value that counts as zero, relative to the largest one.
const NULL: f64 = 1e-6;

/// Returns an orthonormal basis of the Jacobian's null space.
pub(super) fn null_space(jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let gram = jacobian.transpose() * jacobian;
    let eigen = gram.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let null: Vec<usize> =
        (0..eigen.eigenvalues.len()).filter(|i| eigen.eigenvalues[*i] <= NULL * NULL * largest.max(1e-300)).collect();
    eigen.eigenvectors.select_columns(&null)
}

/// Returns a basis of the space of `null` that is aligned with `before`, with `count` columns: if a singularity adds a
/// direction, it is left out.
pub(super) fn turned(null: &DMatrix<f64>, before: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let shadow = null * (null.transpose() * before);
    let mut basis = DMatrix::zeros(before.nrows(), count);
    for k in 0..count {
        let mut column = shadow.column(k).into_owned();
        for other in 0..k {
            let along: f64 = basis.column(other).dot(&column);
            column -= basis.column(other) * along;
        }
        let length = column.norm();
        // A direction without a projection is kept unchanged: the projection of the configuration brings it back onto
        // the path.
        let kept = if length > NULL { column / length } else { before.column(k).into_owned() };
        basis.set_column(k, &kept);
    }
    basis
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;

    #[test]
    fn the_null_space_is_orthonormal_and_moves_nothing() {
        let mut rng = rng::stream(1, 0);
        for rank in 1..=6 {
            let mut random =
                |rows: usize, columns: usize| DMatrix::from_fn(rows, columns, |_, _| rng.uniform_in(-1.0, 1.0));
            let jacobian = random(6, rank) * random(rank, 7);
            let null = null_space(&jacobian);
            assert_eq!(null.ncols(), 7 - rank);
            assert!((&jacobian * &null).amax() < 1e-9);
            assert!((null.transpose() * &null - DMatrix::identity(7 - rank, 7 - rank)).amax() < 1e-12);
        }
    }

    #[test]
    fn a_turned_basis_spans_the_same_space_near_the_one_before() {
        let jacobian = DMatrix::from_fn(3, 5, |row, column| ((row + 2) * (column + 1)) as f64 % 3.7);
        let null = null_space(&jacobian);
        let swapped = DMatrix::from_columns(&[-null.column(1), null.column(0).into_owned()]);
        let basis = turned(&null, &swapped, 2);
        assert!((basis - swapped).amax() < 1e-9);
    }
}
