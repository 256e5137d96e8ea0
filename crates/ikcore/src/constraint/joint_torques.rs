//! Limits of joint torques, and their certificate over a motion.
//!
//! Along a path q(s) the torque of a joint is a(s) d2s/dt2 + b(s) (ds/dt)^2 + g(s). Over an interval each factor is within a remainder
//! ([`TorqueBend`]) of the parabola through its values at both ends and in the middle, and a parabola is within its Bernstein coefficients.
//! Friction is added: viscous friction against the motion, dry friction in both directions, since a joint at rest may start either way.

use std::sync::Arc;

use smallvec::SmallVec;

use super::joint_span::JointSpan;
use super::largest_factor::{IntervalFactor, TIGHT, is_at_most, largest_factor};
use super::tip_jet::why_no_jets;
use super::torque_bend::{BendScratch, HOLD_AND_SQUARE, Rest, TorqueBend};
use crate::dynamics::{DynamicState, Dynamics, DynamicsScratch};
use crate::error::{Error, Result};
use crate::limits::ROUNDING;
use crate::math::majorant::Majorant;
use crate::message::Message;
use crate::robot::Robot;
use crate::trajectory::{Coefficients, Trajectory};

/// Robot and limits of its joint torques.
#[derive(Debug, Clone)]
pub(crate) struct JointTorques {
    robot: Arc<Robot>,
    dynamics: Arc<Dynamics>,
    bend: Arc<TorqueBend>,
    /// One per joint (N m, N), infinite without.
    limits: Vec<f64>,
}

/// Derivatives of a path as velocities and accelerations.
#[derive(Debug, Clone, Copy)]
enum Derivatives {
    /// The first and the second.
    Both,
    /// None, and the first.
    FirstAsAcceleration,
}

/// Friction of a joint: dry (N m, N), and per velocity (N m s/rad, N s/m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Friction {
    pub dry: f64,
    pub damping: f64,
}

/// Friction along a path, against a torque of one sign: at most `at_rest` + `per_square` (ds/dt)^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drag {
    pub at_rest: f64,
    pub per_square: f64,
}

impl Friction {
    /// Bounds the friction of a joint that moves at up to `rate` per ds/dt against torques that leave `room`, where (ds/dt)^2 is at most
    /// `square`: its root is below any of its tangents.
    pub fn drag(&self, rate: f64, room: f64, square: f64) -> Drag {
        let viscous = self.damping * rate.max(0.0);
        if viscous == 0.0 {
            return Drag { at_rest: self.dry, per_square: 0.0 };
        }
        // The tangent where the speed is largest, or where friction at rest takes half of the room.
        let speed = square.sqrt().min((room - self.dry).max(0.0) / viscous);
        Drag { at_rest: self.dry + 0.5 * viscous * speed, per_square: 0.5 * viscous / speed }
    }
}

/// Terms of the torques of all joints at a point of a path.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TorqueTerms {
    /// Factors of d2s/dt2.
    pub of_change: ByJoint,
    /// Factors of (ds/dt)^2.
    pub of_square: ByJoint,
    /// Torques that hold the arm.
    pub hold: ByJoint,
}

/// One number per joint, on the stack up to eight joints.
type ByJoint = SmallVec<[f64; 8]>;

/// A torque beyond its limit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TorqueExcess {
    pub joint: usize,
    pub value: f64,
    pub bound: f64,
}

/// A configuration in which a joint cannot hold the arm, or not move it against dry friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TooHeavy {
    pub joint: usize,
    /// Size of the torque that holds the arm (N m, N).
    pub torque: f64,
    /// Dry friction, against which the joint moves (N m, N).
    pub friction: f64,
    pub limit: f64,
}

/// Positions of all joints and their first two derivatives, and scratch memory for the torques there.
#[derive(Debug, Clone)]
pub(crate) struct TorquePoint {
    pub q: Vec<f64>,
    pub first: Vec<f64>,
    pub second: Vec<f64>,
    zero: Vec<f64>,
    scratch: DynamicsScratch,
}

impl PartialEq for JointTorques {
    fn eq(&self, other: &Self) -> bool {
        self.limits == other.limits && self.bend == other.bend
    }
}

impl TorqueTerms {
    fn new(joints: usize) -> Self {
        let zero = ByJoint::from_elem(0.0, joints);
        Self { of_change: zero.clone(), of_square: zero.clone(), hold: zero }
    }
}

