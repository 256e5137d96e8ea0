//! The limits of all joints, and their checks.

use serde::{Deserialize, Serialize};

use super::field::Field;
use super::profile::Profile;
use super::tip_limits::{TipField, TipLimits};
use crate::error::{Error, Result};
use crate::message::{Message, Setting, message};
use crate::objective::Bounds;
use crate::robot::{Joint, Robot};

/// Excess over a limit that counts as rounding: relative, for positions below 1 absolute (rad, m).
pub(crate) const ROUNDING: f64 = 1e-9;

/// The limits of all joints: a function of time for each joint and field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    joints: Vec<String>,
    pub(super) lower: Vec<Profile>,
    pub(super) upper: Vec<Profile>,
    pub(super) velocity: Vec<Profile>,
    pub(super) acceleration: Option<Vec<Profile>>,
    pub(super) jerk: Option<Vec<Profile>>,
    /// Whether the velocity limits are those of the robot. Infinite ones that were given are meant.
    #[serde(skip)]
    pub(super) own_velocity: bool,
    /// Limits of tips.
    tips: TipLimits,
    /// Torque (N m, N), one per joint; empty without limits.
    torque: Vec<f64>,
}

impl Limits {
    /// The robot's own limits: positions and velocities.
    pub fn of(robot: &Robot) -> Self {
        let joints = robot.joints();
        Self {
            joints: joints.iter().map(|joint| joint.name.clone()).collect(),
            lower: joints.iter().map(|joint| Profile::Constant(joint.lower)).collect(),
            upper: joints.iter().map(|joint| Profile::Constant(joint.upper)).collect(),
            velocity: joints.iter().map(|joint| Profile::Constant(joint.velocity)).collect(),
            acceleration: None,
            jerk: None,
            own_velocity: true,
            tips: TipLimits::default(),
            torque: vec![],
        }
    }

    /// These limits with other positions (rad, m).
    ///
    /// # Errors
    /// As [`replace`](Self::replace).
    pub(crate) fn with_positions(self, lower: &[f64], upper: &[f64]) -> Result<Self> {
        let constant = |values: &[f64]| values.iter().map(|value| Profile::Constant(*value)).collect();
        self.replace(Field::Lower, constant(lower))?.replace(Field::Upper, constant(upper))
    }

    /// The robot's own limits, with its maker's limits on acceleration and jerk where these are known.
    pub fn rated(robot: &Robot) -> Self {
        let of = |value: fn(&Joint) -> f64| {
            let values: Vec<f64> = robot.joints().iter().map(value).collect();
            let known = values.iter().any(|value| value.is_finite());
            known.then(|| values.into_iter().map(Profile::Constant).collect())
        };
        Self {
            acceleration: of(|joint| joint.rated_acceleration),
            jerk: of(|joint| joint.rated_jerk),
            ..Self::of(robot)
        }
    }

    /// No limits, for `n` joints that are named by their indices (from 0).
    pub fn none_for(n: usize) -> Self {
        Self::none((0..n).map(|j| j.to_string()).collect())
    }

    /// No limits, for joints of these names.
    pub fn none(joints: Vec<String>) -> Self {
        let all = |value: f64| vec![Profile::Constant(value); joints.len()];
        let (lower, upper, velocity) = (all(f64::NEG_INFINITY), all(f64::INFINITY), all(f64::INFINITY));
        Self {
            joints,
            lower,
            upper,
            velocity,
            acceleration: None,
            jerk: None,
            own_velocity: false,
            tips: TipLimits::default(),
            torque: vec![],
        }
    }

    /// Replaces one field for all joints, with one profile per joint or a single one for all of them.
    ///
    /// # Errors
    /// [`Error::WrongLength`] for a wrong number of profiles or a profile without samples, [`Error::OutOfRange`] for
    /// NaN, [`Error::NotFinite`] for a sinusoid with a parameter that is not finite.
    pub fn replace(mut self, field: Field, mut profiles: Vec<Profile>) -> Result<Self> {
        let n = self.joints.len();
        if profiles.len() == 1 {
            profiles = vec![profiles[0].clone(); n];
        }
        if profiles.len() != n {
            let expected = format!("one number, or {n} (one per joint)");
            return Err(Error::WrongLength { what: format!("{field} limit").into(), expected, got: profiles.len() });
        }
        for (profile, joint) in profiles.iter().zip(&self.joints) {
            profile.validate(&format!("{field} limit of joint '{joint}'"))?;
        }
        match field {
            Field::Lower => self.lower = profiles,
            Field::Upper => self.upper = profiles,
            Field::Velocity => (self.velocity, self.own_velocity) = (profiles, false),
            Field::Acceleration => self.acceleration = Some(profiles),
            Field::Jerk => self.jerk = Some(profiles),
        }
        Ok(self)
    }

    /// Replaces the limits of one kind on the motion of tips (m/s, m/s^2, rad/s), with one number for all tips or one per tip; infinite
    /// where a tip has none.
    ///
    /// # Errors
    /// [`Error::WrongLength`] without a number, [`Error::OutOfRange`] unless they are positive.
    pub fn with_tip_limit(mut self, field: TipField, values: Vec<f64>) -> Result<Self> {
        self.tips.replace(field, values)?;
        Ok(self)
    }

