//! Frames of all stages and links.

use super::chain::Chain;
use super::forward_pass::forward_pass;
use super::four_forward_pass::four_forward_pass;
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, NoFma};
use crate::math::f64x4::F64x4;

/// Writes the frames moved by the stages into `reached`, from entry 1 on; `reached` has at least N + 1 entries.
#[inline(always)]
pub(super) fn stage_frames<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    reached: &mut [Frame],
) {
    let reached = &mut reached[..=N];
    forward_pass::<A, N, L>(chain, q, |i, frame| reached[i + 1] = Frame::from(*frame));
}

/// Writes the frames of [`stage_frames`] for four configurations, bit-identical; `qs` has one entry per joint.
#[inline(always)]
pub(super) fn four_stage_frames<A: Arithmetic, const N: usize>(
    chain: &Chain,
    qs: &[F64x4],
    reached: &mut [Frame<F64x4>],
) {
    let reached = &mut reached[..=N];
    four_forward_pass::<A, N>(chain, qs, |i, frame| reached[i + 1] = frame.stored());
}

/// Returns the frame of every link of `chain`, base to tip, with its stages at `reached`.
pub(crate) fn link_frames(chain: &Chain, reached: &[Frame]) -> Vec<Frame> {
    chain.links.iter().map(|link| reached[link.stages].then::<NoFma>(&link.offset)).collect()
}
