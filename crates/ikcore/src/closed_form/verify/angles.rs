//! Branch-free arctangents of several candidates in SIMD lanes.

use std::f64::consts::PI;

use crate::closed_form::branches::Candidates;
use crate::math::arctangent::angle_of;
use crate::math::arithmetic::Arithmetic;
use crate::math::real::{One, Real};

/// Returns the joint values of `W` candidates from `first` on, angles in (-pi, pi].
#[inline(always)]
pub fn angles<A: Arithmetic, const N: usize, const W: usize>(
    slides: &[bool; N],
    candidates: &Candidates,
    first: usize,
) -> [[f64; W]; N] {
    let mut all = [[0.0; W]; N];
    for k in 0..N {
        let (cos, sin) = (&candidates.cos[k][first..first + W], &candidates.sin[k][first..first + W]);
        if slides[k] {
            all[k].copy_from_slice(sin);
        } else {
            for w in 0..W {
                all[k][w] = angle::<A>(sin[w], cos[w]);
            }
        }
    }
    all
}

#[inline(always)]
fn angle<A: Arithmetic>(sin: f64, cos: f64) -> f64 {
    let upper = angle_of(One::<A>::of(sin.abs()), One::of(cos)).stored();
    // Sign of the sine; half a turn is +pi.
    if sin < 0.0 && upper < PI { -upper } else { upper }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::arithmetic::NoFma;

    #[test]
    fn angles_lie_above_minus_pi_and_have_the_sign_of_their_sine() {
        for k in -1000..=1000 {
            let exact = f64::from(k) * PI / 1000.0;
            let ours = angle::<NoFma>(exact.sin(), exact.cos());
            let off = (ours - exact).abs();
            assert!(off < 1e-15 || (off - 2.0 * PI).abs() < 1e-15, "{k} {ours} {exact}");
            assert!(ours > -PI && ours <= PI);
        }
        assert_eq!((angle::<NoFma>(-0.0, -1.0), angle::<NoFma>(0.0, 1.0)), (PI, 0.0));
    }
}
