//! Inverse dynamics along a path, at four points at a time: each lane of the arithmetic is a point.
//!
//! Along a path q(s) the torques are a d2s/dt2 + b (ds/dt)^2 + g. One recursive Newton-Euler pass computes a, b and g together, because all
//! three use the same axes. The accelerations of bodies that multiply d2s/dt2 are their velocities at ds/dt = 1.

use super::rigid_bodies::{Dynamics, MovingBody};
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::vec3::Vec3;

/// Four points of a path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathPoints<'a> {
    /// Frames of all stages.
    pub frames: &'a [Frame<F64x4>],
    /// First and second derivatives of the joints by s.
    pub first: &'a [F64x4],
    pub second: &'a [F64x4],
}

/// The torque of a joint at four points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathTerms {
    /// Torque against gravity.
    pub hold: F64x4,
    /// Factor of (ds/dt)^2.
    pub of_square: F64x4,
    /// Factor of d2s/dt2.
    pub of_change: F64x4,
}

/// A vector at four points, in base axes.
type Vectors = [F64x4; 3];

const ZERO: Vectors = [F64x4::ZERO; 3];

/// Motion of a body, and the load on its joint: scratch memory of [`Dynamics::write_path_terms`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodyOnPath {
    /// Angular velocity and acceleration at ds/dt = 1 and d2s/dt2 = 0.
    turn: Vectors,
    turn_rate: Vectors,
    /// Velocity and acceleration of the origin of the frame, likewise.
    velocity: Vectors,
    acceleration: Vectors,
    /// First moment of mass, about the origin, of this body and all bodies beyond it.
    first: Vectors,
    /// Factors of (ds/dt)^2 and of d2s/dt2.
    of_square: Load,
    of_change: Load,
}

/// Force and moment.
#[derive(Debug, Clone, Copy)]
struct Load {
    force: Vectors,
    /// About the origin of the frame.
    moment: Vectors,
}

impl BodyOnPath {
    pub(crate) const REST: Self = Self {
        turn: ZERO,
        turn_rate: ZERO,
        velocity: ZERO,
        acceleration: ZERO,
        first: ZERO,
        of_square: Load { force: ZERO, moment: ZERO },
        of_change: Load { force: ZERO, moment: ZERO },
    };
}

impl Dynamics {
    /// Writes the torques (n,) of all joints without friction; `bodies` has one entry per frame. Supports neither joints that follow a
    /// polynomial nor a floating base.
    pub(crate) fn write_path_terms(&self, at: &PathPoints, bodies: &mut [BodyOnPath], terms: &mut [PathTerms]) {
        path_terms(self, at, bodies, terms);
    }
}

by_instructions! {
    fn path_terms(dynamics: &Dynamics, at: &PathPoints, bodies: &mut [BodyOnPath], terms: &mut [PathTerms]) {
        bodies[0] = BodyOnPath::REST;
        for (i, body) in dynamics.bodies.iter().enumerate() {
            let (frame, before) = (&at.frames[i + 1], &at.frames[body.parent]);
            let rates = [at.first[body.motion.joint], at.second[body.motion.joint]];
            bodies[i + 1] = moved::<A>(body, &bodies[body.parent], [before, frame], rates);
        }
        for (joint, (terms, drive)) in terms.iter_mut().zip(&dynamics.drives).enumerate() {
            let rotor = F64x4::splat(drive.armature);
            let (of_square, of_change) = (A::mul_x4(rotor, at.second[joint]), A::mul_x4(rotor, at.first[joint]));
            *terms = PathTerms { hold: F64x4::ZERO, of_square, of_change };
        }
        for (i, body) in dynamics.bodies.iter().enumerate().rev() {
            let (frame, before) = (&at.frames[i + 1], &at.frames[body.parent]);
            let load = bodies[i + 1];
            felt::<A>(body, &load, frame, (&dynamics.gravity, dynamics.carried[i + 1]), &mut terms[body.motion.joint]);
            let lever = Vec3::<Four<A>>::of(&frame.origin) - Vec3::of(&before.origin);
            pass_on::<A>(&load, lever, dynamics.carried[i + 1], &mut bodies[body.parent]);
        }
    }
}

