//! Constant limits of each joint, for planners and timings.

use std::borrow::Cow;
use std::f64::consts::PI;

use super::joint_path::JointPath;
use super::violation::Violation;
use crate::constraint::{HoldCheck, JointTorques, TIGHT, TipExcess, TipRates, TooHeavy, TorqueExcess};
use crate::error::{Error, Result};
use crate::limits::{Field, JointOutside, Limits, Profile, ROUNDING, StartSlack, TipField, no_pace};
use crate::math::sampling_range;
use crate::message::{Message, Setting, message};
use crate::robot::{JointKind, Robot, limit_rounding};
use crate::trajectory::Trajectory;
use crate::wording::{named_joints, number};

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
    joints: Vec<(String, Option<JointKind>)>,
}

impl ConstantLimits {
    /// The limits of a path without a robot; `method` names the call in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`] for limits that vary over time and for joints without an acceleration limit;
    /// [`Error::NegativeLimit`], [`Error::EmptyRange`].
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
    /// [`Error::UnsupportedLimit`] for limits that vary over time, for joints without an acceleration limit, and for limits of a tip that a
    /// rotation vector carries; [`Error::OutOfRange`] for a limit of zero, [`Error::EmptyRange`], [`Error::NegativeLimit`],
    /// [`Error::WrongLength`].
    pub fn of_path(robot: &Robot, limits: &Limits, method: impl Into<Message>) -> Result<Self> {
        let method = method.into();
        let constant = Self::for_robot(robot, Some(limits), method.clone())?;
        constant.require_accelerations(method)?;
        Ok(constant)
    }

    /// The limits for `robot`; `None` means its own. `method` names the planner in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`] for limits that vary over time, [`Error::OutOfRange`] for a velocity, acceleration or
    /// jerk limit of zero, [`Error::EmptyRange`], [`Error::NegativeLimit`], [`Error::WrongLength`].
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

