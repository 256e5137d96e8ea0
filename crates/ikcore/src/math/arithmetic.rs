//! Arithmetic with or without the processor's fused multiply-add and registers of four numbers, chosen once per call of a kernel.
//!
//! Kernels are straight-line bodies over [`Arithmetic`]: one source, compiled portable and for machines with AVX2 and FMA.
//! Both are repeatable; they differ from each other in the last bit.

use super::quad::Quad;

/// The operations in which the two compilations of a kernel differ.
pub trait Arithmetic: Copy {
    /// a * b + c.
    fn mul_add(a: f64, b: f64, c: f64) -> f64;

    /// a * b + c, lane by lane.
    #[inline(always)]
    fn mul_add_quad(a: Quad, b: Quad, c: Quad) -> Quad {
        Quad(std::array::from_fn(|k| Self::mul_add(a.0[k], b.0[k], c.0[k])))
    }

    /// a * b, lane by lane.
    #[inline(always)]
    fn mul_quad(a: Quad, b: Quad) -> Quad {
        Quad(std::array::from_fn(|k| a.0[k] * b.0[k]))
    }

    /// a + b, lane by lane.
    #[inline(always)]
    fn add_quad(a: Quad, b: Quad) -> Quad {
        Quad(std::array::from_fn(|k| a.0[k] + b.0[k]))
    }

    /// a - b, lane by lane.
    #[inline(always)]
    fn sub_quad(a: Quad, b: Quad) -> Quad {
        Quad(std::array::from_fn(|k| a.0[k] - b.0[k]))
    }

    /// a / b, lane by lane.
    #[inline(always)]
    fn div_quad(a: Quad, b: Quad) -> Quad {
        Quad(std::array::from_fn(|k| a.0[k] / b.0[k]))
    }

    /// The square root, lane by lane.
    #[inline(always)]
    fn sqrt_quad(a: Quad) -> Quad {
        Quad(a.0.map(f64::sqrt))
    }

    /// `then` where a < b, and `otherwise` elsewhere, NaN included, lane by lane.
    #[inline(always)]
    fn choose_below_quad(a: Quad, b: Quad, then: Quad, otherwise: Quad) -> Quad {
        Quad(std::array::from_fn(|k| if a.0[k] < b.0[k] { then.0[k] } else { otherwise.0[k] }))
    }

    /// `then` where a = b, and `otherwise` elsewhere, NaN included, lane by lane.
    #[inline(always)]
    fn choose_equal_quad(a: Quad, b: Quad, then: Quad, otherwise: Quad) -> Quad {
        Quad(std::array::from_fn(|k| if a.0[k] == b.0[k] { then.0[k] } else { otherwise.0[k] }))
    }
}

/// Two roundings: runs anywhere.
#[derive(Debug, Clone, Copy)]
pub enum Separate {}

/// One rounding: quick only where the processor has the instruction. On x86-64, for code that is compiled for AVX2 and FMA and
/// reached only where [`has_fused`] found them.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Fused {}

impl Arithmetic for Separate {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Arithmetic for Fused {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

#[cfg(target_arch = "x86_64")]
impl Arithmetic for Fused {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }

    #[inline(always)]
    fn mul_add_quad(a: Quad, b: Quad, c: Quad) -> Quad {
        // SAFETY (all eight): kernels over `Fused` and quads are reached only where `has_fused` found the instructions.
        from_register(unsafe { x86::_mm256_fmadd_pd(register(a), register(b), register(c)) })
    }

    #[inline(always)]
    fn mul_quad(a: Quad, b: Quad) -> Quad {
        from_register(unsafe { x86::_mm256_mul_pd(register(a), register(b)) })
    }

    #[inline(always)]
    fn add_quad(a: Quad, b: Quad) -> Quad {
        from_register(unsafe { x86::_mm256_add_pd(register(a), register(b)) })
    }

    #[inline(always)]
    fn sub_quad(a: Quad, b: Quad) -> Quad {
        from_register(unsafe { x86::_mm256_sub_pd(register(a), register(b)) })
    }

    #[inline(always)]
    fn div_quad(a: Quad, b: Quad) -> Quad {
        from_register(unsafe { x86::_mm256_div_pd(register(a), register(b)) })
    }

    #[inline(always)]
    fn sqrt_quad(a: Quad) -> Quad {
        from_register(unsafe { x86::_mm256_sqrt_pd(register(a)) })
    }

    #[inline(always)]
    fn choose_below_quad(a: Quad, b: Quad, then: Quad, otherwise: Quad) -> Quad {
        from_register(unsafe {
            let smaller = x86::_mm256_cmp_pd::<{ x86::_CMP_LT_OQ }>(register(a), register(b));
            x86::_mm256_blendv_pd(register(otherwise), register(then), smaller)
        })
    }

    #[inline(always)]
    fn choose_equal_quad(a: Quad, b: Quad, then: Quad, otherwise: Quad) -> Quad {
        from_register(unsafe {
            let equal = x86::_mm256_cmp_pd::<{ x86::_CMP_EQ_OQ }>(register(a), register(b));
            x86::_mm256_blendv_pd(register(otherwise), register(then), equal)
        })
    }
}

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64 as x86;

#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn register(quad: Quad) -> x86::__m256d {
    // SAFETY: both are four f64 in 32 bytes, and any bits are a value of either.
    unsafe { std::mem::transmute(quad) }
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn from_register(register: x86::__m256d) -> Quad {
    // SAFETY: as in `register`.
    unsafe { std::mem::transmute(register) }
}

/// What every machine of this architecture runs quickly.
#[cfg(target_arch = "aarch64")]
pub(crate) type Baseline = Fused;
/// What every machine of this architecture runs quickly.
#[cfg(not(target_arch = "aarch64"))]
pub(crate) type Baseline = Separate;

/// Whether this machine runs the kernels compiled for AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub fn has_fused() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
}
