//! Single-precision frames of all moving elements at eight configurations, for searches whose results are confirmed in double
//! precision.

use super::chain::Transmission;
use super::four_forward_pass::RunningFrames;
use super::joint_curve::{CurvedStage, CurvedStages};
use super::rotation_vector::RotationVector;
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f32x8::F32x8;
use crate::math::real::{Eight, Real};
use crate::math::sincos::sincos_eight;

/// Moving elements of a robot.
#[derive(Debug, Clone)]
pub(crate) struct EightStages {
    stages: Vec<Stage>,
    vector: Option<RotationVector>,
    curves: CurvedStages,
}

#[derive(Debug, Clone)]
struct Stage {
    /// Index of the parent frame.
    parent: usize,
    /// Constant frame relative to the parent, z along the axis, in all lanes.
    frame: Frame<F32x8>,
    motion: Transmission,
}

impl EightStages {
    /// Builds the stages in the order of their frames, from index 1 on: parent frame, constant frame relative to it, and
    /// motion. `vector` is the rotation vector among them, `curves` are those of their curves.
    pub fn new(
        stages: impl Iterator<Item = (usize, Frame, Transmission)>,
        vector: Option<RotationVector>,
        curves: CurvedStages,
    ) -> Self {
        let lanes = |frame: &Frame| Frame {
            axes: frame.axes.map(|axis| axis.map(|x| F32x8::splat(x as f32))),
            origin: frame.origin.map(|x| F32x8::splat(x as f32)),
        };
        let stages = stages.map(|(parent, frame, motion)| Stage { parent, frame: lanes(&frame), motion }).collect();
        Self { stages, vector, curves }
    }

    /// Allocates the buffer of [`write`](Self::write): one frame more than there are moving elements.
    pub fn buffer(&self) -> Vec<Frame<F32x8>> {
        let mut identity = Frame { axes: [[F32x8::ZERO; 3]; 3], origin: [F32x8::ZERO; 3] };
        (0..3).for_each(|k| identity.axes[k][k] = F32x8::splat(1.0));
        vec![identity; self.stages.len() + 1]
    }

    /// Writes the frames of all elements, from entry 1 on; `qs` has one entry per joint.
    #[inline(always)]
    pub fn write<A: Arithmetic>(&self, qs: &[F32x8], frames: &mut [Frame<F32x8>]) {
        let splat = Eight::<A>::splat;
        let vector = self.vector.as_ref().map(|vector| (vector, vector_frames(vector, qs)));
        for (i, Stage { parent, frame, motion }) in self.stages.iter().enumerate() {
            let of_vector = vector.as_ref().and_then(|(vector, turned)| vector.own_stage(i).map(|own| &turned[own]));
            let moved = if let Some(turned) = of_vector {
                RunningFrames::<Eight<A>>::of(turned)
            } else if let Some(curve) = self.curves.at(i) {
                // With an axis of unit length: what these frames carry has no use for the slope.
                let [sine, cosine, slide] = curve_lanes(curve, qs[motion.joint]).map(Eight::<A>::of);
                RunningFrames::of(frame).moved(sine, cosine, slide)
            } else {
                let q = Eight::<A>::of(qs[motion.joint]);
                let (sine, cosine) = sincos_eight(q.mul_add(splat(motion.turn_scale), splat(motion.turn_offset)));
                let slide = q.mul_add(splat(motion.slide_scale), splat(motion.slide_offset));
                RunningFrames::of(frame).moved(sine, cosine, slide)
            };
            frames[i + 1] = if *parent == 0 { moved } else { RunningFrames::of(&frames[*parent]).then(moved) }.stored();
        }
    }
}

/// Returns sine, cosine and slide of a curve, computed in double precision.
#[cold]
fn curve_lanes(curve: &CurvedStage, q: F32x8) -> [F32x8; 3] {
    let lanes = q.0.map(|q| {
        let [value, ..] = curve.curve.at(f64::from(q));
        if curve.turns { [value.sin(), value.cos(), 0.0] } else { [0.0, 1.0, value] }
    });
    std::array::from_fn(|row| F32x8(lanes.map(|lane| lane[row] as f32)))
}

/// Returns the frames of the stages of a rotation vector, each relative to the previous one, computed in double precision.
#[cold]
fn vector_frames(vector: &RotationVector, qs: &[F32x8]) -> [Frame<F32x8>; RotationVector::STAGES] {
    let phi = vector.phi(qs);
    let lanes: [[Frame; RotationVector::STAGES]; 8] =
        std::array::from_fn(|lane| vector.frames(&phi.map(|entry| f64::from(entry.0[lane]))));
    let rows =
        |entry: &dyn Fn(&Frame) -> f64, own: usize| F32x8(std::array::from_fn(|lane| entry(&lanes[lane][own]) as f32));
    std::array::from_fn(|own| Frame {
        axes: std::array::from_fn(|axis| std::array::from_fn(|k| rows(&|frame| frame.axes[axis][k], own))),
        origin: std::array::from_fn(|k| rows(&|frame| frame.origin[k], own)),
    })
}