impl JointTorques {
    /// The limits (n,) of `robot`; `None` without finite ones. `method` names the call in errors.
    ///
    /// # Errors
    /// Those of [`Robot::dynamics`]; [`Error::UnsupportedLimit`] for a base that floats, and for a joint that follows another by a
    /// polynomial.
    pub fn new(robot: &Robot, limits: &[f64], method: impl Into<Message>) -> Result<Option<Self>> {
        if !limits.iter().any(|limit| limit.is_finite()) {
            return Ok(None);
        }
        if robot.moving_elements().any(|(.., motion)| !motion.is_linear()) {
            let remedy = format!("{}leave out the torque limits", why_no_jets(robot)).into();
            return Err(Error::UnsupportedLimit { field: "torque".into(), method: method.into(), remedy });
        }
        let dynamics = Arc::new(robot.dynamics()?.clone());
        let bend = Arc::new(TorqueBend::new(robot, &dynamics));
        Ok(Some(Self { robot: Arc::new(robot.clone()), dynamics, bend, limits: limits.to_vec() }))
    }

    /// The limits (n,), infinite where there is none.
    pub fn limits(&self) -> &[f64] {
        &self.limits
    }

    /// Friction of a joint.
    pub fn friction(&self, joint: usize) -> Friction {
        let drive = &self.dynamics.drives()[joint];
        Friction { dry: drive.friction, damping: drive.damping }
    }

    /// Number of joints.
    pub fn dof(&self) -> usize {
        self.limits.len()
    }

    /// Robot whose joints these are.
    pub(super) fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Its bodies.
    pub(super) fn dynamics(&self) -> &Dynamics {
        &self.dynamics
    }

    /// Room for a point.
    pub fn point(&self) -> TorquePoint {
        let zero = vec![0.0; self.dof()];
        let [q, first, second] = [zero.clone(), zero.clone(), zero.clone()];
        TorquePoint { q, first, second, zero, scratch: self.robot.dynamics_scratch(&self.dynamics) }
    }

    /// Room for terms.
    pub fn terms(&self) -> TorqueTerms {
        TorqueTerms::new(self.dof())
    }

    /// Room for [`rests`](Self::rests).
    pub fn bend_scratch(&self) -> BendScratch {
        self.bend.scratch()
    }

    /// Writes the terms at a point.
    pub fn write_terms(&self, at: &mut TorquePoint, terms: &mut TorqueTerms) {
        self.write_hold(at, &mut terms.hold);
        self.write_square(at, terms);
        self.inverse(at, Derivatives::FirstAsAcceleration, &mut terms.of_change);
        terms.of_change.iter_mut().zip(&terms.hold).for_each(|(torque, hold)| *torque -= hold);
    }

    /// Writes the torques without friction, with the first two derivatives as velocities and accelerations.
    pub fn write_torques(&self, at: &mut TorquePoint, torques: &mut [f64]) {
        self.robot.write_frames(&at.q, &mut at.scratch.frames);
        self.inverse(at, Derivatives::Both, torques);
    }

    /// Writes the torques that hold the arm at a point.
    pub(super) fn write_hold(&self, at: &mut TorquePoint, hold: &mut [f64]) {
        self.robot.write_frames(&at.q, &mut at.scratch.frames);
        self.dynamics.holding(&mut at.scratch, hold);
    }

    /// Writes the torques that hold the arm at a point, and their gradients (n, n), one row per torque.
    pub fn write_hold_and_gradients(&self, at: &mut TorquePoint, hold: &mut [f64], gradients: &mut [f64]) {
        self.write_hold(at, hold);
        gradients.fill(0.0);
        let TorquePoint { first: rates, scratch, .. } = at;
        // The matrix is symmetric: its columns, which are computed, are its rows.
        for (joint, gradient) in gradients.chunks_exact_mut(self.dof()).enumerate() {
            rates.fill(0.0);
            rates[joint] = 1.0;
            self.dynamics.add_holding_slope(scratch, rates, gradient);
        }
    }

    /// Writes the factors of (ds/dt)^2.
    fn write_square(&self, at: &mut TorquePoint, terms: &mut TorqueTerms) {
        self.inverse(at, Derivatives::Both, &mut terms.of_square);
        terms.of_square.iter_mut().zip(&terms.hold).for_each(|(torque, hold)| *torque -= hold);
    }

