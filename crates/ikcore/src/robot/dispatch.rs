//! Which compilation of the kernels a chain runs: one table for every padded number of stages
//! ([`SIZES`](super::chain::SIZES)), for machines with and without AVX2 and FMA.

use super::chain::Chain;
use super::kinematics::{self, Columns, StageFrames};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
#[cfg(target_arch = "x86_64")]
use crate::math::arithmetic::{Fused, has_fused};

/// `$table!(N, L)` for the size that `$stages` is: N stages, their sines padded to L.
macro_rules! for_each_size {
    ($stages:expr, $table:ident) => {
        match $stages {
            4 => $table!(4, 4),
            5 => $table!(5, 8),
            6 => $table!(6, 8),
            7 => $table!(7, 8),
            8 => $table!(8, 8),
            12 => $table!(12, 12),
            16 => $table!(16, 16),
            _ => $table!(32, 32),
        }
    };
}

/// A table of kernels for the instructions that every machine of this architecture has.
macro_rules! baseline {
    ($n:literal, $l:literal) => {
        Kernels {
            tip: kinematics::tip::<Baseline, $n, $l>,
            tip_position: kinematics::tip_position::<Baseline, $n, $l>,
            tip_pair: kinematics::side_by_side::<Baseline, $n, $l, 2>,
            tip_four: kinematics::side_by_side::<Baseline, $n, $n, 4>,
            jacobian: kinematics::jacobian::<Baseline, $n, $l>,
            stage_frames: kinematics::stage_frames::<Baseline, $n, $l>,
        }
    };
}

/// The same for machines that have AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
macro_rules! fused {
    ($n:literal, $l:literal) => {
        // SAFETY (all six): the table is handed out only where `has_fused` found the instructions.
        Kernels {
            tip: |chain, q| unsafe { fused::tip::<$n, $l>(chain, q) },
            tip_position: |chain, q| unsafe { fused::tip_position::<$n, $l>(chain, q) },
            tip_pair: |chain, qs| unsafe { fused::side_by_side::<$n, $l, 2>(chain, qs) },
            tip_four: |chain, qs| unsafe { fused::side_by_side::<$n, $n, 4>(chain, qs) },
            jacobian: |chain, q, columns| unsafe { fused::jacobian::<$n, $l>(chain, q, columns) },
            stage_frames: |chain, q, reached| unsafe { fused::stage_frames::<$n, $l>(chain, q, reached) },
        }
    };
}

/// The kernels compiled for one padded number of stages and one instruction set; a chain chooses when it is built.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kernels {
    pub tip: fn(&Chain, &[f64]) -> Frame,
    pub tip_position: fn(&Chain, &[f64]) -> [f64; 3],
    pub tip_pair: fn(&Chain, &[f64]) -> [[f64; 2]; 3],
    pub tip_four: fn(&Chain, &[f64]) -> [[f64; 4]; 3],
    pub jacobian: fn(&Chain, &[f64], &mut Columns) -> Frame,
    pub stage_frames: fn(&Chain, &[f64], &mut StageFrames),
}

impl Kernels {
    /// The fastest that this machine runs, for a chain padded to `stages` (one of [`SIZES`](super::chain::SIZES)).
    pub fn for_stages(stages: usize) -> Self {
        #[cfg(target_arch = "x86_64")]
        if has_fused() {
            return for_each_size!(stages, fused);
        }
        for_each_size!(stages, baseline)
    }
}

/// The kernels compiled for AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
mod fused {
    use super::{Chain, Columns, Frame, Fused, StageFrames, kinematics};

    #[target_feature(enable = "avx2,fma")]
    pub fn tip<const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> Frame {
        kinematics::tip::<Fused, N, L>(chain, q)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn tip_position<const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> [f64; 3] {
        kinematics::tip_position::<Fused, N, L>(chain, q)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn side_by_side<const N: usize, const L: usize, const W: usize>(chain: &Chain, qs: &[f64]) -> [[f64; W]; 3] {
        kinematics::side_by_side::<Fused, N, L, W>(chain, qs)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn jacobian<const N: usize, const L: usize>(chain: &Chain, q: &[f64], columns: &mut Columns) -> Frame {
        kinematics::jacobian::<Fused, N, L>(chain, q, columns)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn stage_frames<const N: usize, const L: usize>(chain: &Chain, q: &[f64], reached: &mut StageFrames) {
        kinematics::stage_frames::<Fused, N, L>(chain, q, reached);
    }
}
