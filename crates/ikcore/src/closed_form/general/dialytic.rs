//! Sylvester's dialytic method for six equations in the products x^i y^j (i, j from 0 to 2), with x and y tangents of half
//! angles.
//!
//! The equations and their multiples by x form twelve equations, linear in twelve products x^i y^j (i up to 3). They have a
//! solution where the determinant vanishes, and its null vector contains x and y.

use crate::closed_form::angle::Angle;
use crate::math::vector::dot;

/// Number of equations.
pub const EQUATIONS: usize = 6;
/// Number of products in an equation, index 3 i + j.
pub const PRODUCTS: usize = 9;
/// Size of the square system: the six equations, and their multiples by x.
const SIZE: usize = 12;

/// Coefficients of the six equations.
pub type LoopCoefficients = [[f64; PRODUCTS]; EQUATIONS];

type Square = [[f64; SIZE]; SIZE];

fn doubled(coefficients: &LoopCoefficients) -> Square {
    let mut square = [[0.0; SIZE]; SIZE];
    for (row, equation) in coefficients.iter().enumerate() {
        square[row][..PRODUCTS].copy_from_slice(equation);
        square[EQUATIONS + row][SIZE - PRODUCTS..].copy_from_slice(equation);
    }
    square
}

/// Returns the determinant of the twelve equations.
pub fn determinant(coefficients: &LoopCoefficients) -> f64 {
    let mut square = doubled(coefficients);
    let sign = triangularize(&mut square);
    (0..SIZE).fold(sign, |product, k| product * square[k][k])
}

/// Triangularizes by Gaussian elimination with row pivoting; returns the sign of the row permutation.
fn triangularize(square: &mut Square) -> f64 {
    let mut sign = 1.0;
    for k in 0..SIZE {
        let pivot = (k + 1..SIZE).fold(k, |best, i| if square[i][k].abs() > square[best][k].abs() { i } else { best });
        if pivot != k {
            square.swap(k, pivot);
            sign = -sign;
        }
        let head = square[k];
        if head[k] == 0.0 {
            continue;
        }
        let inverse = 1.0 / head[k];
        for row in &mut square[k + 1..] {
            let factor = row[k] * inverse;
            // Full rows: the constant loop length vectorises.
            (0..SIZE).for_each(|j| row[j] -= factor * head[j]);
        }
    }
    sign
}

/// Returns at most two pairs (x, y), as angles, that satisfy all equations if the determinant nearly vanishes.
pub fn null_pairs(coefficients: &LoopCoefficients) -> ([[Angle; 2]; 2], usize) {
    let mut square = doubled(coefficients);
    let order = triangularize_fully(&mut square);
    let pivot = |k: usize| square[k][order[k]].abs();
    // Two vanishing pivots: two solutions share the hidden angle.
    if pivot(SIZE - 2) < 1e-5 * pivot(SIZE - 3) {
        let basis = [SIZE - 1, SIZE - 2].map(|free| null_vector(&square, &order, free, SIZE - 2));
        return separated(&basis);
    }
    let mut pairs = [[Angle::NONE; 2]; 2];
    pairs[0] = angles(&null_vector(&square, &order, SIZE - 1, SIZE - 1));
    (pairs, 1)
}

/// Triangularizes by Gaussian elimination with full pivoting; returns the column of each pivot. Columns are not moved.
fn triangularize_fully(square: &mut Square) -> [usize; SIZE] {
    let mut order = [0; SIZE];
    let mut used = [false; SIZE];
    for k in 0..SIZE {
        // Entries of finished columns are exactly zero.
        let largest =
            |row: &[f64; SIZE]| row.iter().fold(0.0, |most: f64, x| if x.abs() > most { x.abs() } else { most });
        let (mut pivot, mut most) = (k, -1.0);
        for i in k..SIZE {
            let size = largest(&square[i]);
            (pivot, most) = if size > most { (i, size) } else { (pivot, most) };
        }
        square.swap(k, pivot);
        let head = square[k];
        let free = |j: &usize| !used[*j];
        let Some(column) = (0..SIZE).filter(free).max_by(|a, b| head[*a].abs().total_cmp(&head[*b].abs())) else {
            break;
        };
        (order[k], used[column]) = (column, true);
        let inverse = if head[column] == 0.0 { 0.0 } else { 1.0 / head[column] };
        for row in &mut square[k + 1..] {
            let factor = row[column] * inverse;
            (0..SIZE).for_each(|j| row[j] -= factor * head[j]);
            row[column] = 0.0;
        }
    }
    order
}

/// Returns the null vector with entry one in the column of pivot `free`, and zero in the columns of the other pivots from
/// `rank` on.
fn null_vector(square: &Square, order: &[usize; SIZE], free: usize, rank: usize) -> [f64; SIZE] {
    let mut x = [0.0; SIZE];
    x[order[free]] = 1.0;
    for k in (0..rank).rev() {
        let sum: f64 = (0..SIZE).map(|j| square[k][j] * x[j]).sum();
        x[order[k]] = -sum / square[k][order[k]];
    }
    x
}

