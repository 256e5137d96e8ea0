//! The larger and the smaller of two numbers in one instruction each, where `max` and `min` would sort out NaN. Where one of
//! them is NaN, the second is returned.

/// The larger.
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller.
#[inline(always)]
pub fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
