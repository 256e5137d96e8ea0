//! Forward pass from base to tip, shared by the kernels for one configuration; plain arrays, no allocation.
//!
//! Each kernel is one straight-line body over N stages, with sines padded to L; [`kernels`](super::kernels) compiles it.

use super::chain::Chain;
use super::wide_frame::WideFrame;
use crate::math::arithmetic::Arithmetic;
use crate::math::sincos::sincos;

/// Computes sines, cosines and translations (m) of all stages.
#[inline(always)]
pub(super) fn stage_motions<A: Arithmetic, const L: usize>(chain: &Chain, q: &[f64]) -> ([f64; L], [f64; L], [f64; L]) {
    let (mut angles, mut slides) = ([0.0; L], [0.0; L]);
    for (i, motion) in chain.motions[..L].iter().enumerate() {
        let value = q[motion.joint];
        angles[i] = A::mul_add(motion.turn_scale, value, motion.turn_offset);
        slides[i] = A::mul_add(motion.slide_scale, value, motion.slide_offset);
    }
    let (mut sines, mut cosines) = ([0.0; L], [0.0; L]);
    sincos::<A>(&angles, &mut sines, &mut cosines);
    (sines, cosines, slides)
}

/// Calls `visit(i, frame)` for each stage from the base on, and returns the tip frame. `frame` is the frame moved by stage i:
/// its origin lies on the axis of the stage, and its z axis is that axis.
#[inline(always)]
pub(super) fn forward_pass<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    mut visit: impl FnMut(usize, &WideFrame),
) -> WideFrame {
    let (sines, cosines, slides) = stage_motions::<A, L>(chain, q);
    let stages = chain.stages.moved::<A, L>(&sines, &cosines, &slides);
    let mut frame = WideFrame::from(&stages.frame(0));
    visit(0, &frame);
    for i in 1..N {
        frame = frame.then::<A>(&stages.frame(i));
        visit(i, &frame);
    }
    frame.then::<A>(&chain.tip)
}
