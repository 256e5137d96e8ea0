//! Rate of the left Jacobian of SO(3), for a floating base.

use crate::math::so3::{cross, dot};

/// Squared angle (rad^2) below which series replace quotients that would lose digits.
const SMALL: f64 = 1.0;

/// Returns dJ/dt rates with the left Jacobian J of SO(3) at the rotation vector `phi` (rad), where d(phi)/dt = `rates`: the
/// angular acceleration of a rotation whose vector changes at a constant rate.
pub(super) fn rate_of_left_jacobian(phi: &[f64; 3], rates: &[f64; 3]) -> [f64; 3] {
    // J = 1 + a [phi] + b [phi]^2 with a = (1 - cos x) / x^2 and b = (x - sin x) / x^3 at x = |phi|.
    let squared = dot(phi, phi);
    let [of_a, b, of_b] = coefficients(squared);
    let along = dot(phi, rates);
    let once = cross(phi, rates);
    let twice = cross(phi, &once);
    let mixed = cross(rates, &once);
    std::array::from_fn(|k| along * (of_a * once[k] + of_b * twice[k]) + b * mixed[k])
}

/// Returns a'(x) / x, b(x) and b'(x) / x at the square of x.
fn coefficients(squared: f64) -> [f64; 3] {
    if squared < SMALL {
        return [A_PRIME, B, B_PRIME].map(|terms| terms.iter().rev().fold(0.0, |sum, term| term - squared * sum));
    }
    let x = squared.sqrt();
    let (sine, cosine) = x.sin_cos();
    [
        (x * sine - 2.0 * (1.0 - cosine)) / (squared * squared),
        (x - sine) / (squared * x),
        (3.0 * sine - x * (2.0 + cosine)) / (squared * squared * x),
    ]
}

/// Terms of the alternating series of a'(x) / x in x^2: -2 k / (2 k + 2)!, k from 1 on.
const A_PRIME: [f64; 8] = [
    -1.0 / 12.0,
    -1.0 / 180.0,
    -1.0 / 6720.0,
    -1.0 / 453_600.0,
    -1.0 / 47_900_160.0,
    -1.0 / 7_264_857_600.0,
    -1.0 / 1_494_484_992_000.0,
    -1.0 / 400_148_356_608_000.0,
];

/// Terms of the series of b(x): 1 / (2 k + 1)!.
const B: [f64; 8] = [
    1.0 / 6.0,
    1.0 / 120.0,
    1.0 / 5040.0,
    1.0 / 362_880.0,
    1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
];

/// Terms of the series of b'(x) / x: -2 k / (2 k + 3)!.
const B_PRIME: [f64; 8] = [
    -1.0 / 60.0,
    -1.0 / 1260.0,
    -1.0 / 60_480.0,
    -1.0 / 4_989_600.0,
    -1.0 / 622_702_080.0,
    -1.0 / 108_972_864_000.0,
    -1.0 / 25_406_244_864_000.0,
    -1.0 / 7_602_818_775_552_000.0,
];
