//! Which compilation of the kernels a chain runs: one table for every padded number of stages
//! ([`SIZES`](super::chain::SIZES)), for machines with and without AVX2 and FMA.

use super::chain::Chain;
use super::forward::{self, Columns, StageFrames, Wrench};
use super::four_jacobians::{self, FourColumns};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
#[cfg(target_arch = "x86_64")]
use crate::math::arithmetic::{Fused, has_fused};
use crate::math::four_frames::FourFrames;
use crate::math::quad::Quad;

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
            tip: forward::tip::<Baseline, $n, $l>,
            tip_position: forward::tip_position::<Baseline, $n, $l>,
            tip_pair: forward::side_by_side::<Baseline, $n, $l, 2>,
            tip_four: forward::side_by_side::<Baseline, $n, $n, 4>,
            jacobian: forward::jacobian::<Baseline, $n, $l>,
            jacobian_four: four_jacobians::jacobian::<Baseline, $n>,
            torques: forward::torques::<Baseline, $n, $l>,
            stage_frames: forward::stage_frames::<Baseline, $n, $l>,
        }
    };
}

/// The same for machines that have AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
macro_rules! fused {
    ($n:literal, $l:literal) => {
        // SAFETY (all eight): the table is handed out only where `has_fused` found the instructions.
        Kernels {
            tip: |chain, q| unsafe { fused::tip::<$n, $l>(chain, q) },
            tip_position: |chain, q| unsafe { fused::tip_position::<$n, $l>(chain, q) },
            tip_pair: |chain, qs| unsafe { fused::side_by_side::<$n, $l, 2>(chain, qs) },
            tip_four: |chain, qs| unsafe { fused::side_by_side::<$n, $n, 4>(chain, qs) },
            jacobian: |chain, q, columns| unsafe { fused::jacobian::<$n, $l>(chain, q, columns) },
            jacobian_four: |chain, qs, columns| unsafe { fused::jacobian_four::<$n>(chain, qs, columns) },
            torques: |chain, q, pull, torques| unsafe { fused::torques::<$n, $l>(chain, q, pull, torques) },
            stage_frames: |chain, q, reached| unsafe { fused::stage_frames::<$n, $l>(chain, q, reached) },
        }
    };
}

/// What the joints feel of the wrench that is said of the tip.
type Torques = fn(&Chain, &[f64], &dyn Fn(&Frame) -> Wrench, &mut [f64]) -> Frame;

/// The kernels compiled for one padded number of stages and one instruction set; a chain chooses when it is built.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kernels {
    pub tip: fn(&Chain, &[f64]) -> Frame,
    pub tip_position: fn(&Chain, &[f64]) -> [f64; 3],
    pub tip_pair: fn(&Chain, &[f64]) -> [[f64; 2]; 3],
    pub tip_four: fn(&Chain, &[f64]) -> [[f64; 4]; 3],
    pub jacobian: fn(&Chain, &[f64], &mut Columns) -> Frame,
    pub jacobian_four: fn(&Chain, &[Quad], &mut FourColumns) -> FourFrames,
    pub torques: Torques,
    pub stage_frames: fn(&Chain, &[f64], &mut StageFrames),
}

impl Kernels {
    /// The fastest that this machine runs, for a chain padded to `stages` (one of [`SIZES`](super::chain::SIZES)).
    pub fn for_stages(stages: usize) -> Self {
        #[cfg(target_arch = "x86_64")]
        if has_fused() {
            return for_each_size!(stages, fused);
        }
        Self::baseline_for(stages)
    }

    /// Those for machines without AVX2 and FMA.
    fn baseline_for(stages: usize) -> Self {
        for_each_size!(stages, baseline)
    }
}

/// The kernels compiled for AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
mod fused {
    use super::{Chain, Columns, FourColumns, FourFrames, Frame, Fused, Quad, StageFrames, Wrench};
    use super::{forward, four_jacobians};

