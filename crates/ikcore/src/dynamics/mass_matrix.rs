//! Mass matrix by the composite rigid body algorithm, in base axes.
//!
//! A stage that moves all that it carries at unit rate gives it a momentum p and an angular momentum L about the origin of its
//! frame; each stage before it takes its share z . L, or z . p if it slides.

use super::rigid_bodies::Dynamics;
use super::scratch::{BodyState, DynamicsScratch};
use super::wide_vectors::{axes_of, dot, lever, product, products};
use crate::kinematics::chain::Transmission;
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::f64x4::F64x4;

impl Dynamics {
    /// Writes the mass matrix (n, n) with rotors (kg m^2; rows and columns of prismatic joints kg m and kg), with the frames of
    /// all stages in `scratch`: the kinetic energy is half of qd' M qd.
    pub fn mass_matrix(&self, scratch: &mut DynamicsScratch, matrix: &mut [f64]) {
        let DynamicsScratch { frames, states, .. } = scratch;
        mass_matrix(self, frames, states, matrix);
    }
}

by_instructions! {
    pub(super) fn mass_matrix(dynamics: &Dynamics, frames: &[Frame], states: &mut [BodyState], matrix: &mut [f64]) {
        let n = dynamics.drives.len();
        composites::<A>(dynamics, frames, states);
        matrix.fill(0.0);
        for (joint, drive) in dynamics.drives.iter().enumerate() {
            matrix[joint * n + joint] = drive.armature;
        }
        for (i, body) in dynamics.bodies.iter().enumerate() {
            let motion = &body.motion;
            if motion.scale() == 0.0 {
                continue;
            }
            let axis = F64x4::from_vector(&frames[i + 1].axes[2]);
            let (momentum, mut about) = momenta::<A>(&states[i + 1], dynamics.carried[i + 1], axis, motion);
            let mut at = i + 1;
            while at > 0 {
                let stage = &dynamics.bodies[at - 1];
                let axis = &frames[at].axes[2];
                let entry = stage.motion.turn_scale * dot(axis, about) + stage.motion.slide_scale * dot(axis, momentum);
                let (row, column) = (motion.joint, stage.motion.joint);
                matrix[row * n + column] += entry;
                if at != i + 1 {
                    matrix[column * n + row] += entry;
                }
                let lever = F64x4::from_vector(&lever(&frames[at], &frames[stage.parent]));
                about = A::add_x4(about, A::cross_x4(lever, momentum));
                at = stage.parent;
            }
        }
    }
}

/// Writes first and second moments of all that each frame carries, about its origin, in base axes.
#[inline(always)]
fn composites<A: Arithmetic>(dynamics: &Dynamics, frames: &[Frame], states: &mut [BodyState]) {
    for (i, body) in dynamics.bodies.iter().enumerate() {
        let frame = &frames[i + 1];
        let axes = axes_of(frame);
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = frame.axes;
        let turned = products::<A>(&axes, &body.moments.second);
        states[i + 1].spread = products::<A>(&turned, &[[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]]);
        states[i + 1].moment = product::<A>(&axes, &body.moments.first);
    }
    for (i, body) in dynamics.bodies.iter().enumerate().rev() {
        if body.parent == 0 {
            continue;
        }
        let lever = lever(&frames[i + 1], &frames[body.parent]);
        let wide = F64x4::from_vector(&lever);
        let BodyState { spread, moment, .. } = states[i + 1];
        let moved = A::mul_add_x4(wide, F64x4::splat(dynamics.carried[i + 1]), moment);
        let first = moment.vector();
        let parent = &mut states[body.parent];
        for k in 0..3 {
            // About the origin of the parent: S + h l' + l h' + m l l'.
            let crossed = A::mul_add_x4(moved, F64x4::splat(lever[k]), A::mul_x4(wide, F64x4::splat(first[k])));
            parent.spread[k] = A::add_x4(parent.spread[k], A::add_x4(spread[k], crossed));
        }
        parent.moment = A::add_x4(parent.moment, moved);
    }
}

/// Returns momentum and angular momentum per unit rate of the joint that drives this stage.
#[inline(always)]
fn momenta<A: Arithmetic>(carried: &BodyState, mass: f64, axis: F64x4, motion: &Transmission) -> (F64x4, F64x4) {
    let [turn, slide] = [motion.turn_scale, motion.slide_scale].map(F64x4::splat);
    let swept = A::cross_x4(axis, carried.moment);
    let trace = carried.spread[0].0[0] + carried.spread[1].0[1] + carried.spread[2].0[2];
    let turned = A::sub_x4(A::mul_x4(axis, F64x4::splat(trace)), product::<A>(&carried.spread, &axis.vector()));
    let momentum = A::mul_add_x4(turn, swept, A::mul_x4(slide, A::mul_x4(axis, F64x4::splat(mass))));
    (momentum, A::mul_add_x4(turn, turned, A::mul_x4(-slide, swept)))
}