/// Returns the motion of a body, and the force and moment that its own mass needs.
#[inline(always)]
fn moved<A: Arithmetic>(
    body: &MovingBody,
    parent: &BodyOnPath,
    [before, frame]: [&Frame<F64x4>; 2],
    [rate, change]: [F64x4; 2],
) -> BodyOnPath {
    let (rate, change) = (Four::<A>::of(rate), Four::<A>::of(change));
    let (turn_scale, slide_scale) = (Four::splat(body.motion.turn_scale), Four::splat(body.motion.slide_scale));
    let axis = Vec3::<Four<A>>::of(&frame.axes[2]);
    let lever = Vec3::<Four<A>>::of(&frame.origin) - Vec3::of(&before.origin);
    let (turn_before, change_before) = (Vec3::<Four<A>>::of(&parent.turn), Vec3::<Four<A>>::of(&parent.turn_rate));
    let swept = turn_before.cross(axis);
    let (turning, sliding) = (rate * turn_scale, rate * slide_scale);
    let turn = axis.mul_add(turning, turn_before);
    let turn_rate = axis.mul_add(change * turn_scale, swept.mul_add(turning, change_before));
    let carried = turn_before.cross(lever);
    let velocity = axis.mul_add(sliding, Vec3::of(&parent.velocity) + carried);
    let of_parent = Vec3::of(&parent.acceleration) + change_before.cross(lever) + turn_before.cross(carried);
    let acceleration = axis.mul_add(change * slide_scale, swept.mul_add(sliding + sliding, of_parent));

    let mass = Four::<A>::splat(body.moments.mass);
    let first = in_base::<A>(frame, Vec3::splat(&body.moments.first));
    let momentum = turned_inertia::<A>(body, frame, turn);
    let swing = turn.cross(first);
    let of_change =
        Load { force: velocity.mul_add(mass, swing).stored(), moment: (first.cross(velocity) + momentum).stored() };
    let moment = first.cross(acceleration) + turned_inertia::<A>(body, frame, turn_rate) + turn.cross(momentum);
    let force = acceleration.mul_add(mass, turn_rate.cross(first) + turn.cross(swing));
    BodyOnPath {
        turn: turn.stored(),
        turn_rate: turn_rate.stored(),
        velocity: velocity.stored(),
        acceleration: acceleration.stored(),
        first: first.stored(),
        of_square: Load { force: force.stored(), moment: moment.stored() },
        of_change,
    }
}

/// Adds the part of a load that acts along the axis of a joint; `mass` is that of all bodies beyond the joint.
#[inline(always)]
fn felt<A: Arithmetic>(
    body: &MovingBody,
    load: &BodyOnPath,
    frame: &Frame<F64x4>,
    (gravity, mass): (&[f64; 3], f64),
    terms: &mut PathTerms,
) {
    let axis = Vec3::<Four<A>>::of(&frame.axes[2]);
    let turn_scale = Four::<A>::splat(body.motion.turn_scale);
    let slide_scale = Four::<A>::splat(body.motion.slide_scale);
    let gravity = Vec3::<Four<A>>::splat(gravity);
    let weight = Vec3::<Four<A>>::of(&load.first).cross(gravity).dot(axis) * turn_scale;
    let sliding = axis.dot(gravity) * (Four::splat(mass) * slide_scale);
    terms.hold = (Four::<A>::of(terms.hold) - weight - sliding).stored();
    let [turning, sliding] = [Vec3::of(&load.of_square.moment).dot(axis), Vec3::of(&load.of_square.force).dot(axis)];
    terms.of_square = (turning.mul_add(turn_scale, sliding.mul_add(slide_scale, Four::of(terms.of_square)))).stored();
    let [turning, sliding] = [Vec3::of(&load.of_change.moment).dot(axis), Vec3::of(&load.of_change.force).dot(axis)];
    terms.of_change = (turning.mul_add(turn_scale, sliding.mul_add(slide_scale, Four::of(terms.of_change)))).stored();
}

/// Adds the load on a body to that on its parent, `lever` away.
#[inline(always)]
fn pass_on<A: Arithmetic>(load: &BodyOnPath, lever: Vec3<Four<A>>, mass: f64, parent: &mut BodyOnPath) {
    let first = lever.mul_add(Four::splat(mass), Vec3::of(&load.first));
    parent.first = (Vec3::<Four<A>>::of(&parent.first) + first).stored();
    add::<A>(&load.of_square, lever, &mut parent.of_square);
    add::<A>(&load.of_change, lever, &mut parent.of_change);
}

#[inline(always)]
fn add<A: Arithmetic>(load: &Load, lever: Vec3<Four<A>>, sum: &mut Load) {
    let force = Vec3::<Four<A>>::of(&load.force);
    sum.force = (Vec3::of(&sum.force) + force).stored();
    sum.moment = (Vec3::of(&sum.moment) + Vec3::of(&load.moment) + lever.cross(force)).stored();
}

/// Rotates a vector from the axes of a frame to those of the base.
#[inline(always)]
fn in_base<A: Arithmetic>(frame: &Frame<F64x4>, v: Vec3<Four<A>>) -> Vec3<Four<A>> {
    let along_x = Vec3::<Four<A>>::of(&frame.axes[0]) * v.x;
    Vec3::of(&frame.axes[2]).mul_add(v.z, Vec3::of(&frame.axes[1]).mul_add(v.y, along_x))
}

/// Multiplies a vector in base axes by the inertia of a body about the origin of its frame.
#[inline(always)]
fn turned_inertia<A: Arithmetic>(body: &MovingBody, frame: &Frame<F64x4>, v: Vec3<Four<A>>) -> Vec3<Four<A>> {
    let [x, y, z] = &frame.axes;
    let (along_x, along_y) = (Vec3::<Four<A>>::of(x).dot(v), Vec3::<Four<A>>::of(y).dot(v));
    let along_z = Vec3::<Four<A>>::of(z).dot(v);
    let [s_x, s_y, s_z] = &body.moments.second;
    let spread = (Vec3::<Four<A>>::splat(s_x) * along_x) + (Vec3::splat(s_y) * along_y) + (Vec3::splat(s_z) * along_z);
    let trace = Four::<A>::splat(s_x[0] + s_y[1] + s_z[2]);
    v * trace - in_base::<A>(frame, spread)
}