    #[target_feature(enable = "avx2,fma")]
    pub fn tip<const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> Frame {
        forward::tip::<Fused, N, L>(chain, q)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn tip_position<const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> [f64; 3] {
        forward::tip_position::<Fused, N, L>(chain, q)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn side_by_side<const N: usize, const L: usize, const W: usize>(chain: &Chain, qs: &[f64]) -> [[f64; W]; 3] {
        forward::side_by_side::<Fused, N, L, W>(chain, qs)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn jacobian<const N: usize, const L: usize>(chain: &Chain, q: &[f64], columns: &mut Columns) -> Frame {
        forward::jacobian::<Fused, N, L>(chain, q, columns)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn jacobian_four<const N: usize>(chain: &Chain, qs: &[Quad], columns: &mut FourColumns) -> FourFrames {
        four_jacobians::jacobian::<Fused, N>(chain, qs, columns)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn torques<const N: usize, const L: usize>(
        chain: &Chain,
        q: &[f64],
        pull: &dyn Fn(&Frame) -> Wrench,
        torques: &mut [f64],
    ) -> Frame {
        forward::torques::<Fused, N, L>(chain, q, pull, torques)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn stage_frames<const N: usize, const L: usize>(chain: &Chain, q: &[f64], reached: &mut StageFrames) {
        forward::stage_frames::<Fused, N, L>(chain, q, reached);
    }
}

#[cfg(test)]
mod tests {
    use super::super::chain::SIZES;
    use super::*;
    use crate::math::MAX_DOF;
    use crate::math::{Pose, pose};
    use crate::robot::{ChainBuilder, Drive, Joint, JointKind};
    use nalgebra::Vector3;

    /// An arm of so many joints, every third of them sliding, on axes of no special direction.
    fn arm(joints: usize) -> Chain {
        let mut arm = ChainBuilder::new("arm", "base");
        for i in 0..joints {
            let kind = if i % 3 == 2 { JointKind::Prismatic } else { JointKind::Revolute };
            let joint = arm.add_joint(Joint::new(format!("joint {i}"), kind));
            let x = i as f64;
            arm.fixed(pose::from_rpy([0.3 * x, 0.7 - x, 0.1], [0.1, 0.05 * x, 0.2]));
            arm.moving(joint, kind, Vector3::new(x.sin(), 0.4, x.cos()), Drive { scale: 1.0, offset: 0.01 * x });
        }
        Chain::new(&arm.elements, &Pose::identity(), &pose::translation(0.0, 0.1, 0.2))
    }

    #[test]
    fn four_side_by_side_are_what_each_is_alone_to_the_bit() {
        for joints in SIZES {
            let chain = arm(joints);
            for kernels in [Kernels::for_stages(joints), Kernels::baseline_for(joints)] {
                let angle = |joint: usize, lane: usize| (1.7 * joint as f64 + 0.9 * lane as f64).sin();
                let qs: Vec<Quad> = (0..joints).map(|i| Quad(std::array::from_fn(|lane| angle(i, lane)))).collect();
                let mut four = vec![[Quad::ZERO; 6]; joints];
                let tips = (kernels.jacobian_four)(&chain, &qs, &mut four);
                for lane in 0..4 {
                    let q: Vec<f64> = qs.iter().map(|lanes| lanes.0[lane]).collect();
                    let mut columns = [[0.0; 6]; MAX_DOF];
                    let tip = (kernels.jacobian)(&chain, &q, &mut columns);
                    assert_eq!(tips.axes.map(|axis| axis.map(|k| k.0[lane])), tip.axes, "{joints} joints");
                    assert_eq!(tips.origin.map(|k| k.0[lane]), tip.origin, "{joints} joints");
                    let column = |j: usize| four[j].map(|row| row.0[lane]);
                    assert!((0..joints).all(|j| column(j) == columns[j]), "{joints} joints");
                }
            }
        }
    }

    #[test]
    fn machines_without_fma_get_the_same_kinematics() {
        for joints in SIZES {
            let chain = arm(joints);
            let (best, baseline) = (Kernels::for_stages(joints), Kernels::baseline_for(joints));
            let q: Vec<f64> = (0..joints).map(|i| (1.7 * i as f64).sin()).collect();
            let (mut columns, mut others) = ([[0.0; 6]; MAX_DOF], [[0.0; 6]; MAX_DOF]);
            let tip = (best.jacobian)(&chain, &q, &mut columns);
            let other = (baseline.jacobian)(&chain, &q, &mut others);
            let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
            assert!(near(tip.axes.as_flattened(), other.axes.as_flattened()), "{joints} joints");
            assert!(near(&tip.origin, &other.origin), "{joints} joints");
            assert!(near(columns.as_flattened(), others.as_flattened()), "{joints} joints");
            let wrench = [0.3, -1.0, 2.0, 0.5, 0.7, -0.2];
            let (mut torques, mut theirs) = (vec![0.0; joints], vec![0.0; joints]);
            (best.torques)(&chain, &q, &|_| wrench, &mut torques);
            (baseline.torques)(&chain, &q, &|_| wrench, &mut theirs);
            let work = |column: &[f64; 6]| column.iter().zip(wrench).map(|(c, w)| c * w).sum::<f64>();
            assert!(near(&torques, &columns.iter().take(joints).map(work).collect::<Vec<_>>()), "{joints} joints");
            assert!(near(&torques, &theirs), "{joints} joints");
            assert!(near(&(baseline.tip_position)(&chain, &q), &tip.origin), "{joints} joints");
            assert!(near(&(baseline.tip)(&chain, &q).origin, &tip.origin), "{joints} joints");
            let four = (baseline.tip_four)(&chain, &q.repeat(4));
            assert_eq!(four.map(|lane| lane[3]), (baseline.tip_position)(&chain, &q), "{joints} joints");
            assert_eq!((baseline.tip_pair)(&chain, &q.repeat(2)).map(|lane| lane[1]), four.map(|lane| lane[0]));
        }
    }
}
