//! Table of compiled kernels: one entry per padded number of stages, with and without AVX2 and FMA.

use super::chain::Chain;
use super::jacobian;
use super::link_frames;
use super::loop_kernels;
use super::tip;
use super::torques::{self, Wrench};
use crate::math::arithmetic::by_instructions;
use crate::math::f64x4::F64x4;
use crate::math::{Columns, Frame, STACK_DOF};

/// Kernels compiled for one padded number of stages and one instruction set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kernels {
    /// Returns the tip frame. Here and below `q` has one finite entry per independent joint.
    pub tip: fn(&Chain, &[f64]) -> Frame,
    /// Returns the tip position (m), at half the work.
    pub tip_position: fn(&Chain, &[f64]) -> [f64; 3],
    /// Returns the tip positions (m) at two configurations, by coordinate.
    tip_pair: fn(&Chain, &[f64]) -> [[f64; 2]; 3],
    /// Returns the tip positions (m) at four configurations, by coordinate.
    tip_four: fn(&Chain, &[f64]) -> [[f64; 4]; 3],
    /// Writes the geometric Jacobian and returns the tip frame.
    pub jacobian: fn(&Chain, &[f64], &mut Columns) -> Frame,
    /// Writes the joint torques J'w of a wrench w(tip) and returns the tip frame.
    pub torques: Torques,
    /// Writes the frames of all stages into a buffer of at least [`STACK_DOF`] + 1 entries.
    pub stage_frames: fn(&Chain, &[f64], &mut [Frame]),
    /// Writes the frames of all stages for four configurations, bit-identical to `stage_frames`.
    pub stage_frames_four: fn(&Chain, &[F64x4], &mut [Frame<F64x4>]),
}

type Torques = fn(&Chain, &[f64], &dyn Fn(&Frame) -> Wrench, &mut [f64]) -> Frame;

impl Kernels {
    /// Kernels for chains of any kind and length.
    const LOOPS: Self = Self {
        tip: loop_kernels::tip,
        tip_position: |chain, q| loop_kernels::tip(chain, q).origin,
        tip_pair: loop_kernels::tip_positions::<2>,
        tip_four: loop_kernels::tip_positions::<4>,
        jacobian: loop_kernels::jacobian,
        torques: loop_kernels::torques,
        stage_frames: loop_kernels::stage_frames,
        stage_frames_four: loop_kernels::stage_frames_four,
    };

    /// Returns the fastest kernels for this chain and machine.
    pub fn for_chain(chain: &Chain) -> Self {
        let is_compiled = chain.vector.is_none() && chain.curves.is_empty() && chain.moving <= STACK_DOF;
        if is_compiled { for_stages(chain.padded_stages()) } else { Self::LOOPS }
    }

    /// Calls `visit` with the tip position (m) at each of the configurations `qs`, stored consecutively with `n` entries
    /// each. Evaluates groups of four, then two; bit-identical to `tip_position`.
    #[inline]
    pub fn tip_positions(&self, chain: &Chain, mut qs: &[f64], n: usize, mut visit: impl FnMut([f64; 3])) {
        while let Some((group, rest)) = qs.split_at_checked(4 * n) {
            transposed((self.tip_four)(chain, group)).into_iter().for_each(&mut visit);
            qs = rest;
        }
        if let Some((group, rest)) = qs.split_at_checked(2 * n) {
            transposed((self.tip_pair)(chain, group)).into_iter().for_each(&mut visit);
            qs = rest;
        }
        if qs.len() == n {
            visit((self.tip_position)(chain, qs));
        }
    }
}

/// Transposes arrays of coordinates into an array of points. Kept out of the kernels, where it would make the compiler
/// vectorise along coordinates instead of lanes (27 ns per configuration instead of 17).
#[inline]
fn transposed<const W: usize>(coordinates: [[f64; W]; 3]) -> [[f64; 3]; W] {
    std::array::from_fn(|w| coordinates.map(|coordinate| coordinate[w]))
}

