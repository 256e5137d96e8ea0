//! Limits that a method needs, or cannot keep.

use super::constant_limits::ConstantLimits;
use super::joint_path::JointPath;
use crate::error::{Error, Result};
use crate::limits::{StartSlack, TipField, no_pace};
use crate::message::{Message, Setting, message};
use crate::robot::limit_rounding;
use crate::wording::named_joints;

impl ConstantLimits {
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

    /// Checks that every joint has a velocity, acceleration or jerk limit; without one a motion would take no time.
    ///
    /// # Errors
    /// [`Error::NoPace`].
    pub(crate) fn require_pace(&self) -> Result<()> {
        let free = |j: &usize| self.rates().iter().all(|(_, limits)| limits[*j].is_infinite());
        let joints: Vec<&str> = (0..self.dof()).filter(free).map(|j| self.joint_name(j)).collect();
        if joints.is_empty() { Ok(()) } else { Err(no_pace(&joints, "")) }
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
}