    /// Checks that every joint has an acceleration limit, which `method` needs.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub(crate) fn require_accelerations(&self, method: impl Into<Message>) -> Result<()> {
        match self.acceleration.iter().position(|limit| *limit == f64::INFINITY) {
            None => Ok(()),
            Some(joint) => Err(Error::UnsupportedLimit {
                field: "infinite acceleration".into(),
                method: method.into(),
                remedy: format!(
                    "joint '{}' could start at any speed; give acceleration limits",
                    self.joint_name(joint)
                )
                .into(),
            }),
        }
    }

    /// Checks that these limits fit the joints of `path`, that the path is within the position limits, and that no
    /// joint that must move is locked. A path that begins outside within the slack of a start may return from there.
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::Infeasible`] names the joint.
    pub(super) fn require_for(&self, path: &JointPath) -> Result<()> {
        let joints = path.joints();
        if self.dof() != joints.len() {
            let expected = format!("{} joints, as the path has", joints.len());
            return Err(Error::WrongLength { what: "limits".into(), expected, got: self.dof() });
        }
        let slack = StartSlack::default();
        let mut start = vec![0.0; joints.len()];
        path.position(0.0, &mut start);
        for (j, joint) in joints.iter().enumerate() {
            let [lowest, highest] = path.range(j);
            let (lower, upper) = slack.reach(j, self.joints[j].1, start[j], [self.lower[j], self.upper[j]]);
            for (place, excess, bound, limit) in
                [(lowest, lower - lowest, self.lower[j], "lower"), (highest, highest - upper, self.upper[j], "upper")]
            {
                if excess > limit_rounding(self.lower[j], self.upper[j]) {
                    let problem =
                        format!("the path takes joint '{joint}' to {place}, beyond its {limit} limit {bound}");
                    return Err(Error::Infeasible { problem: problem.into() });
                }
            }
        }
        for (field, limits) in self.rates() {
            let is_stuck = |j: &usize| limits[*j] == 0.0 && path.range(*j)[1] > path.range(*j)[0];
            let stuck: Vec<&str> = (0..joints.len()).filter(is_stuck).map(|j| joints[j].as_str()).collect();
            if !stuck.is_empty() {
                let moves = format!("the path moves {}, where the {field} limit is 0: give ", named_joints(&stuck));
                return Err(Error::Infeasible { problem: message![moves, Setting::Limit(field)] });
            }
        }
        Ok(())
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
    fn rates(&self) -> [(&'static str, &[f64]); 3] {
        [("velocity", &self.velocity), ("acceleration", &self.acceleration), ("jerk", &self.jerk)]
    }

    /// Units of a joint's position, velocity, acceleration and jerk.
    fn units(&self, joint: usize) -> [&'static str; 4] {
        if self.joints[joint].1.is_none_or(JointKind::turns) {
            ["rad", "rad/s", "rad/s^2", "rad/s^3"]
        } else {
            ["m", "m/s", "m/s^2", "m/s^3"]
        }
    }

    /// Whether any joint has a jerk limit.
    pub(crate) fn limit_jerk(&self) -> bool {
        self.jerk.iter().any(|limit| limit.is_finite())
    }

    /// Checks that no joint has a jerk limit, which `method` cannot keep.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub(crate) fn refuse_jerk(&self, method: impl Into<Message>) -> Result<()> {
        if !self.limit_jerk() {
            return Ok(());
        }
        let remedy = message!["leave them out, and add them with ", Setting::Retime];
        Err(Error::UnsupportedLimit { field: "jerk".into(), method: method.into(), remedy })
    }

    /// Checks that no tip has a limit, which `method` cannot keep.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub(crate) fn refuse_tips(&self, method: impl Into<Message>) -> Result<()> {
        let remedy = message!["add them with ", Setting::Retime];
        self.tips.as_ref().map_or(Ok(()), |tips| tips.limits().refuse(&TipField::ALL, method, remedy))
    }

    /// Whether any joint has a torque limit.
    pub(crate) fn limit_torque(&self) -> bool {
        self.torques.is_some()
    }

    /// These limits without those of torques.
    pub(super) fn without_torque(&self) -> Cow<'_, Self> {
        if self.torques.is_none() { Cow::Borrowed(self) } else { Cow::Owned(Self { torques: None, ..self.clone() }) }
    }

    /// Checks that no joint has a torque limit, which `method` cannot keep.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub(crate) fn refuse_torque(&self, method: impl Into<Message>) -> Result<()> {
        if self.torques.is_none() {
            return Ok(());
        }
        let remedy = message!["add them with ", Setting::Retime];
        Err(Error::UnsupportedLimit { field: "torque".into(), method: method.into(), remedy })
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
    /// None in practice: the limits were checked.
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

    /// Checks that every joint has a velocity, acceleration or jerk limit; without one a motion would take no time.
    ///
    /// # Errors
    /// [`Error::NoPace`].
    pub(crate) fn require_pace(&self) -> Result<()> {
        let free = |j: &usize| self.rates().iter().all(|(_, limits)| limits[*j].is_infinite());
        let joints: Vec<&str> = (0..self.dof()).filter(free).map(|j| self.joint_name(j)).collect();
        if joints.is_empty() { Ok(()) } else { Err(no_pace(&joints, "")) }
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

    /// Checks that every joint has a velocity limit, which `method` needs.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub(crate) fn require_velocities(&self, method: impl Into<Message>) -> Result<()> {
        match self.velocity.iter().position(|limit| limit.is_infinite()) {
            None => Ok(()),
            Some(j) => {
                let what = format!("velocity limit of joint '{}'", self.joint_name(j));
                let requirement = message!["finite for ", method, ": give ", Setting::Limit("velocity")];
                Err(Error::out_of_range(what, requirement, self.velocity[j]))
            }
        }
    }

    /// Returns the limits that `trajectory` violates, by the exact extremes of its polynomials. A joint that begins outside its
    /// position limits may return from there.
    pub(crate) fn violations(&self, trajectory: &Trajectory) -> Vec<Violation> {
        let [velocity, acceleration, jerk] =
            [trajectory.max_velocity(), trajectory.max_acceleration(), trajectory.max_jerk()];
        // Rounding of the times of the trajectory: a velocity may be off by its change in that time, and so on.
        let resolution = 4.0 * f64::EPSILON * trajectory.duration();
        let mut found = vec![];
        let start = trajectory.start();
        for (j, (lowest, highest)) in trajectory.position_range().into_iter().enumerate() {
            let units = self.units(j);
            // A start outside the limits was taken by the gate; the motion may not go farther out.
            let (lower, upper) = (self.lower[j].min(start[j]), self.upper[j].max(start[j]));
            let checks = [
                ("lowest position", lowest, lower, lower - lowest, units[0]),
                ("highest position", highest, upper, highest - upper, units[0]),
                ("velocity", velocity[j], self.velocity[j], velocity[j] - self.velocity[j], units[1]),
                (
                    "acceleration",
                    acceleration[j],
                    self.acceleration[j],
                    acceleration[j] - self.acceleration[j],
                    units[2],
                ),
                ("jerk", jerk[j], self.jerk[j], jerk[j] - self.jerk[j], units[3]),
            ];
            for (quantity, value, bound, excess, unit) in checks {
                let changes = match quantity {
                    "velocity" => self.acceleration[j],
                    "acceleration" => self.jerk[j],
                    _ => 0.0,
                };
                let unresolved = if changes.is_finite() { resolution * changes } else { 0.0 };
                if excess > ROUNDING * bound.abs().max(1.0) + unresolved {
                    let what = format!("{quantity} of joint '{}'", self.joint_name(j));
                    found.push(Violation { what, value, bound, unit: unit.into() });
                }
            }
        }
        found.extend(self.whole_violations(trajectory));
        found
    }

    /// The limits of tips and torques that `trajectory` exceeds.
    pub(crate) fn whole_violations(&self, trajectory: &Trajectory) -> Vec<Violation> {
        let of_tips = self.tips.iter().flat_map(|tips| tips.excesses(trajectory));
        let of_tips =
            of_tips.map(|TipExcess { what, value, bound, unit }| Violation { what, value, bound, unit: unit.into() });
        let of_torques = self.torques.iter().flat_map(|torques| torques.excesses(trajectory));
        let of_torques = of_torques.map(|TorqueExcess { joint, value, bound }| Violation {
            what: format!("torque of joint '{}'", self.joint_name(joint)),
            value,
            bound,
            unit: self.torque_unit(joint).into(),
        });
        of_tips.chain(of_torques).collect()
    }

    /// Whether the motion of the robot as a whole is limited: that of its tips, or the torques of its joints.
    pub(crate) fn limit_whole(&self) -> bool {
        self.tips.is_some() || self.torques.is_some()
    }

    /// Whether `motion` keeps the limits of torques.
    pub(crate) fn keep_torque(&self, motion: &Trajectory) -> bool {
        self.torques.as_ref().is_none_or(|torques| torques.keeps(motion))
    }

    /// Whether `motion` keeps the limits of tips and of torques.
    pub(crate) fn keep_whole(&self, motion: &Trajectory) -> bool {
        let most = 1.0 + ROUNDING;
        self.tips.as_ref().is_none_or(|tips| tips.slowdown(motion, most) <= most) && self.keep_torque(motion)
    }

    /// Factor by which `motion` must be slowed down to keep the limits of tips and of torques, or a bound of it up to `enough`; infinite where
    /// a joint cannot hold the arm.
    pub(super) fn whole_slowdown(&self, motion: &Trajectory, enough: f64) -> f64 {
        let of_tips = self.tips.as_ref().map_or(0.0, |tips| tips.slowdown(motion, enough));
        let of_torques = self.torques.as_ref().map_or(0.0, |torques| torques.slowdown(motion, enough.max(of_tips)));
        of_tips.max(of_torques)
    }

    /// Slows `motion` down as a whole where it exceeds the limits of tips or of torques. One on which a joint cannot hold the arm stays as it is.
    pub(super) fn slowed_as_a_whole(&self, motion: Trajectory) -> Result<Trajectory> {
        if self.tips.is_none() && self.keep_torque(&motion) {
            return Ok(motion);
        }
        Ok(self.slowed_if_held(&motion)?.unwrap_or(motion))
    }

    /// [`slowed_as_a_whole`](Self::slowed_as_a_whole); `None` where a joint cannot hold the arm.
    pub(super) fn slowed_if_held(&self, motion: &Trajectory) -> Result<Option<Trajectory>> {
        let factor = self.whole_slowdown(motion, 1.0);
        if factor.is_infinite() {
            return Ok(None);
        }
        let motion = motion.clone();
        if factor <= 1.0 { Ok(Some(motion)) } else { motion.slowed(factor * (1.0 + TIGHT)).map(Some) }
    }

    /// Slows `motion` down as a whole where it exceeds the limits of tips.
    pub(super) fn slowed_for_tips(&self, motion: Trajectory) -> Result<Trajectory> {
        let factor = self.tips.as_ref().map_or(0.0, |tips| tips.slowdown(&motion, 1.0));
        if factor <= 1.0 { Ok(motion) } else { motion.slowed(factor * (1.0 + TIGHT)) }
    }

    /// Checks whether joints can hold the arm along lines; `None` without torque limits.
    pub(crate) fn hold_check(&self) -> Option<HoldCheck<'_>> {
        self.torques.as_ref().map(HoldCheck::new)
    }

    /// Returns why a joint cannot hold the arm at `q` (n,), if one cannot.
    pub(crate) fn too_heavy(&self, q: &[f64]) -> Option<String> {
        let torques = self.torques.as_ref()?;
        torques.too_heavy(&mut torques.point(), q).map(|found| self.heavy_in_words(found))
    }

    /// Checks that the joints can hold the arm at `q`, which `what` names.
    ///
    /// # Errors
    /// [`Error::Infeasible`] names joint, torque and limit.
    pub(crate) fn refuse_too_heavy(&self, what: &str, q: &[f64]) -> Result<()> {
        match self.too_heavy(q) {
            None => Ok(()),
            Some(heavy) => Err(Error::Infeasible { problem: format!("at {what} {heavy}").into() }),
        }
    }

    /// Says which joint cannot hold the arm, and why.
    pub(super) fn heavy_in_words(&self, TooHeavy { joint, torque, friction, limit }: TooHeavy) -> String {
        let (name, unit) = (self.joint_name(joint), self.torque_unit(joint));
        let [torque, against, limit] = [torque, friction, limit].map(number);
        if friction > 0.0 {
            let needs = format!("joint '{name}' needs {torque} {unit} to hold the arm");
            return format!("{needs} and {against} {unit} against its dry friction, its limit is {limit} {unit}");
        }
        if torque == limit {
            return format!("joint '{name}' needs all of its limit of {limit} {unit} to hold the arm");
        }
        format!("joint '{name}' needs {torque} {unit} to hold the arm, its limit is {limit} {unit}")
    }

    /// Checks that a slowdown is finite.
    pub(super) fn require_holdable(&self, factor: f64) -> Result<()> {
        if factor.is_finite() {
            return Ok(());
        }
        let problem = "a joint cannot hold the arm on the way, however slowly it moves".into();
        Err(Error::Infeasible { problem })
    }
}
