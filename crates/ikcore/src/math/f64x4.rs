//! Four double-precision numbers, in one register if the machine has such registers.

use std::ops::Neg;

/// Four lanes for [`Arithmetic`](super::arithmetic::Arithmetic). A three-vector also uses this type, with the last lane
/// unused: the compiler splits arrays of three, and a Jacobian then takes a tenth longer.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub struct F64x4(pub [f64; 4]);

impl F64x4 {
    /// Zero in all lanes.
    pub const ZERO: Self = Self([0.0; 4]);

    /// Broadcasts a number to all lanes.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; 4])
    }

    /// Loads four entries of `row` from `first` on.
    #[inline(always)]
    pub fn of<const L: usize>(row: &[f64; L], first: usize) -> Self {
        Self([row[first], row[first + 1], row[first + 2], row[first + 3]])
    }

    /// Writes the lanes into `row`, from `first` on.
    #[inline(always)]
    pub fn write<const L: usize>(self, row: &mut [f64; L], first: usize) {
        row[first..first + 4].copy_from_slice(&self.0);
    }

    /// Loads a vector, with zero in the last lane.
    #[inline(always)]
    pub fn from_vector(v: &[f64; 3]) -> Self {
        Self([v[0], v[1], v[2], 0.0])
    }

    /// Returns the first three lanes.
    #[inline(always)]
    pub fn vector(self) -> [f64; 3] {
        let [x, y, z, _] = self.0;
        [x, y, z]
    }

    /// Permutes to (y, z, x), with the last lane unchanged.
    #[inline(always)]
    pub(super) fn permuted(self) -> Self {
        let [x, y, z, w] = self.0;
        Self([y, z, x, w])
    }
}

impl Neg for F64x4 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        // Unrolled by hand: a closure over the array would be compiled without the instructions of the calling kernel.
        let [a, b, c, d] = self.0;
        Self([-a, -b, -c, -d])
    }
}
