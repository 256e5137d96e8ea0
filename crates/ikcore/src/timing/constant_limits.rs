//! Constant limits of each joint, for planners and timings.

use std::f64::consts::PI;

use crate::constraint::{JointTorques, TipRates};
use crate::error::Result;
use crate::limits::{Field, JointOutside, Limits, Profile, TipField};
use crate::math::sampling_range;
use crate::message::Message;
use crate::robot::{JointKind, Robot, limit_rounding};
use crate::trajectory::Trajectory;

/// Constant limits of each joint (n,); infinite if there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstantLimits {
    /// Lower position limits (rad, m).
    pub(crate) lower: Vec<f64>,
    /// Upper position limits (rad, m).
    pub(crate) upper: Vec<f64>,
    /// Velocity limits (rad/s, m/s).
    pub(crate) velocity: Vec<f64>,
    /// Acceleration limits (rad/s^2, m/s^2).
    pub(crate) acceleration: Vec<f64>,
    /// Jerk limits (rad/s^3, m/s^3).
    pub(crate) jerk: Vec<f64>,
    /// Limits of the tips of the robot.
    pub(super) tips: Option<TipRates>,
    /// Limits of the torques of its joints.
    pub(super) torques: Option<JointTorques>,
    /// Names, and kinds where a robot is known.
    pub(super) joints: Vec<(String, Option<JointKind>)>,
}

impl ConstantLimits {
    /// The limits of a path without a robot; `method` names the call in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time and for joints without an acceleration
    /// limit; [`Error::NegativeLimit`](crate::Error::NegativeLimit), [`Error::EmptyRange`](crate::Error::EmptyRange).
    pub fn new(limits: &Limits, method: impl Into<Message>) -> Result<Self> {
        let method = method.into();
        let remedy = "when a point of the path is passed is what it looks for; give numbers";
        limits.refuse_tips(&TipField::ALL, method.clone(), "give the robot whose tips they are")?;
        limits.refuse_torque(method.clone(), "give the robot whose motors they are")?;
        let joints = limits.joint_names().iter().map(|name| (name.clone(), None)).collect();
        let limits = Self::read(limits, joints, method.clone(), remedy)?;
        limits.require_accelerations(method)?;
        Ok(limits)
    }

    /// The limits of a path of `robot`, with those of its tips; `method` names the call in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time, for joints without an acceleration limit,
    /// and for limits of a tip that a rotation vector carries; [`Error::OutOfRange`](crate::Error::OutOfRange) for a limit of zero,
    /// [`Error::EmptyRange`](crate::Error::EmptyRange), [`Error::NegativeLimit`](crate::Error::NegativeLimit), [`Error::WrongLength`](crate::Error::WrongLength).
    pub fn of_path(robot: &Robot, limits: &Limits, method: impl Into<Message>) -> Result<Self> {
        let method = method.into();
        let constant = Self::for_robot(robot, Some(limits), method.clone())?;
        constant.require_accelerations(method)?;
        Ok(constant)
    }

    /// The limits for `robot`; `None` means its own. `method` names the planner in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time, [`Error::OutOfRange`](crate::Error::OutOfRange) for a
    /// velocity, acceleration or jerk limit of zero, [`Error::EmptyRange`](crate::Error::EmptyRange), [`Error::NegativeLimit`](crate::Error::NegativeLimit),
    /// [`Error::WrongLength`](crate::Error::WrongLength).
    pub(crate) fn for_robot(robot: &Robot, limits: Option<&Limits>, method: impl Into<Message>) -> Result<Self> {
        let limits = limits.cloned().unwrap_or_else(|| Limits::of(robot));
        limits.require_for(robot)?;
        let joints = robot.joints().iter().map(|joint| (joint.name.clone(), Some(joint.kind))).collect();
        let method = method.into();
        let tips = TipRates::new(robot, limits.tips(), method.clone())?;
        let torques = JointTorques::new(robot, limits.torque(), method.clone())?;
        let constant = Self::read(&limits, joints, method, "give numbers")?;
        limits.require_unlocked()?;
        let farthest = constant.lower.iter().zip(&constant.upper).map(|(lower, upper)| lower.abs().max(upper.abs()));
        let farthest: Vec<f64> = farthest.collect();
        let tips = tips.and_then(|tips| tips.without_idle([&constant.velocity, &farthest]));
        Ok(Self { tips, torques, ..constant })
    }

    fn read(limits: &Limits, joints: Vec<(String, Option<JointKind>)>, method: Message, remedy: &str) -> Result<Self> {
        limits.validate(0.0, 0)?;
        let constants = |field: Field| {
            let mut values = limits.constants(field, &method, remedy)?;
            values.resize(joints.len(), f64::INFINITY);
            Ok(values)
        };
        Ok(Self {
            lower: constants(Field::Lower)?,
            upper: constants(Field::Upper)?,
            velocity: constants(Field::Velocity)?,
            acceleration: constants(Field::Acceleration)?,
            jerk: constants(Field::Jerk)?,
            tips: None,
            torques: None,
            joints,
        })
    }

    /// Joints that are outside their position limits at the start of `motion`, beyond rounding.
    pub fn start_outside(&self, motion: &Trajectory) -> Vec<JointOutside> {
        let joint = |(j, value): (usize, f64)| {
            let (lower, upper) = (self.lower[j], self.upper[j]);
            let limit = value.clamp(lower, upper);
            let (joint, kind) = &self.joints[j];
            let is_outside = (value - limit).abs() > limit_rounding(lower, upper);
            is_outside.then(|| JointOutside::new(joint.clone(), *kind, value, limit))
        };
        motion.start().into_iter().enumerate().filter_map(joint).collect()
    }

