//! The largest eigenvalue of J'J, without an iteration that may not have converged.

use super::box_step::ROWS;

/// The trace is taken of G to the power 2^DOUBLINGS: the bound is too high by 6^(1/16), or 12 %, at most, and mostly by
/// far less.
const DOUBLINGS: usize = 4;

/// An upper bound on the largest eigenvalue of J'J, J given by its columns.
///
/// J'J shares its eigenvalues with G = J J', and the sixteenth power of the largest is at most the trace of G^16.
pub fn largest_eigenvalue(columns: &[[f64; ROWS]]) -> f64 {
    let mut g = [[0.0; ROWS]; ROWS];
    for column in columns {
        for (row, entry) in g.iter_mut().zip(column) {
            row.iter_mut().zip(column).for_each(|(sum, other)| *sum += entry * other);
        }
    }
    let scale: f64 = (0..ROWS).map(|i| g[i][i]).sum();
    if !(scale > 0.0) {
        return 0.0;
    }
    g.as_flattened_mut().iter_mut().for_each(|entry| *entry /= scale);
    for _ in 1..DOUBLINGS {
        g = squared(&g);
    }
    // The trace of a squared symmetric matrix is the sum of its squared entries.
    let trace: f64 = g.as_flattened().iter().map(|entry| entry * entry).sum();
    scale * (0..DOUBLINGS).fold(trace, |power, _| power.sqrt())
}

fn squared(g: &[[f64; ROWS]; ROWS]) -> [[f64; ROWS]; ROWS] {
    let mut product = [[0.0; ROWS]; ROWS];
    for (row, out) in g.iter().zip(&mut product) {
        for (factor, other) in row.iter().zip(g) {
            out.iter_mut().zip(other).for_each(|(sum, entry)| *sum += factor * entry);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_a_close_upper_bound(columns in prop::collection::vec(prop::array::uniform6(-2.0..2.0), 1..10)) {
            let j = DMatrix::from_fn(6, columns.len(), |i, k| columns[k][i]);
            let exact = (&j * j.transpose()).symmetric_eigenvalues().max();
            let bound = largest_eigenvalue(&columns);
            prop_assert!(bound >= exact * (1.0 - 1e-12) && bound <= 1.12 * exact, "{} {}", bound, exact);
        }
    }

    #[test]
    fn nothing_moves_nothing() {
        assert_eq!(largest_eigenvalue(&[[0.0; 6]; 3]), 0.0);
        assert_eq!(largest_eigenvalue(&[]), 0.0);
    }
}
