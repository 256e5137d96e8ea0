//! Inverse dynamics by the recursive Newton-Euler algorithm, in base axes.
//!
//! With the angular velocity w and angular acceleration of a body, the matrix W = \[dw/dt\] + \[w\]^2 gives the acceleration
//! of each of its points, a + W x. The body with moments m, h, S about its origin needs the force m a + W h and the moment
//! h x a + (sum over k of r_k x (W R S)_k), with R = (r_1, r_2, r_3) the axes of its frame: the antisymmetric part of W R S R'.

use super::rigid_bodies::Dynamics;
use super::rotation_vector_rate::rate_of_left_jacobian;
use super::scratch::{BodyState, DynamicsScratch};
use super::wide_vectors::{axes_of, dot, lever, product, products};
use crate::kinematics::{Wrench, restored};
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, NoFma, by_instructions};
use crate::math::f64x4::F64x4;

/// Position, velocity and acceleration of all joints; the frames belong to `q`.
#[derive(Debug, Clone, Copy)]
pub struct DynamicState<'a> {
    /// Positions (rad, m).
    pub q: &'a [f64],
    /// Velocities (rad/s, m/s).
    pub qd: &'a [f64],
    /// Accelerations (rad/s^2, m/s^2).
    pub qdd: &'a [f64],
}

/// Wrench that the surroundings exert on the body of a frame.
#[derive(Debug, Clone, Copy)]
pub struct AppliedWrench {
    /// Index of the frame.
    pub frame: usize,
    /// Point of action in base axes (m).
    pub point: [f64; 3],
    /// Force (N) and moment (N m) in base axes.
    pub wrench: Wrench,
}

impl Dynamics {
    /// Writes the joint torques (N m, or N for prismatic joints) that cause the motion `state`, with the frames of all stages in
    /// `scratch`. `wrenches` act on the robot from outside. Dry friction acts only on joints that move.
    ///
    /// The torque of a rotation vector is conjugate to the rates of its entries: the power is their scalar product.
    pub fn inverse(
        &self,
        state: &DynamicState,
        wrenches: &[AppliedWrench],
        scratch: &mut DynamicsScratch,
        torques: &mut [f64],
    ) {
        self.inverse_without_friction(state, wrenches, scratch, torques);
        for (joint, (torque, drive)) in torques.iter_mut().zip(&self.drives).enumerate() {
            let rate = state.qd[joint];
            let dry = if rate == 0.0 { 0.0 } else { drive.friction.copysign(rate) };
            *torque += drive.damping * rate + dry;
        }
    }

    /// [`inverse`](Self::inverse) without the friction of the joints.
    pub(crate) fn inverse_without_friction(
        &self,
        state: &DynamicState,
        wrenches: &[AppliedWrench],
        scratch: &mut DynamicsScratch,
        torques: &mut [f64],
    ) {
        let DynamicsScratch { frames, states, .. } = scratch;
        inverse(self, frames, state, wrenches, states, torques);
        for (joint, (torque, drive)) in torques.iter_mut().zip(&self.drives).enumerate() {
            *torque += drive.armature * state.qdd[joint];
        }
    }

    /// Angular and linear acceleration of the first stage of a curve due to its second derivative, p'' qd^2, in base axes; zero for other
    /// stages.
    #[cold]
    fn curve_bias(&self, stage: usize, frame: &Frame, q: f64, rate: f64) -> [[f64; 3]; 2] {
        let Some(curved) = self.curves.at(stage) else { return [[0.0; 3]; 2] };
        let [_, _, bend] = curved.curve.at(q);
        let along = restored(frame).axes[2].map(|entry| bend * rate * rate * entry);
        if curved.turns { [along, [0.0; 3]] } else { [[0.0; 3], along] }
    }

    /// Angular acceleration of the rotation vector due to its rates alone, in base axes.
    fn vector_bias(&self, frames: &[Frame], state: &DynamicState) -> [f64; 3] {
        let Some(vector) = &self.vector else { return [0.0; 3] };
        let (phi, rates) = (vector.phi(state.q), vector.phi(state.qd));
        let start = frames[vector.first].then::<NoFma>(&vector.start);
        start.turn::<NoFma>(&rate_of_left_jacobian(&phi, &rates))
    }
}

by_instructions! {
    /// Writes the torques without friction and rotors.
    fn inverse(
        dynamics: &Dynamics,
        frames: &[Frame],
        state: &DynamicState,
        wrenches: &[AppliedWrench],
        states: &mut [BodyState],
        torques: &mut [f64],
    ) {
        outward::<A>(dynamics, frames, state, states);
        for applied in wrenches {
            let AppliedWrench { frame, point, wrench: [fx, fy, fz, mx, my, mz] } = applied;
            let (force, moment) = (F64x4([*fx, *fy, *fz, 0.0]), F64x4([*mx, *my, *mz, 0.0]));
            let lever = A::sub_x4(F64x4::from_vector(point), F64x4::from_vector(&frames[*frame].origin));
            let body = &mut states[*frame];
            body.force = A::sub_x4(body.force, force);
            body.moment = A::sub_x4(body.moment, A::add_x4(moment, A::cross_x4(lever, force)));
        }
        inward::<A>(dynamics, frames, states, torques);
    }
}

