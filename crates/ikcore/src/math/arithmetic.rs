//! Arithmetic with or without the processor's fused multiply-add (FMA) and wide registers.
//!
//! Kernels are straight-line bodies over [`Arithmetic`]: one source, compiled portably and for machines with AVX2 and FMA by
//! [`by_instructions`]. Both versions are repeatable; they differ in the last bit.

#![allow(unsafe_code, reason = "instructions of the processor are unsafe functions")]

use super::f32x8::F32x8;
use super::f64x4::F64x4;

/// Operations in which the two versions of a kernel differ.
pub trait Arithmetic: Copy {
    /// Returns a * b + c.
    fn mul_add(a: f64, b: f64, c: f64) -> f64;

    /// Returns a * b + c, lane by lane.
    #[inline(always)]
    fn mul_add_x4(a: F64x4, b: F64x4, c: F64x4) -> F64x4 {
        F64x4(std::array::from_fn(|k| Self::mul_add(a.0[k], b.0[k], c.0[k])))
    }

    /// Returns a * b, lane by lane.
    #[inline(always)]
    fn mul_x4(a: F64x4, b: F64x4) -> F64x4 {
        F64x4(std::array::from_fn(|k| a.0[k] * b.0[k]))
    }

    /// Returns a + b, lane by lane.
    #[inline(always)]
    fn add_x4(a: F64x4, b: F64x4) -> F64x4 {
        F64x4(std::array::from_fn(|k| a.0[k] + b.0[k]))
    }

    /// Returns the cross product of two vectors in the first three lanes.
    #[inline(always)]
    fn cross_x4(a: F64x4, b: F64x4) -> F64x4 {
        // Identity a x b = P (a * Pb - Pa * b), entry by entry, with the cyclic permutation P.
        let product = Self::mul_x4(a.permuted(), b);
        Self::mul_add_x4(a, b.permuted(), -product).permuted()
    }

    /// Returns a - b, lane by lane.
    #[inline(always)]
    fn sub_x4(a: F64x4, b: F64x4) -> F64x4 {
        F64x4(std::array::from_fn(|k| a.0[k] - b.0[k]))
    }

    /// Returns a / b, lane by lane.
    #[inline(always)]
    fn div_x4(a: F64x4, b: F64x4) -> F64x4 {
        F64x4(std::array::from_fn(|k| a.0[k] / b.0[k]))
    }

    /// Returns the square root, lane by lane.
    #[inline(always)]
    fn sqrt_x4(a: F64x4) -> F64x4 {
        F64x4(a.0.map(f64::sqrt))
    }

    /// Selects `then` in lanes with a < b, else `otherwise` (also for NaN).
    #[inline(always)]
    fn choose_below_x4(a: F64x4, b: F64x4, then: F64x4, otherwise: F64x4) -> F64x4 {
        F64x4(std::array::from_fn(|k| if a.0[k] < b.0[k] { then.0[k] } else { otherwise.0[k] }))
    }

    /// Selects `then` in lanes with a = b, else `otherwise` (also for NaN).
    #[inline(always)]
    fn choose_equal_x4(a: F64x4, b: F64x4, then: F64x4, otherwise: F64x4) -> F64x4 {
        F64x4(std::array::from_fn(|k| if a.0[k] == b.0[k] { then.0[k] } else { otherwise.0[k] }))
    }

    /// Returns a * b + c, lane by lane.
    #[inline(always)]
    fn mul_add_x8(a: F32x8, b: F32x8, c: F32x8) -> F32x8 {
        F32x8(std::array::from_fn(|k| a.0[k] * b.0[k] + c.0[k]))
    }

    /// Returns a * b, lane by lane.
    #[inline(always)]
    fn mul_x8(a: F32x8, b: F32x8) -> F32x8 {
        F32x8(std::array::from_fn(|k| a.0[k] * b.0[k]))
    }

    /// Returns a + b, lane by lane.
    #[inline(always)]
    fn add_x8(a: F32x8, b: F32x8) -> F32x8 {
        F32x8(std::array::from_fn(|k| a.0[k] + b.0[k]))
    }

    /// Returns a - b, lane by lane.
    #[inline(always)]
    fn sub_x8(a: F32x8, b: F32x8) -> F32x8 {
        F32x8(std::array::from_fn(|k| a.0[k] - b.0[k]))
    }

    /// Returns a / b, lane by lane.
    #[inline(always)]
    fn div_x8(a: F32x8, b: F32x8) -> F32x8 {
        F32x8(std::array::from_fn(|k| a.0[k] / b.0[k]))
    }