    /// Writes the torques with these derivatives as velocities and accelerations.
    fn inverse(&self, at: &mut TorquePoint, derivatives: Derivatives, torques: &mut [f64]) {
        let TorquePoint { q, first, second, zero, scratch } = at;
        let [qd, qdd] = match derivatives {
            Derivatives::Both => [&*first, &*second],
            Derivatives::FirstAsAcceleration => [&*zero, &*first],
        };
        self.dynamics.inverse_without_friction(&DynamicState { q, qd, qdd }, &[], scratch, torques);
    }

    /// Writes the remainders of all joints over an interval on which the derivatives of the joints' positions have these majorants and the
    /// joints are at most this far from zero; those of other factors stay unchanged.
    pub fn rests<const FACTORS: usize>(
        &self,
        rates: impl Fn(usize) -> Majorant,
        farthest: impl Fn(usize) -> f64,
        scratch: &mut BendScratch,
        rests: &mut [Rest],
    ) {
        self.bend.rests::<FACTORS>(rates, farthest, scratch, rests);
    }

    /// Returns the joint that is, with dry friction, farthest beyond its limit when holding the arm at `q` (n,), if any.
    pub fn too_heavy(&self, at: &mut TorquePoint, q: &[f64]) -> Option<TooHeavy> {
        at.q.copy_from_slice(q);
        let mut hold = std::mem::take(&mut at.second);
        self.write_hold(at, &mut hold);
        let found = self.beyond(&hold);
        at.second = hold;
        found
    }

    /// Returns the holding torque that is, with dry friction, farthest beyond its limit.
    pub fn beyond(&self, torques: &[f64]) -> Option<TooHeavy> {
        let found = |(joint, (torque, limit)): (usize, (&f64, &f64))| {
            let friction = self.friction(joint).dry;
            // NaN, the sum of infinite torques, is beyond any limit.
            let is_beyond = !(torque.abs() + friction <= limit * (1.0 - TIGHT));
            is_beyond.then_some(TooHeavy { joint, torque: torque.abs(), friction, limit: *limit })
        };
        let share = |found: &TooHeavy| (found.torque + found.friction) / found.limit;
        let all = torques.iter().zip(&self.limits).enumerate().filter_map(found);
        all.max_by(|one, other| share(one).total_cmp(&share(other)))
    }

    /// Factor by which `motion` must be slowed down to keep the limits, or a bound of it up to `enough`; infinite if a joint cannot hold the arm
    /// somewhere.
    pub fn slowdown(&self, motion: &Trajectory, enough: f64) -> f64 {
        largest_factor(motion, enough, &mut TorqueFactor::new(self, Judged::Slowdown))
    }

    /// Whether `motion` keeps the limits.
    pub fn keeps(&self, motion: &Trajectory) -> bool {
        is_at_most(motion, 1.0 + ROUNDING, &mut TorqueFactor::new(self, Judged::Share(None)))
    }

    /// Torques of `motion` beyond their limits.
    pub fn excesses(&self, motion: &Trajectory) -> Vec<TorqueExcess> {
        let enough = 1.0 + ROUNDING;
        if self.keeps(motion) {
            return vec![];
        }
        let share = |judged| largest_factor(motion, enough, &mut TorqueFactor::new(self, judged));
        let limited = (0..self.dof()).filter(|joint| self.limits[*joint].is_finite());
        let excess = |joint: usize| {
            let share = share(Judged::Share(Some(joint)));
            let bound = self.limits[joint];
            (share > enough).then_some(TorqueExcess { joint, value: share * bound, bound })
        };
        limited.filter_map(excess).collect()
    }

    /// The parts of the limits that joints on these polynomials use at `t` (s).
    pub fn shares(&self, polynomials: &[Coefficients], t: f64) -> Vec<f64> {
        let (mut point, mut terms) = (self.point(), self.terms());
        let mut span = JointSpan::new(&self.robot);
        span.set_joints(polynomials.iter().copied(), [t, 1.0]);
        span.write(0.0, [&mut point.q, &mut point.first, &mut point.second]);
        self.write_hold(&mut point, &mut terms.hold);
        self.write_square(&mut point, &mut terms);
        let share = |(joint, limit): (usize, &f64)| {
            let (torque, rate) = (terms.hold[joint] + terms.of_square[joint], point.first[joint]);
            let Friction { dry, damping } = self.friction(joint);
            (torque.abs().max((torque + damping * rate).abs()) + dry) / limit
        };
        self.limits.iter().enumerate().map(share).collect()
    }
}

