//! Scratch memory of the kernels.

use smallvec::SmallVec;

use super::rigid_bodies::Dynamics;
use crate::kinematics::link_tree::FrameBuffer;
use crate::math::Frame;
use crate::math::f64x4::F64x4;

/// Motion of a body, and the load that its stage passes on.
#[derive(Debug, Clone, Copy)]
pub(super) struct BodyState {
    /// Angular velocity and angular acceleration.
    pub turn: F64x4,
    pub turn_rate: F64x4,
    /// Columns of the matrix that gives the accelerations of points; composite second moment in the mass matrix.
    pub spread: [F64x4; 3],
    /// Acceleration of the origin, less that of free fall.
    pub acceleration: F64x4,
    /// Force.
    pub force: F64x4,
    /// Moment about the origin; composite first moment where nothing moves.
    pub moment: F64x4,
}

const ZERO: F64x4 = F64x4::ZERO;

impl BodyState {
    pub const REST: Self =
        Self { turn: ZERO, turn_rate: ZERO, spread: [ZERO; 3], acceleration: ZERO, force: ZERO, moment: ZERO };
}

/// Scratch memory of the kernels, to be reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct DynamicsScratch {
    /// Frames of all stages.
    pub(crate) frames: FrameBuffer,
    pub(super) states: SmallVec<[BodyState; 16]>,
    /// Mass matrix (n, n), and a vector (n,), for forward dynamics; empty until then.
    pub(super) matrix: Vec<f64>,
    pub(super) bias: Vec<f64>,
}

impl DynamicsScratch {
    /// Creates the scratch memory for these bodies; `frames` is as long as the kinematic kernels need.
    pub(crate) fn new(dynamics: &Dynamics, frames: FrameBuffer) -> Self {
        let states = SmallVec::from_elem(BodyState::REST, dynamics.frames());
        Self { frames, states, matrix: vec![], bias: vec![] }
    }

    /// Makes room for other bodies, and for as many frames as their kinematic kernels need.
    pub(crate) fn fit(&mut self, dynamics: &Dynamics, frames: usize) {
        self.states.resize(dynamics.frames(), BodyState::REST);
        self.frames.resize(frames, Frame::IDENTITY);
    }
}
