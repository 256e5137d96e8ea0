//! LDL' factorization of small symmetric systems.

use super::arithmetic::Arithmetic;

/// Pivot below which a direction counts as singular, relative to the trace: the solution has no step along it.
const SINGULAR: f64 = 1e-15;

/// Factorization A = L D L' of a symmetric positive semi-definite matrix.
#[derive(Debug, Clone, Copy)]
pub struct Ldl<const N: usize> {
    /// Product L D in the lower triangle, with the pivots D on the diagonal.
    scaled: [[f64; N]; N],
    /// Inverse pivots; zero for singular directions.
    inverse_pivots: [f64; N],
}

impl<const N: usize> Ldl<N> {
    /// Factors the matrix, of which only the lower triangle is read.
    #[inline(always)]
    pub fn of<A: Arithmetic>(matrix: [[f64; N]; N]) -> Self {
        Self::eliminated::<A, 0>(matrix, []).0
    }

    /// Factors the matrix and applies the same elimination to the right-hand sides.
    #[inline(always)]
    fn eliminated<A: Arithmetic, const M: usize>(
        mut scaled: [[f64; N]; N],
        mut right: [[f64; N]; M],
    ) -> (Self, [[f64; N]; M]) {
        let smallest = SINGULAR * trace(&scaled);
        let mut inverse_pivots = [0.0; N];
        for j in 0..N {
            inverse_pivots[j] = if smallest < scaled[j][j] { 1.0 / scaled[j][j] } else { 0.0 };
            for i in j + 1..N {
                let factor = scaled[i][j] * inverse_pivots[j];
                for k in j + 1..=i {
                    scaled[i][k] = A::mul_add(-factor, scaled[k][j], scaled[i][k]);
                }
                for b in &mut right {
                    b[i] = A::mul_add(-factor, b[j], b[i]);
                }
            }
        }
        (Self { scaled, inverse_pivots }, right)
    }

    /// Solves A z = b, without components of z along singular directions.
    #[inline(always)]
    pub fn solve<A: Arithmetic>(&self, mut b: [f64; N]) -> [f64; N] {
        for j in 0..N {
            for i in j + 1..N {
                let factor = self.scaled[i][j] * self.inverse_pivots[j];
                b[i] = A::mul_add(-factor, b[j], b[i]);
            }
        }
        self.substituted_back::<A>(b)
    }

    #[inline(always)]
    fn substituted_back<A: Arithmetic>(&self, mut z: [f64; N]) -> [f64; N] {
        for i in (0..N).rev() {
            for k in i + 1..N {
                z[i] = A::mul_add(-self.scaled[k][i], z[k], z[i]);
            }
            z[i] *= self.inverse_pivots[i];
        }
        z
    }

    /// Returns pivot `j`.
    #[inline(always)]
    pub fn pivot(&self, j: usize) -> f64 {
        self.scaled[j][j]
    }
}

/// Solves A z = b for one right-hand side. With [`Ldl::of`] first, a bounded step would take 3 % longer.
#[inline(always)]
pub fn solve<A: Arithmetic, const N: usize>(matrix: [[f64; N]; N], b: [f64; N]) -> [f64; N] {
    let (ldl, [b]) = Ldl::eliminated::<A, 1>(matrix, [b]);
    ldl.substituted_back::<A>(b)
}

/// Returns the sum of the diagonal.
#[inline(always)]
pub fn trace<const N: usize>(matrix: &[[f64; N]; N]) -> f64 {
    (1..N).fold(matrix[0][0], |sum, i| sum + matrix[i][i])
}