/// Expands `$table!(A, N, L)` for the size `$stages`: N stages, with sines padded to L.
macro_rules! for_each_size {
    ($stages:expr, $table:ident, $arithmetic:ty) => {
        match $stages {
            4 => $table!($arithmetic, 4, 4),
            5 => $table!($arithmetic, 5, 8),
            6 => $table!($arithmetic, 6, 8),
            7 => $table!($arithmetic, 7, 8),
            8 => $table!($arithmetic, 8, 8),
            12 => $table!($arithmetic, 12, 12),
            16 => $table!($arithmetic, 16, 16),
            _ => $table!($arithmetic, 32, 32),
        }
    };
}

/// Builds the kernels for N stages. Closures are compiled with the instructions of the enclosing function.
macro_rules! table {
    ($a:ty, $n:literal, $l:literal) => {
        Kernels {
            tip: |chain, q| tip::tip::<$a, $n, $l>(chain, q),
            tip_position: |chain, q| tip::tip_position::<$a, $n, $l>(chain, q),
            tip_pair: |chain, qs| tip::tip_positions::<$a, $n, $l, 2>(chain, qs),
            tip_four: |chain, qs| tip::tip_positions::<$a, $n, $n, 4>(chain, qs),
            jacobian: |chain, q, columns| jacobian::jacobian::<$a, $n, $l>(chain, q, columns),
            torques: |chain, q, wrench, torques| torques::torques::<$a, $n, $l>(chain, q, wrench, torques),
            stage_frames: |chain, q, reached| link_frames::stage_frames::<$a, $n, $l>(chain, q, reached),
            stage_frames_four: |chain, qs, reached| link_frames::four_stage_frames::<$a, $n>(chain, qs, reached),
        }
    };
}

by_instructions! {
    /// Returns the fastest kernels for this machine and a chain padded to `stages`.
    fn for_stages(stages: usize) -> Kernels {
        for_each_size!(stages, table, A)
    }
}

#[cfg(test)]
mod tests {
    use super::super::chain::{ChainFolder, SIZES, Transmission};
    use super::*;
    use crate::math::arithmetic::Baseline;
    use crate::math::{MAX_DOF, Pose, pose};
    use nalgebra::Vector3;

    /// Returns an arm with this many joints, every third of them prismatic, on axes of no special direction.
    fn arm(joints: usize) -> Chain {
        let mut arm = ChainFolder::new(&Pose::identity());
        for i in 0..joints {
            let x = i as f64;
            let motion = if i % 3 == 2 { Transmission::slide } else { Transmission::turn };
            arm.fixed(&pose::from_rpy([0.3 * x, 0.7 - x, 0.1], [0.1, 0.05 * x, 0.2]));
            arm.moving(&Vector3::new(x.sin(), 0.4, x.cos()).normalize(), motion(i, 1.0, 0.01 * x));
        }
        arm.finish(&pose::translation(0.0, 0.1, 0.2))
    }

    fn baseline(stages: usize) -> Kernels {
        for_each_size!(stages, table, Baseline)
    }

    #[test]
    fn four_side_by_side_are_what_each_is_alone_to_the_bit() {
        for joints in SIZES {
            let chain = arm(joints);
            for kernels in [for_stages(joints), baseline(joints)] {
                let angle = |joint: usize, lane: usize| (1.7 * joint as f64 + 0.9 * lane as f64).sin();
                let qs: Vec<F64x4> = (0..joints).map(|i| F64x4(std::array::from_fn(|lane| angle(i, lane)))).collect();
                let mut frames = [Frame::of([&Frame::IDENTITY; 4]); MAX_DOF + 1];
                (kernels.stage_frames_four)(&chain, &qs, &mut frames);
                for lane in 0..4 {
                    let q: Vec<f64> = qs.iter().map(|lanes| lanes.0[lane]).collect();
                    let mut reached = [Frame::IDENTITY; MAX_DOF + 1];
                    (kernels.stage_frames)(&chain, &q, &mut reached);
                    assert!((0..=joints).all(|i| frames[i].lane(lane) == reached[i]), "{joints} joints");
                }
            }
        }
    }

    #[test]
    fn machines_without_fma_get_the_same_kinematics() {
        for joints in SIZES {
            let chain = arm(joints);
            let (best, baseline) = (for_stages(joints), baseline(joints));
            let q: Vec<f64> = (0..joints).map(|i| (1.7 * i as f64).sin()).collect();
            let (mut columns, mut others) = (Columns::default(), Columns::default());
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
