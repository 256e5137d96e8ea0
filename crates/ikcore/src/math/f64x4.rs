//! Four numbers in one register, if the machine has such registers.

use std::ops::Neg;

/// Four numbers, on which [`Arithmetic`](super::arithmetic::Arithmetic) works lane by lane. A vector of three also uses
/// one, with the last lane unused: the compiler splits arrays of three, and a Jacobian then takes a tenth longer.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub struct F64x4(pub [f64; 4]);

impl F64x4 {
    /// Zeros.
    pub const ZERO: Self = Self([0.0; 4]);

    /// The same number in all lanes.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; 4])
    }

    /// The four entries of `row` from `first` on.
    #[inline(always)]
    pub fn of<const L: usize>(row: &[f64; L], first: usize) -> Self {
        Self([row[first], row[first + 1], row[first + 2], row[first + 3]])
    }

    /// Writes the lanes into `row`, from `first` on.
    #[inline(always)]
    pub fn write<const L: usize>(self, row: &mut [f64; L], first: usize) {
        row[first..first + 4].copy_from_slice(&self.0);
    }

    /// A vector; zero in the last lane.
    #[inline(always)]
    pub fn from_vector(v: &[f64; 3]) -> Self {
        Self([v[0], v[1], v[2], 0.0])
    }

    /// The first three lanes.
    #[inline(always)]
    pub fn vector(self) -> [f64; 3] {
        let [x, y, z, _] = self.0;
        [x, y, z]
    }

    /// (y, z, x), with the last lane unchanged.
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
        // Written out: a closure over the array would be compiled without the instructions of the calling kernel.
        let [a, b, c, d] = self.0;
        Self([-a, -b, -c, -d])
    }
}
