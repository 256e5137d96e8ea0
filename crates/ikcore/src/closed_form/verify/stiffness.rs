//! Stiffness of a configuration at its pose: the least change of the pose per unit of joint motion.

use crate::math::real::Real;

/// Returns the column of the Jacobian, in the axes of the tip, of a joint that moves along or about the z axis of a frame, in
/// which the tip's origin, x axis and z axis are given.
#[inline(always)]
pub fn column<R: Real>([p, x, z]: &[[R; 3]; 3], slides: bool) -> [R; 6] {
    let cross = |i: usize, j: usize| z[i] * x[j] - z[j] * x[i];
    let tip = [*x, [cross(1, 2), cross(2, 0), cross(0, 1)], *z];
    let along = tip.map(|axis| axis[2]);
    let [linear, angular] =
        if slides { [along, [R::splat(0.0); 3]] } else { [tip.map(|axis| p[0] * axis[1] - p[1] * axis[0]), along] };
    [linear[0], linear[1], linear[2], angular[0], angular[1], angular[2]]
}

/// Returns the sum of 1/s^2 over the singular values s of the Jacobian with these columns, not finite if one is zero: the
/// squared norm of its pseudoinverse, by Gram-Schmidt orthogonalization.
#[inline(always)]
pub fn compliance<R: Real, const N: usize>(columns: &[[R; 6]; N]) -> R {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let mut rest = *columns;
    // Shares of the earlier columns in each column: unit upper triangular, row by row.
    let mut shares = [[zero; N]; N];
    let mut inverse_squares = [zero; N];
    for k in 0..N {
        let first = rest[k];
        inverse_squares[k] = one / product(&first, &first);
        for j in k + 1..N {
            let share = product(&first, &rest[j]) * inverse_squares[k];
            rest[j] = std::array::from_fn(|i| (-share).mul_add(first[i], rest[j][i]));
            shares[k][j] = share;
        }
    }
    let mut sum = zero;
    for k in 0..N {
        // Column k of the inverse of the shares, from its diagonal upwards.
        let mut inverse = [zero; N];
        inverse[k] = one;
        let mut square = one;
        for i in (0..k).rev() {
            for l in i + 1..=k {
                inverse[i] = (-shares[i][l]).mul_add(inverse[l], inverse[i]);
            }
            square = inverse[i].mul_add(inverse[i], square);
        }
        sum = square.mul_add(inverse_squares[k], sum);
    }
    sum
}

/// Returns a lower bound on the smallest singular value, at least 1/sqrt(N) of it.
#[inline]
pub fn stiffness(compliance: f64) -> f64 {
    if compliance.is_finite() { 1.0 / compliance.sqrt() } else { 0.0 }
}

#[inline(always)]
fn product<R: Real>(a: &[R; 6], b: &[R; 6]) -> R {
    (0..6).fold(R::splat(0.0), |sum, i| a[i].mul_add(b[i], sum))
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix6;

    use super::*;
    use crate::math::arithmetic::Baseline;
    use crate::math::real::One;
    use crate::rng;

    fn stiffness_of(columns: &[[f64; 6]; 6]) -> f64 {
        stiffness(compliance(&columns.map(|column| column.map(One::<Baseline>::of))).stored())
    }

    #[test]
    fn stiffness_bounds_the_smallest_singular_value() {
        let mut rng = rng::stream(17, 0);
        for draw in 0..300 {
            let mut columns: [[f64; 6]; 6] = [[0.0; 6]; 6];
            columns.as_flattened_mut().fill_with(|| rng.uniform_in(-1.0, 1.0));
            // Two columns apart, nearly alike, or equal.
            let apart = if draw % 10 == 9 { 0.0 } else { 10.0_f64.powi(-(draw % 10)) };
            columns[4] = std::array::from_fn(|i| columns[1][i] + apart * columns[4][i]);
            let least = Matrix6::from_fn(|row, column| columns[column][row]).singular_values().min();
            let bound = stiffness_of(&columns);
            assert!(bound < 1.001 * least + 1e-7 && 2.5 * bound + 1e-7 > least, "{bound} {least}");
        }
        assert_eq!(stiffness_of(&[[0.0; 6]; 6]), 0.0);
    }
}
