//! Vectors of three numbers for kernels. Operations are written out entry by entry: closures over arrays would be
//! compiled without the instructions of the calling kernel.

use std::ops::{Add, Mul};

/// A vector.
#[derive(Debug, Clone, Copy)]
pub struct Vec3 {
    /// First entry.
    pub x: f64,
    /// Second entry.
    pub y: f64,
    /// Third entry.
    pub z: f64,
}

impl Vec3 {
    /// From its entries.
    #[inline(always)]
    pub fn of(entries: &[f64; 3]) -> Self {
        let [x, y, z] = *entries;
        Self { x, y, z }
    }

    /// Its entries.
    #[inline(always)]
    pub fn stored(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    /// The scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The cross product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}

impl Mul<f64> for Vec3 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl Add for Vec3 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}
