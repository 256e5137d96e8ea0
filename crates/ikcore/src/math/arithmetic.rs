//! Multiply-add with or without the processor's fused instruction, chosen once per call of a kernel.
//!
//! Kernels are straight-line bodies over [`Arithmetic`]: one source, compiled portable and for machines with FMA.
//! Both are repeatable; they differ from each other in the last bit.

/// The one operation in which the two compilations of a kernel differ.
pub trait Arithmetic {
    /// a * b + c.
    fn mul_add(a: f64, b: f64, c: f64) -> f64;
}

/// Two roundings: runs anywhere.
#[derive(Debug, Clone, Copy)]
pub enum Separate {}

/// One rounding: quick only where the processor has the instruction.
#[derive(Debug, Clone, Copy)]
pub enum Fused {}

impl Arithmetic for Separate {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

impl Arithmetic for Fused {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

/// What every machine of this architecture runs quickly.
#[cfg(target_arch = "aarch64")]
pub type Baseline = Fused;
/// What every machine of this architecture runs quickly.
#[cfg(not(target_arch = "aarch64"))]
pub type Baseline = Separate;

/// Whether this machine runs the kernels compiled for AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub fn has_fused() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
}
