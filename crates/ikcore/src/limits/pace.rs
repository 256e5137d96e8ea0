//! Limits that decide whether and how fast a joint moves: joints that nothing slows down, and joints that a limit of zero locks.

use super::field::Field;
use super::joint_limits::Limits;
use super::profile::Profile;
use crate::error::{Error, Result};
use crate::message::{Message, Setting, message};
use crate::wording::named_joints;

/// Limits on derivatives of the position.
const RATES: [Field; 3] = [Field::Velocity, Field::Acceleration, Field::Jerk];

/// Joints that a limit of zero locks.
struct Locked<'a> {
    field: Field,
    joints: Vec<&'a str>,
    /// Whether the limit is the robot's own.
    own: bool,
}

impl Limits {
    /// Checks that every joint has a velocity, acceleration or jerk limit. Without one a planned motion would take no time.
    ///
    /// # Errors
    /// [`Error::NoPace`] names the joints.
    pub(crate) fn require_pace(&self) -> Result<()> {
        match &self.unpaced()[..] {
            [] => Ok(()),
            joints => Err(Error::no_pace(joints, "")),
        }
    }

    /// Checks the same for an arm that moves tick by tick, which may jump if infinite velocity limits were given.
    ///
    /// # Errors
    /// [`Error::NoPace`] names the joints.
    pub(crate) fn require_pace_or_consent(&self) -> Result<()> {
        match &self.unpaced()[..] {
            joints if self.gives_velocity || joints.is_empty() => Ok(()),
            joints => Err(Error::no_pace(joints, ", infinite where a joint may jump to any position in one tick")),
        }
    }

    /// Joints without any limit on velocity, acceleration and jerk.
    fn unpaced(&self) -> Vec<&str> {
        let free = |j: &usize| RATES.iter().all(|field| self.of_joint(*field, *j, f64::INFINITY));
        (0..self.dof()).filter(free).map(|j| self.joint_name(j)).collect()
    }

    /// Checks that no limit of zero locks a joint.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the joints.
    pub(crate) fn require_unlocked(&self) -> Result<()> {
        let Some(Locked { field, joints, own }) = self.locked() else { return Ok(()) };
        let what = format!("{field} limit of {}", named_joints(&joints));
        let requirement = match own {
            true => message!["positive (the robot's description gives 0): give ", Setting::Limit("velocity")],
            false => "positive".into(),
        };
        Err(Error::out_of_range(what, requirement, 0.0))
    }

    /// Names the joints that cannot move because of a limit of zero, with the remedy.
    pub(crate) fn lock(&self) -> Option<Message> {
        let Locked { field, joints, own } = self.locked()?;
        let source = if own { "in the robot's description" } else { "as given" };
        let problem = format!("{} cannot move, since the {field} limit {source} is 0: give ", named_joints(&joints));
        Some(message![problem, Setting::Limit(field.name())])
    }

    /// The joints that limits of zero lock, of the first such field.
    fn locked(&self) -> Option<Locked<'_>> {
        RATES.into_iter().find_map(|field| {
            let zero = |j: &usize| self.of_joint(field, *j, 0.0);
            let joints: Vec<&str> = (0..self.dof()).filter(zero).map(|j| self.joint_name(j)).collect();
            (!joints.is_empty()).then_some(Locked {
                field,
                joints,
                own: field == Field::Velocity && !self.gives_velocity,
            })
        })
    }

    /// Whether a limit of joint `j` has this value at all times; a missing one is infinite.
    fn of_joint(&self, field: Field, j: usize, value: f64) -> bool {
        self.field(field).map_or(value == f64::INFINITY, |profiles| profiles[j] == Profile::Constant(value))
    }
}
