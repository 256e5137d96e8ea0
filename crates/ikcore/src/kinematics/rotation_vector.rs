//! Three joints that form a rotation vector phi (rad), as in a floating base: together they rotate by exp \[phi\].
//!
//! A chain represents them as four stages. In the frame before them, the z axes of the first three stages are the columns j1,
//! j2, j3 of the left Jacobian J of SO(3): the angular velocity per unit rate of each entry, not of unit length. Cyclic
//! permutations of J provide these axes: (j2, j3, j1), (j3, j1, j2), (j1, j2, j3). The fourth stage, which no joint moves,
//! restores a rotation by J^-1 exp \[phi\], the inverse of the right Jacobian. J is singular at a length of 2 pi, which the
//! limits exclude.

use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::so3::{inverse_right_jacobian, left_jacobian};

const STAGES: usize = RotationVector::STAGES;

/// Cyclic permutation of the axes x, y, z to y, z, x.
const CYCLE: Frame = Frame { axes: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], origin: [0.0; 3] };

/// Rotation vector within a chain.
#[derive(Debug, Clone)]
pub(crate) struct RotationVector {
    /// Index of the first of its four stages.
    pub first: usize,
    /// Index of the first of its three joints.
    pub joint: usize,
    /// Constant frame relative to the stage before.
    pub start: Frame,
}

impl RotationVector {
    /// Number of stages that represent the three joints.
    pub const STAGES: usize = 4;

    /// Returns the frames of the stages at zero, each relative to the previous one.
    pub fn at_zero(start: &Frame) -> [Frame; STAGES] {
        [start.then::<NoFma>(&CYCLE), CYCLE, CYCLE, Frame::IDENTITY]
    }

    /// Returns the frames of the stages at `phi`, each relative to the previous one.
    pub fn frames(&self, phi: &[f64; 3]) -> [Frame; STAGES] {
        let [x, y, z] = left_jacobian(phi);
        let turned = |axes| Frame { axes, origin: [0.0; 3] };
        [self.start.then::<NoFma>(&turned([y, z, x])), CYCLE, CYCLE, turned(inverse_right_jacobian(phi))]
    }

    /// Returns the entries of the rotation vector in `q`.
    pub fn phi<T: Copy>(&self, q: &[T]) -> [T; 3] {
        std::array::from_fn(|k| q[self.joint + k])
    }

    /// Returns the position of chain stage `stage` among the stages of the vector; `None` if it is not one of them.
    #[inline]
    pub fn own_stage(&self, stage: usize) -> Option<usize> {
        stage.checked_sub(self.first).filter(|own| *own < STAGES)
    }
}
