//! Branch-free arctangent of a sine-cosine pair, for one pair or one per lane.
//!
//! Rotations by multiples of an eighth of a turn bring the quotient into [-tan(pi/8), tan(pi/8)], where a minimax polynomial
//! has a relative error of 2e-18; it was fitted for this file by Remez exchange.

use std::f64::consts::FRAC_PI_4;

use super::real::Real;

/// Polynomial P of atan x = x + x u P(u), u = x^2.
const P: [f64; 11] = [
    -0.33333333333333287,
    0.19999999999975157,
    -0.14285714282076734,
    0.11111110867012698,
    -0.09090899932226462,
    0.07692095685509116,
    -0.06663477507523208,
    0.05850426194121311,
    -0.05050044851457546,
    0.03832231473820668,
    -0.018175035551833984,
];
/// Threshold tan(pi/8), above which a quotient is first reduced by pi/4.
const EIGHTH: f64 = 0.41421356237309503;
/// Rounding error of [`FRAC_PI_4`], pi/4 - FRAC_PI_4.
const FRAC_PI_4_REST: f64 = 3.061616997868383e-17;

/// Returns the angle (rad, from 0 to pi) of a point at (`cosine`, `sine`), at any nonzero distance; `sine` is not
/// negative.
#[inline(always)]
pub fn angle_of<R: Real>(sine: R, cosine: R) -> R {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let size = cosine.choose_below(zero, -cosine, cosine);
    let (less, more) = (sine.smaller(size), size.larger(sine));
    // Angle decomposition: a multiple of pi/4, plus or minus the arctangent of a small quotient.
    let quarter = (more * R::splat(EIGHTH)).choose_below(less, one, zero);
    let quotient = (less - quarter * more) / (more + quarter * less);
    let (quarters, sign) = (quarter, one);
    let steep = |then: R, otherwise: R| size.choose_below(sine, then, otherwise);
    let (quarters, sign) = (steep(R::splat(2.0) - quarters, quarters), steep(-sign, sign));
    let backward = |then: R, otherwise: R| cosine.choose_below(zero, then, otherwise);
    let (quarters, sign) = (backward(R::splat(4.0) - quarters, quarters), backward(-sign, sign));
    let small = sign * arctangent(quotient) + quarters * R::splat(FRAC_PI_4_REST);
    quarters * R::splat(FRAC_PI_4) + small
}

/// Returns atan x for |x| <= tan(pi/8).
#[inline(always)]
fn arctangent<R: Real>(x: R) -> R {
    let u = x * x;
    let (u2, u4) = (u * u, (u * u) * (u * u));
    // Estrin's scheme: pairs, then pairs of pairs, for shorter dependency chains than Horner's scheme has.
    let pair = |k: usize| R::splat(P[k]) + R::splat(P[k + 1]) * u;
    let four = |k: usize| pair(k) + pair(k + 2) * u2;
    let last = pair(8) + R::splat(P[10]) * u2;
    x + x * u * (four(0) + four(4) * u4 + last * (u4 * u4))
}

#[cfg(test)]
mod tests {
    use super::super::arithmetic::NoFma;
    use super::super::real::One;
    use super::*;

    fn angle(sine: f64, cosine: f64) -> f64 {
        angle_of(One::<NoFma>::of(sine), One::of(cosine)).stored()
    }

    #[test]
    fn agrees_with_the_standard_library_to_an_ulp_or_two() {
        for k in 0..=400_000 {
            let turn = f64::from(k) / 400_000.0 * std::f64::consts::PI;
            let (sine, cosine) = (turn.sin().max(0.0), turn.cos());
            for scale in [1.0, 3e-7] {
                let (ours, exact) = (angle(scale * sine, scale * cosine), f64::atan2(scale * sine, scale * cosine));
                assert!((ours - exact).abs() <= 4.5e-16 * exact, "{turn}: {ours} {exact}");
            }
        }
    }

    #[test]
    fn tiny_sines_and_the_ends_are_exact() {
        assert_eq!((angle(0.0, 1.0), angle(1e-300, 1.0), angle(1e-9, 1.0)), (0.0, 1e-300, 1e-9));
        assert_eq!((angle(1.0, 0.0), angle(0.0, -1.0)), (std::f64::consts::FRAC_PI_2, std::f64::consts::PI));
    }
}
