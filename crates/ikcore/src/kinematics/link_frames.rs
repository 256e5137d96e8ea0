//! Frames of all stages and links.

use super::chain::Chain;
use super::forward_pass::forward_pass;
use crate::math::arithmetic::{Arithmetic, NoFma};
use crate::math::{Frame, MAX_DOF};

/// Frames reached after 0, 1, 2, ... stages.
pub(crate) type StageFrames = [Frame; MAX_DOF + 1];

/// Writes the frame that each stage moves into `reached`, from entry 1 on.
#[inline(always)]
pub(super) fn stage_frames<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    reached: &mut StageFrames,
) {
    forward_pass::<A, N, L>(chain, q, |i, frame| reached[i + 1] = Frame::from(*frame));
}

/// The frame of every link of `chain`, base to tip, with its stages at `reached`.
pub(crate) fn link_frames(chain: &Chain, reached: &StageFrames) -> Vec<Frame> {
    chain.links.iter().map(|link| reached[link.stages].then::<NoFma>(&link.offset)).collect()
}
