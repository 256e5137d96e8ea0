//! Frames of all moving elements at eight configurations at once, in single precision: for searches, whose results are confirmed in
//! double precision.

use super::chain::StageMotion;
use super::four_forward_pass::RunningFrames;
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f32x8::F32x8;
use crate::math::real::{Eight, Real};
use crate::math::sincos::sincos_eight;

/// The moving elements of a robot.
#[derive(Debug, Clone)]
pub(crate) struct EightStages(Vec<Stage>);

#[derive(Debug, Clone)]
struct Stage {
    /// Number of the frame that it starts from.
    parent: usize,
    /// Its constant frame there, z along its axis, in all lanes.
    frame: Frame<F32x8>,
    motion: StageMotion,
}

impl EightStages {
    /// In the order of their frames from number 1 on: the number of the frame that each starts from, its constant frame there, and
    /// its motion.
    pub fn new(stages: impl Iterator<Item = (usize, Frame, StageMotion)>) -> Self {
        let lanes = |frame: &Frame| Frame {
            axes: frame.axes.map(|axis| axis.map(|x| F32x8::splat(x as f32))),
            origin: frame.origin.map(|x| F32x8::splat(x as f32)),
        };
        Self(stages.map(|(parent, frame, motion)| Stage { parent, frame: lanes(&frame), motion }).collect())
    }

    /// Room for [`write`](Self::write): one frame more than there are moving elements.
    pub fn buffer(&self) -> Vec<Frame<F32x8>> {
        let mut identity = Frame { axes: [[F32x8::ZERO; 3]; 3], origin: [F32x8::ZERO; 3] };
        (0..3).for_each(|k| identity.axes[k][k] = F32x8::splat(1.0));
        vec![identity; self.0.len() + 1]
    }

    /// Writes the frames of all elements, from entry 1 on; `qs` has one entry per joint.
    #[inline(always)]
    pub fn write<A: Arithmetic>(&self, qs: &[F32x8], frames: &mut [Frame<F32x8>]) {
        let splat = Eight::<A>::splat;
        for (i, Stage { parent, frame, motion }) in self.0.iter().enumerate() {
            let q = Eight::<A>::of(qs[motion.joint]);
            let (sine, cosine) = sincos_eight(q.mul_add(splat(motion.turn_scale), splat(motion.turn_offset)));
            let slide = q.mul_add(splat(motion.slide_scale), splat(motion.slide_offset));
            let moved = RunningFrames::<Eight<A>>::of(frame).moved(sine, cosine, slide);
            frames[i + 1] = if *parent == 0 { moved } else { RunningFrames::of(&frames[*parent]).then(moved) }.stored();
        }
    }
}
