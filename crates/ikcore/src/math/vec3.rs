//! Three-vectors of [`Real`]s for kernels. Operations are unrolled by hand: closures over arrays would be compiled without
//! the instructions of the calling kernel.

use std::ops::{Add, Mul, Sub};

use super::real::Real;

/// Three-vector, or several in SIMD lanes.
#[derive(Debug, Clone, Copy)]
pub struct Vec3<R> {
    /// First entry.
    pub x: R,
    /// Second entry.
    pub y: R,
    /// Third entry.
    pub z: R,
}

impl<R: Real> Vec3<R> {
    /// Loads from storage.
    #[inline(always)]
    pub fn of(stored: &[R::Stored; 3]) -> Self {
        let [x, y, z] = *stored;
        Self { x: R::of(x), y: R::of(y), z: R::of(z) }
    }

    /// Returns the storage form.
    #[inline(always)]
    pub fn stored(self) -> [R::Stored; 3] {
        [self.x.stored(), self.y.stored(), self.z.stored()]
    }

    /// Broadcasts a vector to all lanes.
    #[inline(always)]
    pub fn splat(vector: &[f64; 3]) -> Self {
        let [x, y, z] = *vector;
        Self { x: R::splat(x), y: R::splat(y), z: R::splat(z) }
    }

    /// Returns the vector in lane `lane`.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> [f64; 3] {
        [self.x.lane(lane), self.y.lane(lane), self.z.lane(lane)]
    }

    /// Replaces the vector in lane `lane`.
    #[inline(always)]
    pub fn with_lane(self, lane: usize, vector: &[f64; 3]) -> Self {
        let [x, y, z] = *vector;
        Self { x: self.x.with_lane(lane, x), y: self.y.with_lane(lane, y), z: self.z.with_lane(lane, z) }
    }

    /// Returns self * factor + addend.
    #[inline(always)]
    pub fn mul_add(self, factor: R, addend: Self) -> Self {
        Self {
            x: self.x.mul_add(factor, addend.x),
            y: self.y.mul_add(factor, addend.y),
            z: self.z.mul_add(factor, addend.z),
        }
    }

    /// Returns the scalar product, without FMA.
    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Returns the cross product, without FMA.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}

impl<R: Real> Mul<R> for Vec3<R> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: R) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<R: Real> Add for Vec3<R> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<R: Real> Sub for Vec3<R> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}
