//! Constant frames of a chain as a structure of arrays: each row holds one entry of the frames of all stages, so that joint
//! motion is applied to four stages at a time before the forward pass.

use crate::math::Frame;
use crate::math::MAX_DOF;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;

/// Coordinates of L vectors: entry i of each row belongs to vector i.
type Vectors<const L: usize> = [[f64; L]; 3];

/// Frame of each stage relative to the previous one; the identity for padding.
#[derive(Debug, Clone)]
pub(crate) struct Stages {
    x: Vectors<MAX_DOF>,
    y: Vectors<MAX_DOF>,
    z: Vectors<MAX_DOF>,
    origin: Vectors<MAX_DOF>,
}

/// First L stages of a chain, moved by their joints.
pub(crate) struct MovedStages<'a, const L: usize> {
    stages: &'a Stages,
    x: Vectors<L>,
    y: Vectors<L>,
    origin: Vectors<L>,
}

impl Stages {
    /// Stores `frames`, at most [`MAX_DOF`].
    pub fn new(frames: &[Frame]) -> Self {
        let frame = |i: usize| frames.get(i).unwrap_or(&Frame::IDENTITY);
        let rows = |number: &dyn Fn(&Frame, usize) -> f64| {
            std::array::from_fn(|k| std::array::from_fn(|i| number(frame(i), k)))
        };
        Self {
            x: rows(&|frame, k| frame.axes[0][k]),
            y: rows(&|frame, k| frame.axes[1][k]),
            z: rows(&|frame, k| frame.axes[2][k]),
            origin: rows(&|frame, k| frame.origin[k]),
        }
    }

    /// Returns the frame of stage `i`.
    #[inline(always)]
    pub fn frame(&self, i: usize) -> Frame {
        Frame { axes: [vector(&self.x, i), vector(&self.y, i), vector(&self.z, i)], origin: vector(&self.origin, i) }
    }

    /// Returns the first L stages (a multiple of four), each translated along and rotated about its own z axis.
    #[inline(always)]
    pub fn moved<A: Arithmetic, const L: usize>(
        &self,
        sines: &[f64; L],
        cosines: &[f64; L],
        slides: &[f64; L],
    ) -> MovedStages<'_, L> {
        let [mut x, mut y, mut origin] = [[[0.0; L]; 3]; 3];
        for first in (0..L).step_by(4) {
            let [sine, cosine, slide] = [sines, cosines, slides].map(|row| F64x4::of(row, first));
            for k in 0..3 {
                let [old_x, old_y] = [&self.x[k], &self.y[k]].map(|row| F64x4::of(row, first));
                let [z, offset] = [&self.z[k], &self.origin[k]].map(|row| F64x4::of(row, first));
                A::mul_add_x4(sine, old_y, A::mul_x4(cosine, old_x)).write(&mut x[k], first);
                A::mul_add_x4(-sine, old_x, A::mul_x4(cosine, old_y)).write(&mut y[k], first);
                A::mul_add_x4(slide, z, offset).write(&mut origin[k], first);
            }
        }
        MovedStages { stages: self, x, y, origin }
    }
}

impl<const L: usize> MovedStages<'_, L> {
    /// Returns the frame of stage `i`.
    #[inline(always)]
    pub fn frame(&self, i: usize) -> Frame {
        Frame {
            axes: [vector(&self.x, i), vector(&self.y, i), vector(&self.stages.z, i)],
            origin: vector(&self.origin, i),
        }
    }
}

#[inline(always)]
fn vector<const L: usize>(vectors: &Vectors<L>, i: usize) -> [f64; 3] {
    [vectors[0][i], vectors[1][i], vectors[2][i]]
}
