//! The polynomial of one joint in one segment.

/// Number of coefficients of a segment. Degree 6 is needed for a cubic in a path parameter that is a parabola in time.
pub const POWERS: usize = 7;

/// A polynomial up to degree 6 in the time s (s) since the start of the segment: q = c\[0\] + c\[1\] s + ... + c\[6\]
/// s^6 (rad or m).
pub type Coefficients = [f64; POWERS];

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