/// Extracts x and y, as angles, from a vector of products: by ratios of neighbouring entries, inverted where the ratio would
/// be infinite.
fn angles(vector: &[f64; SIZE]) -> [Angle; 2] {
    let ratio = |step: usize, low: &dyn Fn(usize) -> bool| {
        let (mut lows, mut highs, mut mixed) = (0.0, 0.0, 0.0);
        for k in (0..SIZE - step).filter(|k| low(*k)) {
            lows += vector[k] * vector[k];
            highs += vector[k + step] * vector[k + step];
            mixed += vector[k] * vector[k + step];
        }
        if highs <= lows { half_angle(mixed, lows) } else { half_angle(highs, mixed) }
    };
    [ratio(3, &|_| true), ratio(1, &|k| k % 3 != 2)]
}

/// Returns the angle whose half has the tangent high / low.
fn half_angle(high: f64, low: f64) -> Angle {
    Angle::towards((low - high) * (low + high), 2.0 * high * low)
}

/// Separates two solution pairs in their common null space: x maps the products with i up to 2 to the products with i from 1.
fn separated(basis: &[[f64; SIZE]; 2]) -> ([[Angle; 2]; 2], usize) {
    // Solutions satisfy x low = high; z = (x - 1)/(x + 1) replaces x, which may be infinite.
    let parts = basis.map(|v| {
        let sum: [f64; 9] = std::array::from_fn(|k| v[k + 3] + v[k]);
        let difference: [f64; 9] = std::array::from_fn(|k| v[k + 3] - v[k]);
        (sum, difference)
    });
    let gram = |i: usize, j: usize| dot(&parts[i].0, &parts[j].0);
    let mixed = |i: usize, j: usize| dot(&parts[i].0, &parts[j].1);
    let (a, b, d) = (gram(0, 0), gram(0, 1), gram(1, 1));
    let determinant = a * d - b * b;
    // Matrix m = gram^-1 mixed, whose eigenvalues are z.
    let m = [
        [(d * mixed(0, 0) - b * mixed(1, 0)) / determinant, (d * mixed(0, 1) - b * mixed(1, 1)) / determinant],
        [(a * mixed(1, 0) - b * mixed(0, 0)) / determinant, (a * mixed(1, 1) - b * mixed(0, 1)) / determinant],
    ];
    let (half, minor) = (0.5 * (m[0][0] + m[1][1]), m[0][0] * m[1][1] - m[0][1] * m[1][0]);
    let radicand = half * half - minor;
    let mut pairs = [[Angle::NONE; 2]; 2];
    // Slightly complex eigenvalues: a double solution, which Newton's method may still reach.
    let root = radicand.max(0.0).sqrt();
    for (pair, value) in pairs.iter_mut().zip([half + root, half - root]) {
        let (u, v) = ([m[0][1], value - m[0][0]], [value - m[1][1], m[1][0]]);
        let weights = if dot(&u, &u) > dot(&v, &v) { u } else { v };
        *pair = angles(&std::array::from_fn(|k| weights[0] * basis[0][k] + weights[1] * basis[1][k]));
    }
    (pairs, 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns six random equations that hold at all given pairs of tangents.
    fn equations(pairs: &[[f64; 2]]) -> LoopCoefficients {
        let vectors: Vec<[f64; 9]> =
            pairs.iter().map(|[x, y]| std::array::from_fn(|k| x.powi(k as i32 / 3) * y.powi(k as i32 % 3))).collect();
        let mut seed = 7.0_f64;
        std::array::from_fn(|_| {
            let mut row: [f64; 9] = std::array::from_fn(|_| {
                seed = (seed * 91.7 + 0.31).fract();
                seed - 0.5
            });
            // Gram-Schmidt orthogonalization, repeated because the two vectors are not orthogonal.
            for _ in 0..200 {
                for v in &vectors {
                    let factor = (0..9).map(|k| row[k] * v[k]).sum::<f64>() / v.iter().map(|x| x * x).sum::<f64>();
                    (0..9).for_each(|k| row[k] -= factor * v[k]);
                }
            }
            row
        })
    }

    #[test]
    fn one_pair_and_two_pairs() {
        for pairs in [vec![[0.7, -1.9]], vec![[0.7, -1.9], [-2.5, 0.4]]] {
            let coefficients = equations(&pairs);
            assert!(determinant(&coefficients).abs() < 1e-12);
            let (found, count) = null_pairs(&coefficients);
            assert_eq!(count, pairs.len());
            for [x, y] in pairs {
                let near = |turn: Angle, tangent: f64| ((0.5 * turn.angle()).tan() - tangent).abs() < 1e-6;
                assert!(found[..count].iter().any(|[a, b]| near(*a, x) && near(*b, y)), "{found:?}");
            }
        }
    }
}
