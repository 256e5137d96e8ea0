//! Number type of kernels written once for one double, four doubles, or eight singles.
//!
//! Each lane of four doubles performs the operations of one double in the same order, so both agree bit for bit.

use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::arithmetic::Arithmetic;
use super::comparison::{larger, smaller};
use super::f32x8::F32x8;
use super::f64x4::F64x4;

/// Real number, or several in SIMD lanes.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Storage type.
    type Stored: Copy;

    /// Number of lanes.
    const LANES: usize;

    /// Loads from storage.
    fn of(stored: Self::Stored) -> Self;

    /// Returns the storage form.
    fn stored(self) -> Self::Stored;

    /// Broadcasts a number to all lanes.
    fn splat(value: f64) -> Self;

    /// Returns the number in lane `lane`.
    fn lane(self, lane: usize) -> f64;

    /// Replaces the number in lane `lane`.
    fn with_lane(self, lane: usize, value: f64) -> Self;

    /// Returns self * factor + addend.
    fn mul_add(self, factor: Self, addend: Self) -> Self;

    /// Returns the square root.
    fn sqrt(self) -> Self;

    /// Returns `then` if self < limit, else `otherwise` (also for NaN).
    fn choose_below(self, limit: Self, then: Self, otherwise: Self) -> Self;

    /// Returns `then` if self = other, else `otherwise` (also for NaN).
    fn choose_equal(self, other: Self, then: Self, otherwise: Self) -> Self;

    /// Returns the larger number; `other` if either is NaN.
    fn larger(self, other: Self) -> Self;

    /// Returns the smaller number; `other` if either is NaN.
    fn smaller(self, other: Self) -> Self;
}

/// One double, with arithmetic `A`.
#[derive(Debug, Clone, Copy)]
pub struct One<A>(f64, PhantomData<A>);

/// Four doubles in SIMD lanes, with arithmetic `A`.
#[derive(Debug, Clone, Copy)]
pub struct Four<A>(F64x4, PhantomData<A>);

/// Eight singles in SIMD lanes, with arithmetic `A`.
#[derive(Debug, Clone, Copy)]
pub struct Eight<A>(F32x8, PhantomData<A>);

impl<A: Arithmetic> Real for One<A> {
    type Stored = f64;

    const LANES: usize = 1;

    #[inline(always)]
    fn of(stored: f64) -> Self {
        Self(stored, PhantomData)
    }

    #[inline(always)]
    fn stored(self) -> f64 {
        self.0
    }

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::of(value)
    }

    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self.0
    }

    #[inline(always)]
    fn with_lane(self, _lane: usize, value: f64) -> Self {
        Self::of(value)
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self::of(A::mul_add(self.0, factor.0, addend.0))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::of(self.0.sqrt())
    }

    #[inline(always)]
    fn choose_below(self, limit: Self, then: Self, otherwise: Self) -> Self {
        if self.0 < limit.0 { then } else { otherwise }
    }

    #[inline(always)]
    fn choose_equal(self, other: Self, then: Self, otherwise: Self) -> Self {
        if self.0 == other.0 { then } else { otherwise }
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::of(larger(self.0, other.0))
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::of(smaller(self.0, other.0))
    }
}

impl<A: Arithmetic> Real for Four<A> {
    type Stored = F64x4;

    const LANES: usize = 4;

    #[inline(always)]
    fn of(stored: F64x4) -> Self {
        Self(stored, PhantomData)
    }

    #[inline(always)]
    fn stored(self) -> F64x4 {
        self.0
    }

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::of(F64x4::splat(value))
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0.0[lane]
    }

    #[inline(always)]
    fn with_lane(mut self, lane: usize, value: f64) -> Self {
        self.0.0[lane] = value;
        self
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self::of(A::mul_add_x4(self.0, factor.0, addend.0))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::of(A::sqrt_x4(self.0))
    }

    #[inline(always)]
    fn choose_below(self, limit: Self, then: Self, otherwise: Self) -> Self {
        Self::of(A::choose_below_x4(self.0, limit.0, then.0, otherwise.0))
    }

    #[inline(always)]
    fn choose_equal(self, other: Self, then: Self, otherwise: Self) -> Self {
        Self::of(A::choose_equal_x4(self.0, other.0, then.0, otherwise.0))
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        other.choose_below(self, self, other)
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.choose_below(other, self, other)
    }
}

impl<A: Arithmetic> Real for Eight<A> {
    type Stored = F32x8;

    const LANES: usize = 8;

    #[inline(always)]
    fn of(stored: F32x8) -> Self {
        Self(stored, PhantomData)
    }

    #[inline(always)]
    fn stored(self) -> F32x8 {
        self.0
    }

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::of(F32x8::splat(value as f32))
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        f64::from(self.0.0[lane])
    }

    #[inline(always)]
    fn with_lane(mut self, lane: usize, value: f64) -> Self {
        self.0.0[lane] = value as f32;
        self
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self::of(A::mul_add_x8(self.0, factor.0, addend.0))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::of(A::sqrt_x8(self.0))
    }

    #[inline(always)]
    fn choose_below(self, limit: Self, then: Self, otherwise: Self) -> Self {
        Self::of(A::choose_below_x8(self.0, limit.0, then.0, otherwise.0))
    }

    #[inline(always)]
    fn choose_equal(self, other: Self, then: Self, otherwise: Self) -> Self {
        Self::of(A::choose_equal_x8(self.0, other.0, then.0, otherwise.0))
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::of(A::larger_x8(self.0, other.0))
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::of(A::smaller_x8(self.0, other.0))
    }
}

impl<A: Arithmetic> Eight<A> {
    /// Returns a bit mask of the lanes in which self >= limit does not hold (also for NaN).
    #[inline(always)]
    pub fn not_at_least(self, limit: Self) -> u32 {
        A::not_at_least_x8(self.0, limit.0)
    }
}

/// Implements `$operator`: for [`One`] by f64, for [`Four`] and [`Eight`] by the arithmetic.
macro_rules! operator {
    ($operator:ident, $method:ident, $of_four:ident, $of_eight:ident) => {
        impl<A: Arithmetic> $operator for One<A> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::of(self.0.$method(other.0))
            }
        }

        impl<A: Arithmetic> $operator for Four<A> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::of(A::$of_four(self.0, other.0))
            }
        }

        impl<A: Arithmetic> $operator for Eight<A> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::of(A::$of_eight(self.0, other.0))
            }
        }
    };
}

operator!(Add, add, add_x4, add_x8);
operator!(Sub, sub, sub_x4, sub_x8);
operator!(Mul, mul, mul_x4, mul_x8);
operator!(Div, div, div_x4, div_x8);

impl<A: Arithmetic> Neg for One<A> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::of(-self.0)
    }
}

impl<A: Arithmetic> Neg for Four<A> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::of(-self.0)
    }
}

impl<A: Arithmetic> Neg for Eight<A> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::of(-self.0)
    }
}
