//! Three joints that are the entries of a rotation vector phi (rad), as those of a floating base: together they turn by exp \[phi\].
//!
//! A chain holds them as four stages. Seen from the frame before, the z axes of the first three are the columns j1, j2, j3 of the left
//! Jacobian J of SO(3): what a rotation changes by per unit of each entry, not of unit length. Cyclic permutations of J put them there:
//! (j2, j3, j1), (j3, j1, j2), (j1, j2, j3). The fourth stage, which no joint moves, makes a rotation of it again:
//! J^-1 exp \[phi\], which is the inverse of the right Jacobian. J is singular at a length of 2 pi, which limits keep it from.

use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::so3::{inverse_right_jacobian, left_jacobian};

const STAGES: usize = RotationVector::STAGES;

/// From the axes x, y, z to y, z, x.
const CYCLE: Frame = Frame { axes: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], origin: [0.0; 3] };

/// A rotation vector in a chain.
#[derive(Debug, Clone)]
pub(crate) struct RotationVector {
    /// Its first stage.
    pub first: usize,
    /// Its first joint.
    pub joint: usize,
    /// Where it turns, relative to the stage before.
    pub start: Frame,
}

impl RotationVector {
    /// Stages that the three joints become.
    pub const STAGES: usize = 4;

    /// Frames of its stages at zero, each relative to the one before.
    pub fn at_zero(start: &Frame) -> [Frame; STAGES] {
        [start.then::<NoFma>(&CYCLE), CYCLE, CYCLE, Frame::IDENTITY]
    }

    /// Frames of its stages at `phi`, each relative to the one before.
    pub fn frames(&self, phi: &[f64; 3]) -> [Frame; STAGES] {
        let [x, y, z] = left_jacobian(phi);
        let turned = |axes| Frame { axes, origin: [0.0; 3] };
        [self.start.then::<NoFma>(&turned([y, z, x])), CYCLE, CYCLE, turned(inverse_right_jacobian(phi))]
    }

    /// Its entries in `q`.
    pub fn phi<T: Copy>(&self, q: &[T]) -> [T; 3] {
        std::array::from_fn(|k| q[self.joint + k])
    }

    /// Which of its stages number `stage` of the chain is.
    #[inline]
    pub fn own_stage(&self, stage: usize) -> Option<usize> {
        stage.checked_sub(self.first).filter(|own| *own < STAGES)
    }
}
