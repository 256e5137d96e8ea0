//! Small symmetric systems by LDL'.

use super::real::Real;

/// Pivots below this share of the matrix's trace count as zero: no step in that direction.
const SINGULAR: f64 = 1e-15;

/// Solves A z = b by LDL', A symmetric positive semi-definite in its lower triangle.
#[inline(always)]
pub fn solve<R: Real, const N: usize>(mut l: [[R; N]; N], b: [R; N]) -> [R; N] {
    let zero = R::splat(0.0);
    let trace = (1..N).fold(l[0][0], |sum, i| sum + l[i][i]);
    let smallest = R::splat(SINGULAR) * trace;
    let mut inverse_pivot = [zero; N];
    let mut z = b;
    // Column by column: what a pivot settles is taken off everything behind it, the right-hand side included.
    for j in 0..N {
        inverse_pivot[j] = smallest.choose_below(l[j][j], R::splat(1.0) / l[j][j], zero);
        for i in j + 1..N {
            let factor = l[i][j] * inverse_pivot[j];
            for k in j + 1..=i {
                l[i][k] = (-factor).mul_add(l[k][j], l[i][k]);
            }
            z[i] = (-factor).mul_add(z[j], z[i]);
        }
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            z[i] = (-l[k][i]).mul_add(z[k], z[i]);
        }
        z[i] = z[i] * inverse_pivot[i];
    }
    z
}
