//! Eight single-precision numbers, in one register if the machine has such registers.

use std::ops::Neg;

/// Eight lanes for [`Arithmetic`](super::arithmetic::Arithmetic), used by searches whose results are confirmed in double
/// precision.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub struct F32x8(pub [f32; 8]);

impl F32x8 {
    /// Zero in all lanes.
    pub const ZERO: Self = Self([0.0; 8]);

    /// Broadcasts a number to all lanes.
    #[inline(always)]
    pub fn splat(value: f32) -> Self {
        Self([value; 8])
    }
}

impl Neg for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        // Unrolled by hand, as in `F64x4`.
        let [a, b, c, d, e, f, g, h] = self.0;
        Self([-a, -b, -c, -d, -e, -f, -g, -h])
    }
}