/// Quantity that a [`TorqueFactor`] bounds.
#[derive(Debug, Clone, Copy)]
enum Judged {
    /// Factor by which the motion must be slower.
    Slowdown,
    /// The largest part of the limit of a joint, or of any.
    Share(Option<usize>),
}

/// Torques over intervals of a motion.
struct TorqueFactor<'a> {
    torques: &'a JointTorques,
    judged: Judged,
    span: JointSpan,
    point: TorquePoint,
    /// At both ends and in the middle.
    nodes: [TorqueTerms; 3],
    rests: Vec<Rest>,
    bend: BendScratch,
}

impl<'a> TorqueFactor<'a> {
    fn new(torques: &'a JointTorques, judged: Judged) -> Self {
        Self {
            torques,
            judged,
            span: JointSpan::new(&torques.robot),
            point: torques.point(),
            nodes: [(); 3].map(|()| torques.terms()),
            rests: vec![[0.0; 3]; torques.dof()],
            bend: torques.bend_scratch(),
        }
    }
}

impl IntervalFactor for TorqueFactor<'_> {
    const ACCURACY: f64 = 1e-3;

    fn over(&mut self, polynomials: &[Coefficients], [middle, half]: [f64; 2]) -> [f64; 2] {
        let Self { torques, judged, span, point, nodes, rests, bend } = self;
        span.set_joints(polynomials.iter().copied(), [middle, half]);
        let per_second = 1.0 / half;
        for (x, terms) in [-1.0, 0.0, 1.0].into_iter().zip(nodes.iter_mut()) {
            span.write(x, [&mut point.q, &mut point.first, &mut point.second]);
            // To seconds before torques are subtracted from one another: the rounding of that would grow without end in short intervals.
            point.first.iter_mut().for_each(|rate| *rate *= per_second);
            point.second.iter_mut().for_each(|change| *change *= per_second * per_second);
            torques.write_hold(point, &mut terms.hold);
            torques.write_square(point, terms);
        }
        torques.rests::<HOLD_AND_SQUARE>(|joint| span.rates(joint), |joint| span.farthest(joint), bend, rests);
        let [mut seen, mut bound] = [0.0_f64; 2];
        for (joint, limit) in torques.limits.iter().enumerate() {
            if *limit == f64::INFINITY || matches!(judged, Judged::Share(Some(only)) if *only != joint) {
                continue;
            }
            let of_motion = control_points(nodes.each_ref().map(|terms| terms.of_square[joint]));
            let hold = control_points(nodes.each_ref().map(|terms| terms.hold[joint]));
            let [rest_of_hold, rest_of_motion, _] = rests[joint];
            let rest = [per_second * per_second * rest_of_motion, rest_of_hold];
            let friction = torques.friction(joint);
            let factor = |of_motion: f64, hold: f64, rest: [f64; 2], [slowest, fastest]: [f64; 2]| {
                let of_side = |sign: f64, rate: f64| {
                    let viscous = friction.damping * rate.max(0.0);
                    let [inertial, left] = [sign * of_motion + rest[0], limit - sign * hold - rest[1] - friction.dry];
                    match judged {
                        Judged::Slowdown => slowdown(inertial, viscous, left),
                        Judged::Share(_) => (inertial + viscous + limit - left) / limit,
                    }
                };
                of_side(1.0, fastest).max(of_side(-1.0, -slowest))
            };
            let rate = span.rate(joint, 0.0) * per_second;
            seen = seen.max(factor(nodes[1].of_square[joint], nodes[1].hold[joint], [0.0; 2], [rate; 2]));
            let rates = span.rate_range(joint).map(|rate| rate * per_second);
            for (of_motion, hold) in of_motion.into_iter().zip(hold) {
                bound = bound.max(factor(of_motion, hold, rest, rates));
            }
        }
        [seen, bound.max(seen)]
    }
}

/// The Bernstein coefficients of the parabola with these values at the start, in the middle and at the end of an interval.
pub(crate) fn control_points([start, middle, end]: [f64; 3]) -> [f64; 3] {
    [start, 2.0 * middle - 0.5 * (start + end), end]
}

/// The slowdown of a motion that needs the torque `inertial` / slowdown^2 + `viscous` / slowdown, of which `left` is there.
fn slowdown(inertial: f64, viscous: f64, left: f64) -> f64 {
    if left <= 0.0 {
        return f64::INFINITY;
    }
    let half = 0.5 * viscous;
    (half + (half * half + inertial.max(0.0) * left).sqrt()) / left
}
