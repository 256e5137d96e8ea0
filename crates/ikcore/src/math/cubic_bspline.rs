//! Cubic B-splines on pieces of equal length over \[0, 1\], with fourfold knots at both ends: the first and the last
//! coefficient are the values there.

/// Number of basis functions that differ from zero on a piece: coefficients `piece` to `piece + 3` belong to them.
pub const BASIS: usize = 4;

/// Cubic B-spline basis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CubicBasis {
    /// Number of pieces, at least one.
    pub pieces: usize,
}

impl CubicBasis {
    /// Number of coefficients of a spline.
    pub fn coefficients(self) -> usize {
        self.pieces + 3
    }

    /// Knot `i`: four zeros, the ends of the pieces, four ones.
    fn knot(self, i: usize) -> f64 {
        i.saturating_sub(3).min(self.pieces) as f64 / self.pieces as f64
    }

    /// The piece that contains `u`.
    pub fn piece_of(self, u: f64) -> usize {
        ((u * self.pieces as f64) as usize).min(self.pieces - 1)
    }

    /// Values of the four basis functions of `piece` at `u`, by the recursion of Cox and de Boor.
    pub fn values(self, piece: usize, u: f64) -> [f64; BASIS] {
        self.of_degree(3, piece, u)
    }

    /// Values of the `degree + 1` basis functions of `degree`; the others are zero.
    fn of_degree(self, degree: usize, piece: usize, u: f64) -> [f64; BASIS] {
        let mut values = [0.0; BASIS];
        values[0] = 1.0;
        for d in 1..=degree {
            let mut carried = 0.0;
            for r in 0..d {
                let (right, left) = (self.knot(piece + 3 + r + 1), self.knot(piece + 3 + r + 1 - d));
                let portion = values[r] / (right - left);
                values[r] = carried + (right - u) * portion;
                carried = (u - left) * portion;
            }
            values[d] = carried;
        }
        values
    }

    /// Second derivatives at both ends of `piece`, of the spline with these four coefficients there. They are linear between.
    pub fn bends(self, piece: usize, coefficients: [f64; BASIS]) -> [f64; 2] {
        self.second(piece, self.first(piece, coefficients))
    }

    /// Coefficients of the first derivative, a spline of degree two.
    fn first(self, piece: usize, c: [f64; BASIS]) -> [f64; 3] {
        [0, 1, 2].map(|i| 3.0 * (c[i + 1] - c[i]) / (self.knot(piece + i + 4) - self.knot(piece + i + 1)))
    }

    /// Coefficients of the second derivative, a spline of degree one: its values at the ends of the piece.
    fn second(self, piece: usize, first: [f64; 3]) -> [f64; 2] {
        [0, 1].map(|i| 2.0 * (first[i + 1] - first[i]) / (self.knot(piece + i + 4) - self.knot(piece + i + 2)))
    }

    /// Coefficients of the powers of the distance from the start of `piece`, of the spline with these four coefficients.
    pub fn powers(self, piece: usize, coefficients: [f64; BASIS]) -> [f64; 4] {
        let begin = self.knot(piece + 3);
        let sum = |values: [f64; BASIS], of: &[f64]| values.iter().zip(of).map(|(value, of)| value * of).sum::<f64>();
        let first = self.first(piece, coefficients);
        let [bend, next] = self.second(piece, first);
        let length = self.knot(piece + 4) - begin;
        [
            sum(self.values(piece, begin), &coefficients),
            sum(self.of_degree(2, piece, begin), &first),
            0.5 * bend,
            (next - bend) / (6.0 * length),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn basis_functions_sum_to_one_and_are_not_negative() {
        for pieces in [1, 2, 3, 7] {
            let basis = CubicBasis { pieces };
            for i in 0..=20 {
                let u = f64::from(i) / 20.0;
                let values = basis.values(basis.piece_of(u), u);
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{pieces} {u}");
                assert!(values.iter().all(|value| *value >= -1e-15), "{pieces} {u}");
            }
        }
    }

    #[test]
    fn powers_are_the_spline_and_join_in_their_second_derivatives() {
        let basis = CubicBasis { pieces: 5 };
        let c: Vec<f64> = (0..basis.coefficients()).map(|i| (1.7 * i as f64).sin()).collect();
        let local = |piece: usize| [c[piece], c[piece + 1], c[piece + 2], c[piece + 3]];
        for piece in 0..5 {
            let [c0, c1, c2, c3] = basis.powers(piece, local(piece));
            for s in [0.0, 0.05, 0.13, 0.2] {
                let values = basis.values(piece, 0.2 * piece as f64 + s);
                let expected: f64 = values.iter().zip(local(piece)).map(|(value, c)| value * c).sum();
                assert!((c0 + s * (c1 + s * (c2 + s * c3)) - expected).abs() < 1e-14);
            }
            assert!((basis.bends(piece, local(piece))[1] - (2.0 * c2 + 6.0 * c3 * 0.2)).abs() < 1e-11);
            if piece < 4 {
                assert_eq!(basis.bends(piece, local(piece))[1], basis.bends(piece + 1, local(piece + 1))[0]);
                let slope = c1 + 0.2 * (2.0 * c2 + 0.2 * 3.0 * c3);
                assert!((basis.powers(piece + 1, local(piece + 1))[1] - slope).abs() < 1e-12);
            }
        }
        assert_eq!(basis.powers(0, local(0))[0], c[0]);
    }
}
