//! Damped Gram matrix of a Jacobian.

use super::arithmetic::Arithmetic;
use super::f64x4::F64x4;

/// Returns J J' + lambda I on the first `R` rows of a Jacobian with these columns.
#[inline(always)]
pub fn gram<A: Arithmetic, const R: usize>(columns: impl Iterator<Item = [f64; 6]>, lambda: f64) -> [[f64; R]; R] {
    // Four entries of a row, then the rest; with three rows the rest is unused and not computed.
    let mut sum = [[F64x4::ZERO; 2]; R];
    for column in columns {
        let [c0, c1, c2, c3, c4, c5] = column;
        let halves = [F64x4([c0, c1, c2, c3]), F64x4([c4, c5, 0.0, 0.0])];
        for i in 0..R {
            for (sum, half) in sum[i].iter_mut().zip(halves) {
                *sum = A::mul_add_x4(F64x4::splat(column[i]), half, *sum);
            }
        }
    }
    // Loops instead of closures, which might be compiled without the instructions of the calling kernel.
    let mut entries = [[0.0; R]; R];
    for (i, row) in entries.iter_mut().enumerate() {
        for (k, entry) in row.iter_mut().enumerate() {
            *entry = sum[i][k / 4].0[k % 4] + if i == k { lambda } else { 0.0 };
        }
    }
    entries
}
