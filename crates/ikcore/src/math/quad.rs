//! Four numbers in one register, where the machine has such registers.

use std::ops::Neg;

use super::arithmetic::Arithmetic;

/// Four numbers, on which [`Arithmetic`] works lane by lane. A vector of three takes one with a lane to spare: arrays of three
/// the compiler takes to pieces, and a Jacobian then takes a tenth longer.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub struct Quad(pub [f64; 4]);

impl Quad {
    /// Zeros.
    pub const ZERO: Self = Self([0.0; 4]);

    /// The same number in all lanes.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; 4])
    }

    /// Four neighbours in `row`, of which the first is number `first`.
    #[inline(always)]
    pub fn of<const L: usize>(row: &[f64; L], first: usize) -> Self {
        Self([row[first], row[first + 1], row[first + 2], row[first + 3]])
    }

    /// Writes the lanes into `row`, from number `first` on.
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

    /// The cross product of two vectors.
    #[inline(always)]
    pub fn cross<A: Arithmetic>(self, other: Self) -> Self {
        // a x b = P (a * Pb - Pa * b), entry by entry, with the cyclic permutation P.
        let product = A::mul_quad(self.permuted(), other);
        A::mul_add_quad(self, other.permuted(), -product).permuted()
    }

    /// y, z, x.
    #[inline(always)]
    fn permuted(self) -> Self {
        let [x, y, z, w] = self.0;
        Self([y, z, x, w])
    }
}

impl Neg for Quad {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|lane| -lane))
    }
}
