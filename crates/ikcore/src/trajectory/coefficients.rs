//! The polynomial of one joint in one segment.

use crate::math::bernstein::choose;

/// Number of coefficients of a segment. Degree 6 is needed for a cubic in a path parameter that is a parabola in time.
pub const POWERS: usize = 7;

/// A polynomial up to degree 6 in the time s (s) since the start of the segment: q = c\[0\] + c\[1\] s + ... + c\[6\]
/// s^6 (rad or m).
pub type Coefficients = [f64; POWERS];

/// Returns the polynomial p(s + `by`) of s, for p with these coefficients.
pub(super) fn shifted(mut coefficients: Coefficients, by: f64) -> Coefficients {
    if by != 0.0 {
        for first in 0..POWERS - 1 {
            for power in (first..POWERS - 1).rev() {
                coefficients[power] += by * coefficients[power + 1];
            }
        }
    }
    coefficients
}

/// Returns the derivative of this order, padded with zeros.
pub(super) fn nth_derivative(mut coefficients: Coefficients, order: usize) -> Coefficients {
    for _ in 0..order {
        for power in 1..POWERS {
            coefficients[power - 1] = power as f64 * coefficients[power];
        }
        coefficients[POWERS - 1] = 0.0;
    }
    coefficients
}

/// Returns the polynomial with these coefficients, at most [`POWERS`] of them in ascending powers, padded with zeros.
pub const fn polynomial<const N: usize>(given: [f64; N]) -> Coefficients {
    const { assert!(N <= POWERS) };
    let mut padded = [0.0; POWERS];
    let mut power = 0;
    while power < N {
        padded[power] = given[power];
        power += 1;
    }
    padded
}

/// Bounds of the first `N` Taylor coefficients of the derivative of a polynomial, at every point of \[-1, 1\].
pub(crate) fn derivative_bounds<const N: usize>(polynomial: &Coefficients) -> [f64; N] {
    std::array::from_fn(|k| {
        let powers = polynomial.iter().enumerate().skip(k + 1);
        let sum: f64 = powers.map(|(power, c)| choose(power, k + 1) as f64 * c.abs()).sum();
        (k + 1) as f64 * sum
    })
}