    /// Returns the square root, lane by lane.
    #[inline(always)]
    fn sqrt_x8(a: F32x8) -> F32x8 {
        F32x8(a.0.map(f32::sqrt))
    }

    /// Selects `then` in lanes with a < b, else `otherwise` (also for NaN).
    #[inline(always)]
    fn choose_below_x8(a: F32x8, b: F32x8, then: F32x8, otherwise: F32x8) -> F32x8 {
        F32x8(std::array::from_fn(|k| if a.0[k] < b.0[k] { then.0[k] } else { otherwise.0[k] }))
    }

    /// Selects `then` in lanes with a = b, else `otherwise` (also for NaN).
    #[inline(always)]
    fn choose_equal_x8(a: F32x8, b: F32x8, then: F32x8, otherwise: F32x8) -> F32x8 {
        F32x8(std::array::from_fn(|k| if a.0[k] == b.0[k] { then.0[k] } else { otherwise.0[k] }))
    }

    /// Returns the larger of a and b, lane by lane; b if either is NaN.
    #[inline(always)]
    fn larger_x8(a: F32x8, b: F32x8) -> F32x8 {
        Self::choose_below_x8(b, a, a, b)
    }

    /// Returns the smaller of a and b, lane by lane; b if either is NaN.
    #[inline(always)]
    fn smaller_x8(a: F32x8, b: F32x8) -> F32x8 {
        Self::choose_below_x8(a, b, a, b)
    }

    /// Returns a bit mask of the lanes in which a >= b does not hold (also for NaN).
    #[inline(always)]
    fn not_at_least_x8(a: F32x8, b: F32x8) -> u32 {
        (0..8).fold(0, |lanes, k| lanes | (u32::from(!(a.0[k] >= b.0[k])) << k))
    }
}

/// Arithmetic without FMA: product and sum are rounded separately. Runs on any machine.
#[derive(Debug, Clone, Copy)]
pub enum NoFma {}

/// Arithmetic with FMA: product and sum are rounded once. Fast only if the processor has the instruction; on x86-64 only for
/// code inside [`by_instructions`], which is compiled for AVX2 and FMA.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Fma {}

impl Arithmetic for NoFma {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Arithmetic for Fma {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

// SAFETY of all blocks: code over `Fma` runs only where `has_fma` found the instructions.
#[allow(clippy::undocumented_unsafe_blocks, reason = "the comment above is that of all blocks")]
#[cfg(target_arch = "x86_64")]
impl Arithmetic for Fma {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }

    #[inline(always)]
    fn mul_add_x4(a: F64x4, b: F64x4, c: F64x4) -> F64x4 {
        from_register(unsafe { x86::_mm256_fmadd_pd(register(a), register(b), register(c)) })
    }

    #[inline(always)]
    fn mul_x4(a: F64x4, b: F64x4) -> F64x4 {
        from_register(unsafe { x86::_mm256_mul_pd(register(a), register(b)) })
    }

    #[inline(always)]
    fn add_x4(a: F64x4, b: F64x4) -> F64x4 {
        from_register(unsafe { x86::_mm256_add_pd(register(a), register(b)) })
    }

    #[inline(always)]
    fn sub_x4(a: F64x4, b: F64x4) -> F64x4 {
        from_register(unsafe { x86::_mm256_sub_pd(register(a), register(b)) })
    }

    #[inline(always)]
    fn div_x4(a: F64x4, b: F64x4) -> F64x4 {
        from_register(unsafe { x86::_mm256_div_pd(register(a), register(b)) })
    }

    #[inline(always)]
    fn sqrt_x4(a: F64x4) -> F64x4 {
        from_register(unsafe { x86::_mm256_sqrt_pd(register(a)) })
    }

    #[inline(always)]
    fn choose_below_x4(a: F64x4, b: F64x4, then: F64x4, otherwise: F64x4) -> F64x4 {
        from_register(unsafe {
            let smaller = x86::_mm256_cmp_pd::<{ x86::_CMP_LT_OQ }>(register(a), register(b));
            x86::_mm256_blendv_pd(register(otherwise), register(then), smaller)
        })
    }

    #[inline(always)]
    fn choose_equal_x4(a: F64x4, b: F64x4, then: F64x4, otherwise: F64x4) -> F64x4 {
        from_register(unsafe {
            let equal = x86::_mm256_cmp_pd::<{ x86::_CMP_EQ_OQ }>(register(a), register(b));
            x86::_mm256_blendv_pd(register(otherwise), register(then), equal)
        })
    }

    #[inline(always)]
    fn mul_add_x8(a: F32x8, b: F32x8, c: F32x8) -> F32x8 {
        from_singles(unsafe { x86::_mm256_fmadd_ps(singles(a), singles(b), singles(c)) })
    }

