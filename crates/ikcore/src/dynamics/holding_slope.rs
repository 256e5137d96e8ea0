//! Derivatives of the torques that hold the bodies up.
//!
//! These torques are the gradient of the potential energy, so their derivatives are its second derivatives, a symmetric matrix. A stage
//! turns the axes and moments of all that it carries, and moves none of them relative to the origins of their frames. So with the moment
//! P of a stage's load per unit rate, z x h or m z, stage a before b has the entry -g . (z_a x P_b).

use super::rigid_bodies::Dynamics;
use super::scratch::{BodyState, DynamicsScratch};
use crate::math::f64x4::F64x4;
use crate::math::so3::{cross, dot};

impl Dynamics {
    /// Adds the change of the holding torques per unit motion of the joints by `rates` (n,) to `slope` (n,), after
    /// [`holding`](Self::holding) at the same frames. The rates of a rotation vector have to be zero: the axes of its own joints turn
    /// with it in another way.
    pub(crate) fn add_holding_slope(&self, scratch: &mut DynamicsScratch, rates: &[f64], slope: &mut [f64]) {
        let DynamicsScratch { frames, states, .. } = scratch;
        states[0].turn = F64x4::ZERO;
        for (i, body) in self.bodies.iter().enumerate() {
            let (motion, axis) = (&body.motion, &frames[i + 1].axes[2]);
            let rate = rates[motion.joint];
            let before = states[body.parent].turn.vector();
            let swept = cross(axis, &states[i + 1].moment.vector());
            let turn: [f64; 3] = std::array::from_fn(|k| before[k] + motion.turn_scale * rate * axis[k]);
            let load: [f64; 3] = std::array::from_fn(|k| {
                motion.turn_scale * swept[k] + motion.slide_scale * self.carried[i + 1] * axis[k]
            });
            slope[motion.joint] -= dot(&self.gravity, &cross(&turn, &load));
            let load = F64x4::from_vector(&load.map(|entry| rate * entry));
            states[i + 1] =
                BodyState { turn: F64x4::from_vector(&turn), acceleration: load, force: F64x4::ZERO, ..states[i + 1] };
        }
        for (i, body) in self.bodies.iter().enumerate().rev() {
            let BodyState { acceleration: own, force: beyond, .. } = states[i + 1];
            let turned = cross(&frames[i + 1].axes[2], &beyond.vector());
            slope[body.motion.joint] -= body.motion.turn_scale * dot(&self.gravity, &turned);
            let parent = &mut states[body.parent].force;
            *parent = F64x4(std::array::from_fn(|k| parent.0[k] + own.0[k] + beyond.0[k]));
        }
    }
}
