//! Finite ranges for random draws.

/// The range itself if it is finite; an unbounded side ends 2 `reach` from the other bound, or `reach` from zero.
pub fn finite(lower: f64, upper: f64, reach: f64) -> (f64, f64) {
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => (lower, upper),
        (true, false) => (lower, lower + 2.0 * reach),
        (false, true) => (upper - 2.0 * reach, upper),
        (false, false) => (-reach, reach),
    }
}