    /// The limits of one kind on the motion of tips, one number or one per tip; empty without any.
    pub fn of_tips(&self, field: TipField) -> &[f64] {
        self.tips.of(field)
    }

    /// Replaces the torque limits (N m, N) of all joints, with one number per joint or a single one for all of them; infinite without a limit.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::OutOfRange`] unless they are positive.
    pub fn with_torque_limit(mut self, mut values: Vec<f64>) -> Result<Self> {
        let n = self.joints.len();
        if let [all] = values[..] {
            values = vec![all; n];
        }
        if values.len() != n {
            let expected = format!("one number, or {n} (one per joint)");
            return Err(Error::WrongLength { what: "torque limit".into(), expected, got: values.len() });
        }
        if let Some(joint) = values.iter().position(|value| !(*value > 0.0)) {
            let what = format!("torque limit of joint '{}'", self.joints[joint]);
            return Err(Error::out_of_range(what, "positive", values[joint]));
        }
        self.torque = values;
        Ok(self)
    }

    /// The torque limits (N m, N), one per joint; empty without any.
    pub fn torque(&self) -> &[f64] {
        &self.torque
    }

    /// Checks that no joint has a torque limit, which `method` does not keep.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub(crate) fn refuse_torque(&self, method: impl Into<Message>, remedy: impl Into<Message>) -> Result<()> {
        if !self.torque.iter().any(|limit| limit.is_finite()) {
            return Ok(());
        }
        let remedy = message![remedy.into(), ", or leave out ", Setting::Limit("torque")];
        Err(Error::UnsupportedLimit { field: "torque".into(), method: method.into(), remedy })
    }

    /// The limits of tips.
    pub(crate) fn tips(&self) -> &TipLimits {
        &self.tips
    }

    /// The profiles of a field, one per joint; `None` without such limits.
    pub fn field(&self, field: Field) -> Option<&[Profile]> {
        match field {
            Field::Lower => Some(&self.lower),
            Field::Upper => Some(&self.upper),
            Field::Velocity => Some(&self.velocity),
            Field::Acceleration => self.acceleration.as_deref(),
            Field::Jerk => self.jerk.as_deref(),
        }
    }

    /// The constant limits that are inside these from `from` to `to` (s).
    ///
    /// # Errors
    /// None in practice: the limits were checked.
    pub(crate) fn narrowest(&self, from: f64, to: f64) -> Result<Self> {
        let mut narrowest =
            Self { tips: self.tips.clone(), torque: self.torque.clone(), ..Self::none(self.joints.clone()) };
        let ranges: Vec<[f64; 2]> = (0..self.joints.len()).map(|j| self.position_range(j, from, to)).collect();
        let constants = |values: Vec<f64>| values.into_iter().map(Profile::Constant).collect();
        narrowest = narrowest.replace(Field::Lower, constants(ranges.iter().map(|range| range[0]).collect()))?;
        narrowest = narrowest.replace(Field::Upper, constants(ranges.iter().map(|range| range[1]).collect()))?;
        for field in [Field::Velocity, Field::Acceleration, Field::Jerk] {
            let smallest = self.field(field).unwrap_or_default().iter().map(|profile| profile.smallest(from, to).1);
            let smallest: Vec<f64> = smallest.collect();
            if !smallest.is_empty() {
                narrowest = narrowest.replace(field, constants(smallest))?;
            }
        }
        Ok(narrowest)
    }

    /// Checks, for `ticks` ticks of `dt` (s) or for t = 0 alone, that no velocity, acceleration or jerk limit is
    /// negative and that the position range of every joint is never empty.
    ///
    /// # Errors
    /// [`Error::NegativeLimit`] and [`Error::EmptyRange`] name the joint and the time.
    pub fn validate(&self, dt: f64, ticks: usize) -> Result<()> {
        for field in [Field::Velocity, Field::Acceleration, Field::Jerk] {
            for (profile, joint) in self.field(field).unwrap_or_default().iter().zip(&self.joints) {
                let (time, value) = profile.smallest(0.0, ticks as f64 * dt);
                if value < 0.0 {
                    return Err(Error::NegativeLimit { field: field.to_string(), joint: joint.clone(), value, time });
                }
            }
        }
        (0..self.joints.len()).try_for_each(|j| self.validate_range(j, dt, ticks))
    }

    fn validate_range(&self, j: usize, dt: f64, ticks: usize) -> Result<()> {
        let constant = matches!((&self.lower[j], &self.upper[j]), (Profile::Constant(_), Profile::Constant(_)));
        let last = if constant { 0 } else { ticks };
        for i in 0..=last {
            let (from, to) = (i.saturating_sub(1) as f64 * dt, i as f64 * dt);
            let [lower, upper] = self.position_range(j, from, to);
            if !(lower <= upper) || lower == f64::INFINITY || upper == f64::NEG_INFINITY {
                let time = (!constant).then_some(from);
                return Err(Error::EmptyRange { joint: self.joints[j].clone(), lower, upper, time });
            }
        }
        Ok(())
    }

    /// Checks that no field is set that `method` does not support.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub(crate) fn require_none(&self, fields: &[Field], method: &str, remedy: &str) -> Result<()> {
        match fields.iter().find(|field| self.is_finite(**field)) {
            None => Ok(()),
            Some(field) => {
                Err(Error::UnsupportedLimit { field: field.to_string(), method: method.into(), remedy: remedy.into() })
            }
        }
    }

    /// Checks that no tip has a limit of these kinds, which `method` does not keep.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub(crate) fn refuse_tips(
        &self,
        fields: &[TipField],
        method: impl Into<Message>,
        remedy: impl Into<Message>,
    ) -> Result<()> {
        self.tips.refuse(fields, method, remedy)
    }

    /// These limits without those of tips and torques.
    pub(crate) fn of_joint_motion(self) -> Self {
        Self { tips: TipLimits::default(), torque: vec![], ..self }
    }

    /// These limits with constant accelerations and jerks reduced to this part.
    pub(crate) fn eased(&self, part: f64) -> Self {
        self.with_changes(|all| all.iter_mut().for_each(|limit| *limit *= part))
    }

    /// These limits with constant accelerations and jerks in proportion to these velocities: joints that brake with them stop together, on a
    /// straight line. Those of joints at rest stay.
    pub(crate) fn in_proportion(&self, velocity: &[f64]) -> Self {
        self.with_changes(|all| {
            let moving = || velocity.iter().enumerate().filter(|(_, rate)| **rate != 0.0);
            let least = moving().map(|(j, rate)| all[j] / rate.abs()).fold(f64::INFINITY, f64::min);
            moving().filter(|_| least.is_finite()).for_each(|(j, rate)| all[j] = least * rate.abs());
        })
    }

    /// These limits with other accelerations and jerks, where these are constant.
    fn with_changes(&self, change: impl Fn(&mut [f64])) -> Self {
        let changed = |profiles: &Option<Vec<Profile>>| {
            let constant = |profile: &Profile| if let Profile::Constant(value) = profile { Some(*value) } else { None };
            let values: Option<Vec<f64>> = profiles.as_ref()?.iter().map(constant).collect();
            let Some(mut values) = values else { return profiles.clone() };
            change(&mut values);
            Some(values.into_iter().map(Profile::Constant).collect())
        };
        Self { acceleration: changed(&self.acceleration), jerk: changed(&self.jerk), ..self.clone() }
    }

    /// Returns the values of a field, one per joint; empty without such limits. An error if they vary over time, which
    /// `method` does not support.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub(crate) fn constants(&self, field: Field, method: impl Into<Message> + Clone, remedy: &str) -> Result<Vec<f64>> {
        let constant = |profile: &Profile| match profile {
            Profile::Constant(value) => Ok(*value),
            _ => Err(Error::UnsupportedLimit {
                field: format!("time-varying {field}"),
                method: method.clone().into(),
                remedy: remedy.into(),
            }),
        };
        self.field(field).unwrap_or_default().iter().map(constant).collect()
    }

    /// Whether any joint has a finite limit of this kind.
    pub(crate) fn is_finite(&self, field: Field) -> bool {
        self.field(field).unwrap_or_default().iter().any(|profile| *profile != Profile::Constant(f64::INFINITY))
    }

    /// Returns the position limits as a box, for solving without time.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`] if they vary over time; [`Error::EmptyRange`].
    pub(crate) fn position_box(&self) -> Result<Bounds> {
        self.validate(0.0, 0)?;
        let constants = |field: Field| self.constants(field, "solve", "one configuration has no time; give numbers");
        Bounds::new(&constants(Field::Lower)?, &constants(Field::Upper)?)
    }

    /// Names of the joints.
    pub(crate) fn joint_names(&self) -> &[String] {
        &self.joints
    }

    /// Number of joints.
    pub(crate) fn dof(&self) -> usize {
        self.joints.len()
    }

    /// The velocity limit of joint `j`.
    pub(crate) fn velocity_of(&self, j: usize) -> &Profile {
        &self.velocity[j]
    }

    /// The smallest limit of joint `j` over the tick from `from` to `to` (s); infinite without one.
    pub(crate) fn smallest_over(&self, field: Field, j: usize, [from, to]: [f64; 2]) -> f64 {
        self.field(field).map_or(f64::INFINITY, |profiles| profiles[j].smallest(from, to).1)
    }

    /// Name of a joint.
    pub(crate) fn joint_name(&self, joint: usize) -> &str {
        &self.joints[joint]
    }

    /// Checks that these limits have as many joints and tips as `robot`.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if not.
    pub(crate) fn require_for(&self, robot: &Robot) -> Result<()> {
        if self.joints.len() == robot.dof() {
            return self.tips.require_for(robot);
        }
        let (what, expected) = (format!("limits for robot '{}'", robot.name()), format!("{} joints", robot.dof()));
        Err(Error::WrongLength { what: what.into(), expected, got: self.joints.len() })
    }
}
