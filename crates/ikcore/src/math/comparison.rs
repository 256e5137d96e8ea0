//! Maximum, minimum and sign in fewer instructions than the standard library, which handles NaN and signed zeros.

/// Returns the larger number; the second if one is NaN.
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Returns the smaller number; the second if one is NaN.
#[inline(always)]
pub fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Returns 1 or -1; 0 at zero and for NaN.
#[inline]
pub fn sign(z: f64) -> f64 {
    f64::from(i8::from(z > 0.0) - i8::from(z < 0.0))
}
