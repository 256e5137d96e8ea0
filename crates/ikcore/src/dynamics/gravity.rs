//! Torques that hold the bodies up.

use super::rigid_bodies::Dynamics;
use super::scratch::{BodyState, DynamicsScratch};
use super::wide_vectors::{axes_of, dot, lever, product};
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::f64x4::F64x4;

impl Dynamics {
    /// Writes the joint torques (N m, or N for prismatic joints) that hold the bodies at rest, with the frames of all stages in
    /// `scratch`: [`inverse`](Self::inverse) without motion, at a third of the work.
    pub fn holding(&self, scratch: &mut DynamicsScratch, torques: &mut [f64]) {
        let DynamicsScratch { frames, states, .. } = scratch;
        holding(self, frames, states, torques);
    }
}

by_instructions! {
    fn holding(dynamics: &Dynamics, frames: &[Frame], states: &mut [BodyState], torques: &mut [f64]) {
        gather::<A>(dynamics, frames, states);
        torques.fill(0.0);
        let gravity = F64x4::from_vector(&dynamics.gravity);
        for (i, body) in dynamics.bodies.iter().enumerate() {
            let axis = &frames[i + 1].axes[2];
            let turning = dot(axis, A::cross_x4(states[i + 1].moment, gravity));
            let sliding = dynamics.carried[i + 1] * dot(axis, gravity);
            torques[body.motion.joint] -= body.motion.turn_scale * turning + body.motion.slide_scale * sliding;
        }
    }
}

/// Writes the first moment of all that each frame carries, about its origin, in base axes.
#[inline(always)]
fn gather<A: Arithmetic>(dynamics: &Dynamics, frames: &[Frame], states: &mut [BodyState]) {
    states[0].moment = F64x4::from_vector(&dynamics.base.first);
    for (i, body) in dynamics.bodies.iter().enumerate() {
        states[i + 1].moment = product::<A>(&axes_of(&frames[i + 1]), &body.moments.first);
    }
    for (i, body) in dynamics.bodies.iter().enumerate().rev() {
        let lever = F64x4::from_vector(&lever(&frames[i + 1], &frames[body.parent]));
        let moved = A::mul_add_x4(lever, F64x4::splat(dynamics.carried[i + 1]), states[i + 1].moment);
        states[body.parent].moment = A::add_x4(states[body.parent].moment, moved);
    }
}
