//! Constant limits of each joint, for planners.

use std::f64::consts::PI;

use super::violation::Violation;
use crate::error::{Error, Result};
use crate::limits::{Field, Limits};
use crate::math::sampling_range;
use crate::robot::{JointKind, Robot};
use crate::trajectory::Trajectory;

/// Constant limits of each joint (n,); infinite if there is none.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MotionLimits {
    /// Lower position limits (rad, m).
    pub lower: Vec<f64>,
    /// Upper position limits (rad, m).
    pub upper: Vec<f64>,
    /// Velocity limits (rad/s, m/s).
    pub velocity: Vec<f64>,
    /// Acceleration limits (rad/s^2, m/s^2).
    pub acceleration: Vec<f64>,
    joints: Vec<(String, JointKind)>,
}

/// Relative excess over a limit that counts as rounding of the polynomial coefficients.
const ROUNDING: f64 = 1e-9;

impl MotionLimits {
    /// The limits for `robot`; `None` means its own. `method` names the planner in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`] for jerk limits and limits that vary over time, [`Error::OutOfRange`] for a velocity
    /// or acceleration limit of zero, [`Error::EmptyRange`], [`Error::NegativeLimit`], [`Error::WrongLength`].
    pub(crate) fn new(robot: &Robot, limits: Option<&Limits>, method: &str) -> Result<Self> {
        let limits = limits.cloned().unwrap_or_else(|| Limits::of(robot));
        limits.require_for(robot)?;
        limits.require_none(&[Field::Jerk], method, "retime the plan with a jerk limit afterwards")?;
        limits.validate(0.0, 0)?;
        let constants = |field: Field| limits.constants(field, method, "give numbers");
        let joints = robot.joints().iter().map(|joint| (joint.name.clone(), joint.kind)).collect();
        let mut acceleration = constants(Field::Acceleration)?;
        acceleration.resize(robot.dof(), f64::INFINITY);
        let limits = Self {
            lower: constants(Field::Lower)?,
            upper: constants(Field::Upper)?,
            velocity: constants(Field::Velocity)?,
            acceleration,
            joints,
        };
        limits.require_motion()?;
        Ok(limits)
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

    /// Range of positions that a search may use for a joint (rad, m): its limits, or half a turn to either side without
    /// them.
    pub(crate) fn finite_range(&self, joint: usize) -> (f64, f64) {
        let (lower, upper) = sampling_range::opened(self.lower[joint], self.upper[joint]);
        sampling_range::finite(lower, upper, PI)
    }

    /// Time (s) of the slowest joint through its range, at full speed or from rest to rest at full acceleration.
    pub(crate) fn whole_range_time(&self) -> f64 {
        let time = |j: usize| {
            let (lower, upper) = self.finite_range(j);
            let range = upper - lower;
            (range / self.velocity[j]).max(2.0 * (range / self.acceleration[j]).sqrt())
        };
        (0..self.dof()).map(time).fold(0.0, f64::max)
    }

    /// `robot` with these position limits.
    ///
    /// # Errors
    /// None in practice: the limits were checked.
    pub(crate) fn applied_to(&self, robot: &Robot) -> Result<Robot> {
        robot.with_limits(|j, joint| (joint.lower, joint.upper) = (self.lower[j], self.upper[j]))
    }

    /// Checks that every joint has a velocity limit, which `method` needs.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub(crate) fn require_velocities(&self, method: &str) -> Result<()> {
        match self.velocity.iter().position(|limit| limit.is_infinite()) {
            None => Ok(()),
            Some(j) => {
                let what = format!("velocity limit of joint '{}'", self.joint_name(j));
                let requirement = format!("finite for {method}: give limits=Limits(velocity=...)");
                Err(Error::out_of_range(what, &requirement, self.velocity[j]))
            }
        }
    }

    /// Returns the limits that `trajectory` violates, by the exact extremes of its polynomials.
    pub(crate) fn violations(&self, trajectory: &Trajectory) -> Vec<Violation> {
        let (velocity, acceleration) = (trajectory.max_velocity(), trajectory.max_acceleration());
        let mut found = vec![];
        for (j, (lowest, highest)) in trajectory.position_range().into_iter().enumerate() {
            let units = if self.joints[j].1.turns() { ["rad", "rad/s", "rad/s^2"] } else { ["m", "m/s", "m/s^2"] };
            let checks = [
                ("lowest position", lowest, self.lower[j], self.lower[j] - lowest, units[0]),
                ("highest position", highest, self.upper[j], highest - self.upper[j], units[0]),
                ("velocity", velocity[j], self.velocity[j], velocity[j] - self.velocity[j], units[1]),
                (
                    "acceleration",
                    acceleration[j],
                    self.acceleration[j],
                    acceleration[j] - self.acceleration[j],
                    units[2],
                ),
            ];
            for (quantity, value, bound, excess, unit) in checks {
                if excess > ROUNDING * bound.abs().max(1.0) {
                    let what = format!("{quantity} of joint '{}'", self.joint_name(j));
                    found.push(Violation { what, value, bound, unit: unit.into() });
                }
            }
        }
        found
    }

    /// Checks that no joint is locked by a zero limit.
    fn require_motion(&self) -> Result<()> {
        for (name, values) in [("velocity", &self.velocity), ("acceleration", &self.acceleration)] {
            if let Some(j) = values.iter().position(|value| *value <= 0.0) {
                let what = format!("{name} limit of joint '{}'", self.joint_name(j));
                return Err(Error::out_of_range(what, "positive", values[j]));
            }
        }
        Ok(())
    }
}
