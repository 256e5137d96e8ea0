//! Finite ranges for random draws.

use std::f64::consts::TAU;

/// Position limit (rad, m) beyond which a joint counts as unlimited: angles that large have lost the digits that a tip needs.
pub const UNLIMITED: f64 = 1e6 * TAU;

/// Opens limits beyond [`UNLIMITED`] (rad, m).
pub fn opened(lower: f64, upper: f64) -> (f64, f64) {
    (if lower < -UNLIMITED { f64::NEG_INFINITY } else { lower }, if upper > UNLIMITED { f64::INFINITY } else { upper })
}

/// Returns a finite range: an unbounded side ends 2 `reach` from the other bound, or `reach` from zero if both are unbounded.
pub fn finite(lower: f64, upper: f64, reach: f64) -> (f64, f64) {
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => (lower, upper),
        (true, false) => (lower, lower + 2.0 * reach),
        (false, true) => (upper - 2.0 * reach, upper),
        (false, false) => (-reach, reach),
    }
}
