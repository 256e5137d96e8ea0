//! The polynomial of one joint in one segment.

/// Powers of time that a segment may use: up to the sixth, which a cubic in a path parameter takes where that parameter is
/// a parabola in time.
pub const POWERS: usize = 7;

/// A polynomial up to degree 6 in the time s (s) since the segment began: q = c\[0\] + c\[1\] s + ... + c\[6\] s^6, in
/// rad or m and powers of s.
pub type Coefficients = [f64; POWERS];

/// The polynomial with these coefficients, at most [`POWERS`] of them in ascending powers, and zeros above.
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
