//! Branch-free sine and cosine of whole arrays, which the compiler vectorises.
//!
//! Angles are reduced to [-pi/4, pi/4] by the method of Cody and Waite (pi/2 in three parts); the minimax polynomials were
//! fitted for this file by Remez exchange. The relative error of the polynomials is 4e-18, that of the results at most 1 ulp
//! beyond rounding.

use std::f64::consts::{FRAC_1_PI, FRAC_2_PI};

use super::arithmetic::Arithmetic;
use super::real::{Eight, Real};

/// Polynomial S of sin x = x + x^3 S(x^2).
const S: [f64; 6] = [
    -0.16666666666666632,
    0.008333333333322413,
    -0.0001984126982980723,
    2.755731369174883e-06,
    -2.5050758092068576e-08,
    1.5896794445879583e-10,
];
/// Polynomial C of cos x = 1 - x^2/2 + x^4 C(x^2).
const C: [f64; 6] = [
    0.0416666666666666,
    -0.0013888888888874125,
    2.4801587289482726e-05,
    -2.755731435247225e-07,
    2.0875723290374855e-09,
    -1.1359648615922363e-11,
];
/// Three parts of pi/2; the first two have 33 bits, so that their products with a quadrant below 2^19 are exact.
const HALF_PI: [f64; 3] = [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21];
/// Largest angle (rad) for which these products are exact; larger angles use the standard library.
const LARGEST: f64 = 8e5;
/// Constant 1.5 * 2^52: adding it rounds to an integer, which is then in the lowest bits.
const ROUNDER: f64 = 6755399441055744.0;

/// Writes sines and cosines of `angles` (rad); all three have the same length.
#[inline(always)]
pub fn sincos<A: Arithmetic>(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    let mut all_small = true;
    for i in 0..angles.len() {
        (sines[i], cosines[i]) = sincos_one::<A>(angles[i]);
        // False for NaN too; the standard library then returns NaN.
        all_small &= angles[i].abs() <= LARGEST;
    }
    if !all_small {
        for i in 0..angles.len() {
            (sines[i], cosines[i]) = angles[i].sin_cos();
        }
    }
}

/// Computes [`sincos`] for W columns of angles, bit-identical to each column alone.
#[inline(always)]
pub fn sincos_by_column<A: Arithmetic, const W: usize>(
    angles: &[[f64; W]],
    sines: &mut [[f64; W]],
    cosines: &mut [[f64; W]],
) {
    let mut all_small = true;
    for i in 0..angles.len() {
        for w in 0..W {
            (sines[i][w], cosines[i][w]) = sincos_one::<A>(angles[i][w]);
            all_small &= angles[i][w].abs() <= LARGEST;
        }
    }
    if !all_small {
        for w in (0..W).filter(|w| angles.iter().any(|row| !(row[*w].abs() <= LARGEST))) {
            for i in 0..angles.len() {
                (sines[i][w], cosines[i][w]) = angles[i][w].sin_cos();
            }
        }
    }
}

#[inline(always)]
fn sincos_one<A: Arithmetic>(x: f64) -> (f64, f64) {
    let shifted = A::mul_add(x, FRAC_2_PI, ROUNDER);
    let quadrant = shifted.to_bits();
    let k = shifted - ROUNDER;
    let r = A::mul_add(-k, HALF_PI[0], x);
    let r = A::mul_add(-k, HALF_PI[1], r);
    let r = A::mul_add(-k, HALF_PI[2], r);
    let u = r * r;
    let sine = A::mul_add(r * u, horner::<A>(&S, u), r);
    let cosine = A::mul_add(u * u, horner::<A>(&C, u), A::mul_add(-0.5, u, 1.0));
    // Odd quadrants swap sine and cosine; the sine is negative in quadrants 2 and 3, the cosine in 1 and 2.
    let swap = (quadrant & 1).wrapping_neg();
    let (s, c) = (sine.to_bits(), cosine.to_bits());
    let sine_sign = (quadrant & 2) << 62;
    let cosine_sign = (quadrant.wrapping_add(1) & 2) << 62;
    (f64::from_bits(((s & !swap) | (c & swap)) ^ sine_sign), f64::from_bits(((c & !swap) | (s & swap)) ^ cosine_sign))
}

#[inline(always)]
fn horner<A: Arithmetic>(coefficients: &[f64; 6], u: f64) -> f64 {
    let [rest @ .., last] = coefficients;
    rest.iter().rev().fold(*last, |sum, c| A::mul_add(sum, u, *c))
}

/// Two parts of 2 pi; the first has few bits, so that its products with small integers are exact in single precision.
const TURN: [f64; 2] = [6.28125, 0.001_935_307_179_586_232];
/// Constant 1.5 * 2^23: adding it rounds a single-precision number to an integer.
const SINGLE_ROUNDER: f64 = 12_582_912.0;