    /// Limits on derivatives of the position, with their names.
    pub(super) fn rates(&self) -> [(&'static str, &[f64]); 3] {
        [("velocity", &self.velocity), ("acceleration", &self.acceleration), ("jerk", &self.jerk)]
    }

    /// Units of a joint's position, velocity, acceleration and jerk.
    pub(super) fn units(&self, joint: usize) -> [&'static str; 4] {
        if self.joints[joint].1.is_none_or(JointKind::turns) {
            ["rad", "rad/s", "rad/s^2", "rad/s^3"]
        } else {
            ["m", "m/s", "m/s^2", "m/s^3"]
        }
    }

    /// Unit of the torque of a joint.
    pub(crate) fn torque_unit(&self, joint: usize) -> &'static str {
        if self.joints[joint].1.is_none_or(JointKind::turns) { "N m" } else { "N" }
    }

    /// Unit of the acceleration of a joint.
    pub(crate) fn acceleration_unit(&self, joint: usize) -> &'static str {
        self.units(joint)[2]
    }

    /// Number of joints.
    pub(crate) fn dof(&self) -> usize {
        self.joints.len()
    }

    /// Name of a joint.
    pub(crate) fn joint_name(&self, joint: usize) -> &str {
        &self.joints[joint].0
    }

    /// Names of all joints.
    pub(crate) fn joint_names(&self) -> Vec<String> {
        self.joints.iter().map(|(name, _)| name.clone()).collect()
    }

    /// The position limits of all joints, moved inwards by `inset` (rad, m), at most to the middle.
    pub(crate) fn inset_positions(&self, inset: f64) -> [Vec<f64>; 2] {
        let widths = self.lower.iter().zip(&self.upper).map(|(lower, upper)| inset.min(0.5 * (upper - lower)));
        let widths: Vec<f64> = widths.collect();
        let moved =
            |bounds: &[f64], sign: f64| bounds.iter().zip(&widths).map(|(bound, by)| bound + sign * by).collect();
        [moved(&self.lower, 1.0), moved(&self.upper, -1.0)]
    }

    /// Range of positions that a search may use for a joint (rad, m): its limits, or half a turn to either side without
    /// them.
    pub(crate) fn finite_range(&self, joint: usize) -> (f64, f64) {
        let (lower, upper) = self.open_range(joint);
        sampling_range::finite(lower, upper, PI)
    }

    /// Position limits of a joint (rad, m), infinite where they count as none.
    pub(crate) fn open_range(&self, joint: usize) -> (f64, f64) {
        sampling_range::opened(self.lower[joint], self.upper[joint])
    }

    /// Time (s) of the slowest joint through its range, at full speed or from rest to rest at full acceleration or jerk.
    pub(crate) fn whole_range_time(&self) -> f64 {
        let time = |j: usize| {
            let (lower, upper) = self.finite_range(j);
            let range = upper - lower;
            let by_jerk = (32.0 * range / self.jerk[j]).cbrt();
            (range / self.velocity[j]).max(2.0 * (range / self.acceleration[j]).sqrt()).max(by_jerk)
        };
        (0..self.dof()).map(time).fold(0.0, f64::max)
    }

    /// Returns `robot` with these position limits.
    ///
    /// # Errors
    /// [`Error::InvalidRobot`](crate::Error::InvalidRobot) where a joint that leads others by a polynomial has no limits.
    pub(crate) fn applied_to(&self, robot: &Robot) -> Result<Robot> {
        robot.with_limits(|j, joint| (joint.lower, joint.upper) = (self.lower[j], self.upper[j]))
    }

    /// The limits of `robot` with these position limits.
    ///
    /// # Errors
    /// None in practice: the limits were checked.
    pub(crate) fn position_limits(&self, robot: &Robot) -> Result<Limits> {
        Limits::of(robot).with_positions(&self.lower, &self.upper)
    }

    /// The limits of `robot`, or those `given`, with position limits widened to the start `q` (n,).
    ///
    /// # Errors
    /// None in practice: the limits were checked.
    pub(crate) fn widened_to(&self, robot: &Robot, given: Option<&Limits>, q: &[f64]) -> Result<Limits> {
        let widened = |values: &[f64], wider: fn(f64, f64) -> f64| {
            values.iter().zip(q).map(|(limit, q)| Profile::Constant(wider(*limit, *q))).collect()
        };
        let limits = given.cloned().unwrap_or_else(|| Limits::of(robot));
        limits
            .replace(Field::Lower, widened(&self.lower, f64::min))?
            .replace(Field::Upper, widened(&self.upper, f64::max))
    }

    /// Whether `q` (n,) is inside the position limits, but for rounding.
    pub(crate) fn contain(&self, q: &[f64]) -> bool {
        self.excess(q).is_none()
    }

    /// The first joint that is beyond its limits by more than rounding, and its value.
    pub(crate) fn excess(&self, q: &[f64]) -> Option<(usize, f64)> {
        let is_inside = |(j, value): &(usize, f64)| {
            let (lower, upper) = (self.lower[*j], self.upper[*j]);
            let rounding = limit_rounding(lower, upper);
            lower - rounding <= *value && *value <= upper + rounding
        };
        q.iter().copied().enumerate().find(|joint| !is_inside(joint))
    }

    /// Moves each joint to the limit that it is beyond.
    pub(crate) fn clip(&self, q: &mut [f64]) {
        for ((q, lower), upper) in q.iter_mut().zip(&self.lower).zip(&self.upper) {
            *q = q.clamp(*lower, *upper);
        }
    }
}