    #[inline(always)]
    fn mul_x8(a: F32x8, b: F32x8) -> F32x8 {
        from_singles(unsafe { x86::_mm256_mul_ps(singles(a), singles(b)) })
    }

    #[inline(always)]
    fn add_x8(a: F32x8, b: F32x8) -> F32x8 {
        from_singles(unsafe { x86::_mm256_add_ps(singles(a), singles(b)) })
    }

    #[inline(always)]
    fn sub_x8(a: F32x8, b: F32x8) -> F32x8 {
        from_singles(unsafe { x86::_mm256_sub_ps(singles(a), singles(b)) })
    }

    #[inline(always)]
    fn div_x8(a: F32x8, b: F32x8) -> F32x8 {
        from_singles(unsafe { x86::_mm256_div_ps(singles(a), singles(b)) })
    }

    #[inline(always)]
    fn sqrt_x8(a: F32x8) -> F32x8 {
        from_singles(unsafe { x86::_mm256_sqrt_ps(singles(a)) })
    }

    #[inline(always)]
    fn choose_below_x8(a: F32x8, b: F32x8, then: F32x8, otherwise: F32x8) -> F32x8 {
        from_singles(unsafe {
            let smaller = x86::_mm256_cmp_ps::<{ x86::_CMP_LT_OQ }>(singles(a), singles(b));
            x86::_mm256_blendv_ps(singles(otherwise), singles(then), smaller)
        })
    }

    #[inline(always)]
    fn choose_equal_x8(a: F32x8, b: F32x8, then: F32x8, otherwise: F32x8) -> F32x8 {
        from_singles(unsafe {
            let equal = x86::_mm256_cmp_ps::<{ x86::_CMP_EQ_OQ }>(singles(a), singles(b));
            x86::_mm256_blendv_ps(singles(otherwise), singles(then), equal)
        })
    }

    #[inline(always)]
    fn larger_x8(a: F32x8, b: F32x8) -> F32x8 {
        from_singles(unsafe { x86::_mm256_max_ps(singles(a), singles(b)) })
    }

    #[inline(always)]
    fn smaller_x8(a: F32x8, b: F32x8) -> F32x8 {
        from_singles(unsafe { x86::_mm256_min_ps(singles(a), singles(b)) })
    }

