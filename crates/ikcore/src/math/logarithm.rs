//! Branch-free natural logarithm, which the compiler vectorises. Used for random draws: relative error below 1e-11.

use std::f64::consts::{LN_2, SQRT_2};

/// Bit mask of the mantissa.
const MANTISSA: u64 = (1 << 52) - 1;
/// Bits of 1.0, whose exponent is zero.
const ONE: u64 = 1.0_f64.to_bits();
/// Constant 2^52: the lowest bit of numbers of this size has the value one.
const COUNTER: f64 = 4503599627370496.0;

/// Returns ln x of a normal positive x.
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = f64::from_bits((bits >> 52) | COUNTER.to_bits()) - COUNTER - 1023.0;
    let mantissa = f64::from_bits((bits & MANTISSA) | ONE);
    // Scale the mantissa into [sqrt(1/2), sqrt(2)).
    let large = mantissa >= SQRT_2;
    let m = if large { 0.5 * mantissa } else { mantissa };
    let k = if large { exponent + 1.0 } else { exponent };
    // Series ln m = 2 artanh s, s = (m - 1) / (m + 1), |s| <= 0.172.
    let s = (m - 1.0) / (m + 1.0);
    let u = s * s;
    let series = 1.0
        + u * (1.0 / 3.0 + u * (1.0 / 5.0 + u * (1.0 / 7.0 + u * (1.0 / 9.0 + u * (1.0 / 11.0 + u * (1.0 / 13.0))))));
    k * LN_2 + 2.0 * s * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_agrees_with_the_standard_library() {
        for k in 1..200_000 {
            let x = f64::from(k) / 200_000.0;
            assert!((ln(x) - x.ln()).abs() <= 1e-11 * x.ln().abs(), "ln {x}: {} {}", ln(x), x.ln());
        }
        assert_eq!(ln(1.0), 0.0);
        let tiny = 2.0_f64.powi(-53);
        assert!((ln(tiny) - tiny.ln()).abs() < 1e-10);
    }
}
