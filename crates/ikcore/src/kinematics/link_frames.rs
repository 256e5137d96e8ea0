//! Frames of all stages and links.

use super::chain::Chain;
use super::forward_pass::forward_pass;
use super::four_forward_pass::four_forward_pass;
use crate::math::arithmetic::{Arithmetic, NoFma};
use crate::math::f64x4::F64x4;
use crate::math::{Frame, MAX_DOF};

/// Frames reached after 0, 1, 2, ... stages.
pub(crate) type StageFrames<T = f64> = [Frame<T>; MAX_DOF + 1];

/// Writes the frame that each stage moves into `reached`, from entry 1 on.
#[inline(always)]
pub(super) fn stage_frames<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    reached: &mut StageFrames,
) {
    forward_pass::<A, N, L>(chain, q, |i, frame| reached[i + 1] = Frame::from(*frame));
}

/// [`stage_frames`] of four configurations at once, bit-identical; `qs` has one entry per joint.
#[inline(always)]
pub(super) fn four_stage_frames<A: Arithmetic, const N: usize>(
    chain: &Chain,
    qs: &[F64x4],
    reached: &mut StageFrames<F64x4>,
) {
    four_forward_pass::<A, N>(chain, qs, |i, frame| reached[i + 1] = frame.stored());
}

/// The frame of every link of `chain`, base to tip, with its stages at `reached`.
pub(crate) fn link_frames(chain: &Chain, reached: &StageFrames) -> Vec<Frame> {
    chain.links.iter().map(|link| reached[link.stages].then::<NoFma>(&link.offset)).collect()
}
