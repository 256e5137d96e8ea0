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
            joints => Err(no_pace(joints, "")),
        }
    }

    /// Checks the same for an arm that moves tick by tick, which may jump if infinite velocity limits were given.
    ///
    /// # Errors
    /// [`Error::NoPace`] names the joints.
    pub(crate) fn require_pace_or_consent(&self) -> Result<()> {
        match &self.unpaced()[..] {
            joints if !self.own_velocity || joints.is_empty() => Ok(()),
            joints => Err(no_pace(joints, ", infinite where a joint may jump to any position in one tick")),
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
        let source = if own { " in the robot's description" } else { "" };
        let problem = format!("{} cannot move, since the {field} limit{source} is 0: give ", named_joints(&joints));
        Some(message![problem, Setting::Limit(field.name())])
    }

    /// The joints that limits of zero lock, of the first such field.
    fn locked(&self) -> Option<Locked<'_>> {
        RATES.into_iter().find_map(|field| {
            let zero = |j: &usize| self.of_joint(field, *j, 0.0);
            let joints: Vec<&str> = (0..self.dof()).filter(zero).map(|j| self.joint_name(j)).collect();
            (!joints.is_empty()).then_some(Locked { field, joints, own: field == Field::Velocity && self.own_velocity })
        })
    }

    /// Whether a limit of joint `j` has this value at all times; a missing one is infinite.
    fn of_joint(&self, field: Field, j: usize, value: f64) -> bool {
        self.field(field).map_or(value == f64::INFINITY, |profiles| profiles[j] == Profile::Constant(value))
    }
}

/// Creates an [`Error::NoPace`]; `note` ends the remedy.
pub(crate) fn no_pace(joints: &[&str], note: &str) -> Error {
    let lack = match joints {
        [_] => "has neither a velocity nor an acceleration limit, so that nothing sets its pace",
        _ => "have neither a velocity nor an acceleration limit, so that nothing sets their pace",
    };
    let remedy = message!["give ", Setting::Limit("velocity"), note];
    Error::NoPace { problem: format!("{} {lack}", named_joints(joints)), remedy }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Robot;

    fn given(field: Field, values: &[f64]) -> Limits {
        let profiles = values.iter().map(|value| Profile::Constant(*value)).collect();
        Limits::none_for(values.len()).replace(field, profiles).unwrap()
    }

    #[test]
    fn any_rate_sets_the_pace_of_a_joint() {
        let free = f64::INFINITY;
        for field in RATES {
            assert!(given(field, &[1.0, 2.0]).require_pace().is_ok());
            let says = "joint '1' has neither a velocity nor an acceleration limit, so that nothing sets its pace: give a velocity \
                        limit";
            assert_eq!(given(field, &[1.0, free]).require_pace().unwrap_err().to_string(), says);
        }
    }

    #[test]
    fn infinite_velocities_are_a_consent_only_if_given() {
        let arm = Robot::planar(&[1.0, 1.0]).unwrap();
        let own = Limits::of(&arm);
        let says = "joints 'joint_1', 'joint_2' have neither a velocity nor an acceleration limit, so that nothing sets their pace: \
                    give a velocity limit, infinite where a joint may jump to any position in one tick";
        assert_eq!(own.require_pace_or_consent().unwrap_err().to_string(), says);
        let narrower = own.clone().replace(Field::Lower, vec![Profile::Constant(-1.0)]).unwrap();
        assert_eq!(narrower.require_pace_or_consent().unwrap_err().to_string(), says);
        let consented = own.replace(Field::Velocity, vec![Profile::Constant(f64::INFINITY)]).unwrap();
        assert!(consented.require_pace_or_consent().is_ok());
        assert!(consented.require_pace().is_err());
    }

    #[test]
    fn a_lock_names_its_joints_field_and_source() {
        assert_eq!(given(Field::Jerk, &[1.0, 2.0]).lock(), None);
        let lock = given(Field::Acceleration, &[0.0, 2.0, -0.0]).lock().unwrap();
        assert_eq!(lock, "joints '0', '2' cannot move, since the acceleration limit is 0: give an acceleration limit");
        let cad = Robot::planar(&[1.0]).unwrap().with_limits(|_, joint| joint.velocity = 0.0).unwrap();
        let lock = Limits::of(&cad).lock().unwrap();
        assert_eq!(
            lock,
            "joint 'joint_1' cannot move, since the velocity limit in the robot's description is 0: give a velocity limit"
        );
    }
}