/// Outward pass: motion of each body, and the force and moment that it needs.
#[inline(always)]
fn outward<A: Arithmetic>(dynamics: &Dynamics, frames: &[Frame], state: &DynamicState, states: &mut [BodyState]) {
    let first_of_vector = dynamics.vector.as_ref().map_or(usize::MAX, |vector| vector.first);
    states[0] = BodyState { acceleration: -F64x4::from_vector(&dynamics.gravity), ..BodyState::REST };
    for (i, body) in dynamics.bodies.iter().enumerate() {
        let (parent, motion) = (&states[body.parent], &body.motion);
        let frame = &frames[i + 1];
        let axes = axes_of(frame);
        let (rate, acceleration) = (state.qd[motion.joint], state.qdd[motion.joint]);
        // The axes of a rotation vector turn with the body before it.
        let carrier = if motion.is_of_vector() { states[first_of_vector].turn } else { parent.turn };
        let swept = A::cross_x4(carrier, axes[2]);
        let turn = A::mul_add_x4(axes[2], F64x4::splat(motion.turn_scale * rate), parent.turn);
        let mut turn_rate = A::mul_add_x4(axes[2], F64x4::splat(motion.turn_scale * acceleration), parent.turn_rate);
        turn_rate = A::mul_add_x4(swept, F64x4::splat(motion.turn_scale * rate), turn_rate);
        if first_of_vector.wrapping_add(3) == i {
            turn_rate = A::add_x4(turn_rate, F64x4::from_vector(&dynamics.vector_bias(frames, state)));
        }
        let lever = lever(frame, &frames[body.parent]);
        let mut of_origin = A::add_x4(parent.acceleration, product::<A>(&parent.spread, &lever));
        of_origin = A::mul_add_x4(axes[2], F64x4::splat(motion.slide_scale * acceleration), of_origin);
        of_origin = A::mul_add_x4(swept, F64x4::splat(2.0 * motion.slide_scale * rate), of_origin);
        if !dynamics.curves.is_empty() {
            let [of_turn, of_slide] = dynamics.curve_bias(i, frame, state.q[motion.joint], rate);
            turn_rate = A::add_x4(turn_rate, F64x4::from_vector(&of_turn));
            of_origin = A::add_x4(of_origin, F64x4::from_vector(&of_slide));
        }
        let spread = spread(turn, turn_rate);
        let of_axes = products::<A>(&spread, &frame.axes);
        let moments = &body.moments;
        let first = product::<A>(&axes, &moments.first);
        let force = A::mul_add_x4(of_origin, F64x4::splat(moments.mass), product::<A>(&of_axes, &moments.first));
        let mut moment = A::cross_x4(first, of_origin);
        let [x, y, z] = products::<A>(&of_axes, &moments.second);
        moment = A::add_x4(moment, A::cross_x4(axes[0], x));
        moment = A::add_x4(moment, A::add_x4(A::cross_x4(axes[1], y), A::cross_x4(axes[2], z)));
        states[i + 1] = BodyState { turn, turn_rate, spread, acceleration: of_origin, force, moment };
    }
}

/// Inward pass: each stage passes on the load of its body and of all that it carries.
#[inline(always)]
fn inward<A: Arithmetic>(dynamics: &Dynamics, frames: &[Frame], states: &mut [BodyState], torques: &mut [f64]) {
    torques.fill(0.0);
    for (i, body) in dynamics.bodies.iter().enumerate().rev() {
        let frame = &frames[i + 1];
        let BodyState { force, moment, .. } = states[i + 1];
        let (turning, sliding) = (dot(&frame.axes[2], moment), dot(&frame.axes[2], force));
        // Torques are summed, since several stages may share a joint (mimics).
        torques[body.motion.joint] += body.motion.turn_scale * turning + body.motion.slide_scale * sliding;
        let lever = F64x4::from_vector(&lever(frame, &frames[body.parent]));
        let parent = &mut states[body.parent];
        parent.force = A::add_x4(parent.force, force);
        parent.moment = A::add_x4(parent.moment, A::add_x4(moment, A::cross_x4(lever, force)));
    }
}

/// Returns the columns of \[turn_rate\] + \[turn\]^2.
#[inline(always)]
fn spread(turn: F64x4, turn_rate: F64x4) -> [F64x4; 3] {
    let ([x, y, z, _], [a, b, c, _]) = (turn.0, turn_rate.0);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let (xy, yz, zx) = (x * y, y * z, z * x);
    [
        F64x4([-(yy + zz), xy + c, zx - b, 0.0]),
        F64x4([xy - c, -(xx + zz), yz + a, 0.0]),
        F64x4([zx + b, yz - a, -(xx + yy), 0.0]),
    ]
}