/// Returns sine and cosine of angles of a few turns (rad), to 1e-6 in single precision.
#[inline(always)]
pub fn sincos_eight<A: Arithmetic>(x: Eight<A>) -> (Eight<A>, Eight<A>) {
    let splat = Eight::<A>::splat;
    let turns = x.mul_add(splat(0.5 * FRAC_1_PI), splat(SINGLE_ROUNDER)) - splat(SINGLE_ROUNDER);
    let r = turns.mul_add(splat(-TURN[1]), turns.mul_add(splat(-TURN[0]), x));
    // Taylor series at half the angle, which is at most a quarter turn.
    let t = r * splat(0.5);
    let u = t * t;
    let mut sine = splat(1.0 / 6_227_020_800.0);
    let mut cosine = splat(1.0 / 479_001_600.0);
    for (s, c) in SERIES {
        sine = sine.mul_add(u, splat(s));
        cosine = cosine.mul_add(u, splat(c));
    }
    let sine = sine * t;
    let doubled = sine + sine;
    (doubled * cosine, (-doubled).mul_add(sine, splat(1.0)))
}

/// Taylor coefficients of sin(x) / x and cos(x) after the leading one, in descending powers of x^2.
const SERIES: [(f64, f64); 6] = [
    (-1.0 / 39_916_800.0, -1.0 / 3_628_800.0),
    (1.0 / 362_880.0, 1.0 / 40_320.0),
    (-1.0 / 5_040.0, -1.0 / 720.0),
    (1.0 / 120.0, 1.0 / 24.0),
    (-1.0 / 6.0, -0.5),
    (1.0, 1.0),
];

#[cfg(test)]
mod tests {
    use super::super::arithmetic::{Fma, NoFma};
    use super::super::f32x8::F32x8;
    use super::*;

    fn sincos_of<A: Arithmetic, const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
        let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
        sincos::<A>(&angles, &mut sines, &mut cosines);
        (sines, cosines)
    }

    fn worst_error<A: Arithmetic>() -> f64 {
        let mut worst: f64 = 0.0;
        for k in -200_000..=200_000 {
            let x = f64::from(k) * 3.7e-4;
            let ([s], [c]) = sincos_of::<A, 1>([x]);
            worst = worst.max((s - x.sin()).abs()).max((c - x.cos()).abs());
        }
        worst
    }

    #[test]
    fn agrees_with_the_standard_library_to_two_ulp_of_one() {
        assert!(worst_error::<NoFma>() <= 2.3e-16, "{:e}", worst_error::<NoFma>());
        assert!(worst_error::<Fma>() <= 2.3e-16, "{:e}", worst_error::<Fma>());
    }

    #[test]
    fn exact_at_zero_and_right_at_quarter_turns() {
        let ([s], [c]) = sincos_of::<NoFma, 1>([0.0]);
        assert_eq!((s, c), (0.0, 1.0));
        let ([s], [c]) = sincos_of::<NoFma, 1>([std::f64::consts::FRAC_PI_2]);
        assert!((s - 1.0).abs() < 1e-16 && (c - 6.123233995736766e-17).abs() < 1e-17);
    }

    #[test]
    fn huge_angles_and_nan_keep_their_meaning() {
        let (s, c) = sincos_of::<NoFma, 3>([1e9, 0.3, f64::NAN]);
        assert_eq!((s[0], c[0]), 1e9_f64.sin_cos());
        assert!(s[2].is_nan() && c[2].is_nan() && (s[1] - 0.3_f64.sin()).abs() < 1e-16);
    }

    #[test]
    fn single_precision_agrees_to_a_millionth() {
        fn worst<A: Arithmetic>() -> f64 {
            let mut worst: f64 = 0.0;
            for k in -20_000..20_000 {
                let x = F32x8(std::array::from_fn(|lane| (k as f32 + lane as f32 / 8.0) * 1e-3));
                let (sine, cosine) = sincos_eight(Eight::<A>::of(x));
                for lane in 0..8 {
                    let (s, c) = f64::from(x.0[lane]).sin_cos();
                    worst = worst.max((sine.lane(lane) - s).abs()).max((cosine.lane(lane) - c).abs());
                }
            }
            worst
        }
        assert!(worst::<NoFma>() < 1e-6, "{:e}", worst::<NoFma>());
        assert!(worst::<Fma>() < 1e-6, "{:e}", worst::<Fma>());
    }

    #[test]
    fn a_column_does_not_depend_on_its_neighbours() {
        let angles = [[0.1, 1e9, -3.0, 2e5], [0.7, 0.2, 8e6, -1.0]];
        let (mut sines, mut cosines) = ([[0.0; 4]; 2], [[0.0; 4]; 2]);
        sincos_by_column::<NoFma, 4>(&angles, &mut sines, &mut cosines);
        for w in 0..4 {
            let column = |rows: [[f64; 4]; 2]| rows.map(|row| row[w]);
            assert_eq!((column(sines), column(cosines)), sincos_of::<NoFma, 2>(column(angles)));
        }
    }
}