    #[inline(always)]
    fn not_at_least_x8(a: F32x8, b: F32x8) -> u32 {
        let below =
            unsafe { x86::_mm256_movemask_ps(x86::_mm256_cmp_ps::<{ x86::_CMP_NGE_UQ }>(singles(a), singles(b))) };
        below.cast_unsigned()
    }
}

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64 as x86;

#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn register(lanes: F64x4) -> x86::__m256d {
    // SAFETY: both are four f64 in 32 bytes, and any bits are a value of either.
    unsafe { std::mem::transmute(lanes) }
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn from_register(register: x86::__m256d) -> F64x4 {
    // SAFETY: as in `register`.
    unsafe { std::mem::transmute(register) }
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn singles(lanes: F32x8) -> x86::__m256 {
    // SAFETY: both are eight f32 in 32 bytes, and any bits are a value of either.
    unsafe { std::mem::transmute(lanes) }
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn from_singles(register: x86::__m256) -> F32x8 {
    // SAFETY: as in `singles`.
    unsafe { std::mem::transmute(register) }
}

/// Fastest arithmetic available on every machine of this architecture.
#[cfg(target_arch = "aarch64")]
pub(crate) type Baseline = Fma;
/// Fastest arithmetic available on every machine of this architecture.
#[cfg(not(target_arch = "aarch64"))]
pub(crate) type Baseline = NoFma;

/// Whether this machine has AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn has_fma() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
}

/// Names the instruction set that the kernels use on this machine.
pub fn instructions() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    if has_fma() {
        return "AVX2 and FMA";
    }
    if cfg!(target_arch = "aarch64") { "NEON" } else { "baseline" }
}

/// Compiles a function twice, for any machine of the architecture and for AVX2 with FMA, and calls the version for this
/// machine. It may have one generic parameter. In the body `A` is the [`Arithmetic`]. Functions called by the body must be `#[inline(always)]`, or closures
/// inside the body, to be compiled with its instructions.
macro_rules! by_instructions {
    ($(#[$attribute:meta])* $visibility:vis fn $name:ident<const $size:ident: usize> $($rest:tt)*) => {
        $crate::math::arithmetic::by_instructions! {
            @[const $size: usize] $(#[$attribute])* $visibility fn $name $($rest)*
        }
    };
    ($(#[$attribute:meta])* $visibility:vis fn $name:ident<$generic:ident $(: $bound:ident)?> $($rest:tt)*) => {
        $crate::math::arithmetic::by_instructions! {
            @[$generic $(: $bound)?] $(#[$attribute])* $visibility fn $name $($rest)*
        }
    };
    ($(#[$attribute:meta])* $visibility:vis fn $($rest:tt)*) => {
        $crate::math::arithmetic::by_instructions! { @[] $(#[$attribute])* $visibility fn $($rest)* }
    };
    (
        @[$($generics:tt)*] $(#[$attribute:meta])*
        $visibility:vis fn $name:ident($($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)? $body:block
    ) => {
        $(#[$attribute])*
        $visibility fn $name<$($generics)*>($($argument: $type),*) $(-> $result)? {
            #[cfg(target_arch = "x86_64")]
            if $crate::math::arithmetic::has_fma() {
                #[target_feature(enable = "avx2,fma")]
                fn with_fma<$($generics)*>($($argument: $type),*) $(-> $result)? {
                    #[allow(dead_code, reason = "some bodies have no arithmetic of their own")]
                    type A = $crate::math::arithmetic::Fma;
                    $body
                }
                // SAFETY: `has_fma` found the instructions.
                #[allow(unsafe_code, reason = "`has_fma` is true here")]
                return unsafe { with_fma($($argument),*) };
            }
            #[allow(dead_code, reason = "some bodies have no arithmetic of their own")]
            type A = $crate::math::arithmetic::Baseline;
            $body
        }
    };
}
pub(crate) use by_instructions;

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of all magnitudes, including special values.
    const A: [f64; 8] = [1.5, -0.0, f64::NAN, 1e300, -7.25, f64::INFINITY, 3.0, -1e-300];
    const B: [f64; 8] = [2.5, 0.0, 1.0, -1e300, f64::NAN, 2.0, 3.0, 4.0];
    const C: [f64; 8] = [0.1, -4.0, 2.0, 1e300, 1.0, f64::NEG_INFINITY, -9.0, 1e-300];

    by_instructions! {
        /// Performs every operation on four doubles and on eight singles.
        fn every_operation(a: &[f64; 8], b: &[f64; 8], c: &[f64; 8]) -> (Vec<f64>, Vec<f32>, u32) {
            operations::<A>(a, b, c)
        }
    }

    #[inline(always)]
    fn operations<A: Arithmetic>(a: &[f64; 8], b: &[f64; 8], c: &[f64; 8]) -> (Vec<f64>, Vec<f32>, u32) {
        let mut doubles = Vec::new();
        for half in [0, 4] {
            let [a, b, c] = [a, b, c].map(|lanes| F64x4(std::array::from_fn(|k| lanes[half + k])));
            let results = [
                A::mul_x4(a, b),
                A::add_x4(a, b),
                A::sub_x4(a, b),
                A::div_x4(a, b),
                A::sqrt_x4(a),
                A::choose_below_x4(a, b, c, a),
                A::choose_equal_x4(a, b, c, a),
                A::mul_add_x4(a, b, c),
            ];
            doubles.extend(results.iter().flat_map(|lanes| lanes.0));
        }
        let [a, b, c] = [a, b, c].map(|lanes| F32x8(lanes.map(|number| number as f32)));
        let results = [
            A::mul_x8(a, b),
            A::add_x8(a, b),
            A::sub_x8(a, b),
            A::div_x8(a, b),
            A::sqrt_x8(a),
            A::choose_below_x8(a, b, c, a),
            A::choose_equal_x8(a, b, c, a),
            A::larger_x8(a, b),
            A::smaller_x8(a, b),
            A::mul_add_x8(a, b, c),
        ];
        (doubles, results.iter().flat_map(|lanes| lanes.0).collect(), A::not_at_least_x8(a, b))
    }

    #[test]
    fn both_compilations_of_a_kernel_agree() {
        let (doubles, singles, lanes) = every_operation(&A, &B, &C);
        let (plain_doubles, plain_singles, plain_lanes) = operations::<NoFma>(&A, &B, &C);
        let same = |a: f64, b: f64| a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= 1e-15 * b.abs();
        assert!(doubles.iter().zip(&plain_doubles).all(|(a, b)| same(*a, *b)), "{doubles:?} {plain_doubles:?}");
        let same = |a: f32, b: f32| a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= 1e-6 * b.abs();
        assert!(singles.iter().zip(&plain_singles).all(|(a, b)| same(*a, *b)), "{singles:?} {plain_singles:?}");
        assert_eq!(lanes, plain_lanes);
    }
}
