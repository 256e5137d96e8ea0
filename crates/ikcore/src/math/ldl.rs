//! Small symmetric systems by LDL'.

use super::real::Real;

/// Pivots below this fraction of the matrix's trace count as zero: no step in that direction.
const SINGULAR: f64 = 1e-15;

/// A = L D L' of a symmetric positive semi-definite matrix.
#[derive(Debug, Clone, Copy)]
pub struct Ldl<R, const N: usize> {
    /// L D in the lower triangle; the pivots D on the diagonal.
    scaled: [[R; N]; N],
    /// 1 / D; zero for pivots that count as zero.
    inverse_pivots: [R; N],
}

impl<R: Real, const N: usize> Ldl<R, N> {
    /// Factors the matrix with this lower triangle.
    #[inline(always)]
    pub fn of(matrix: [[R; N]; N]) -> Self {
        Self::eliminated(matrix, []).0
    }

    /// Factors the matrix and applies the same elimination to the right-hand sides.
    #[inline(always)]
    fn eliminated<const M: usize>(mut scaled: [[R; N]; N], mut right: [[R; N]; M]) -> (Self, [[R; N]; M]) {
        let zero = R::splat(0.0);
        let smallest = R::splat(SINGULAR) * trace(&scaled);
        let mut inverse_pivots = [zero; N];
        for j in 0..N {
            inverse_pivots[j] = smallest.choose_below(scaled[j][j], R::splat(1.0) / scaled[j][j], zero);
            for i in j + 1..N {
                let factor = scaled[i][j] * inverse_pivots[j];
                for k in j + 1..=i {
                    scaled[i][k] = (-factor).mul_add(scaled[k][j], scaled[i][k]);
                }
                for b in &mut right {
                    b[i] = (-factor).mul_add(b[j], b[i]);
                }
            }
        }
        (Self { scaled, inverse_pivots }, right)
    }

    /// Solves A z = b, without components of z along directions whose pivots count as zero.
    #[inline(always)]
    pub fn solve(&self, mut b: [R; N]) -> [R; N] {
        for j in 0..N {
            for i in j + 1..N {
                let factor = self.scaled[i][j] * self.inverse_pivots[j];
                b[i] = (-factor).mul_add(b[j], b[i]);
            }
        }
        self.substituted_back(b)
    }

    #[inline(always)]
    fn substituted_back(&self, mut z: [R; N]) -> [R; N] {
        for i in (0..N).rev() {
            for k in i + 1..N {
                z[i] = (-self.scaled[k][i]).mul_add(z[k], z[i]);
            }
            z[i] = z[i] * self.inverse_pivots[i];
        }
        z
    }

    /// Pivot `j`.
    #[inline(always)]
    pub fn pivot(&self, j: usize) -> R {
        self.scaled[j][j]
    }
}

/// Solves A z = b for one right-hand side. With [`Ldl::of`] first, a bounded step would take 3 % longer.
#[inline(always)]
pub fn solve<R: Real, const N: usize>(matrix: [[R; N]; N], b: [R; N]) -> [R; N] {
    let (ldl, [b]) = Ldl::eliminated(matrix, [b]);
    ldl.substituted_back(b)
}

/// The sum of the diagonal.
#[inline(always)]
pub fn trace<R: Real, const N: usize>(matrix: &[[R; N]; N]) -> R {
    (1..N).fold(matrix[0][0], |sum, i| sum + matrix[i][i])
}
