//! Limits of a timing.

use super::joint_path::JointPath;
use crate::error::{Error, Result};
use crate::limits::{Field, Limits};
use crate::message::Message;

/// Excess over a position limit that counts as rounding (rad or m, relative beyond 1).
const ROUNDING: f64 = 1e-9;

/// Constant limits of each joint (n,). Position limits are not included: they depend on the path alone.
#[derive(Debug, Clone, PartialEq)]
pub struct TimingLimits {
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Velocity (rad/s, m/s); infinite without a limit.
    pub(super) velocity: Vec<f64>,
    /// Acceleration (rad/s^2, m/s^2), finite.
    pub(super) acceleration: Vec<f64>,
    /// Jerk (rad/s^3, m/s^3); `None` if no joint has a limit.
    pub(super) jerk: Option<Vec<f64>>,
}

impl TimingLimits {
    /// The timing limits of `limits`, which must be constant; `method` is named in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`] for limits that vary over time and for joints without an acceleration limit;
    /// [`Error::NegativeLimit`], [`Error::EmptyRange`].
    pub fn new(limits: &Limits, method: impl Into<Message>) -> Result<Self> {
        limits.validate(0.0, 0)?;
        let method = method.into();
        let remedy = "when a point of the path is passed is what it looks for; give numbers";
        let constants = |field: Field| limits.constants(field, &method, remedy);
        let acceleration = constants(Field::Acceleration)?;
        let unlimited = acceleration.iter().position(|limit| *limit == f64::INFINITY);
        if let Some(joint) = if acceleration.is_empty() { Some(0) } else { unlimited } {
            return Err(Error::UnsupportedLimit {
                field: "infinite acceleration".into(),
                method,
                remedy: format!(
                    "joint '{}' could start at any speed; give acceleration limits",
                    limits.joint_name(joint)
                )
                .into(),
            });
        }
        let jerk = constants(Field::Jerk)?;
        Ok(Self {
            lower: constants(Field::Lower)?,
            upper: constants(Field::Upper)?,
            velocity: constants(Field::Velocity)?,
            acceleration,
            jerk: jerk.iter().any(|limit| limit.is_finite()).then_some(jerk),
        })
    }

    /// Checks that these limits fit the joints of `path`, that the path is within the position limits, and that no
    /// joint that must move is locked.
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::Infeasible`] names the joint.
    pub(super) fn require_for(&self, path: &JointPath) -> Result<()> {
        let joints = path.joints();
        if self.velocity.len() != joints.len() {
            let expected = format!("{} joints, as the path has", joints.len());
            return Err(Error::WrongLength { what: "limits".into(), expected, got: self.velocity.len() });
        }
        for (j, joint) in joints.iter().enumerate() {
            let [lowest, highest] = path.range(j);
            for (place, excess, bound, limit) in [
                (lowest, self.lower[j] - lowest, self.lower[j], "lower"),
                (highest, highest - self.upper[j], self.upper[j], "upper"),
            ] {
                if excess > ROUNDING * bound.abs().max(1.0) {
                    let problem =
                        format!("the path takes joint '{joint}' to {place}, beyond its {limit} limit {bound}");
                    return Err(Error::Infeasible { problem: problem.into() });
                }
            }
            let fields = [
                ("velocity", Some(&self.velocity)),
                ("acceleration", Some(&self.acceleration)),
                ("jerk", self.jerk.as_ref()),
            ];
            for (field, limits) in fields {
                if limits.is_some_and(|limits| limits[j] == 0.0) && highest > lowest {
                    let moves = format!("the path moves joint '{joint}' from {lowest} to {highest}");
                    return Err(Error::Infeasible { problem: format!("{moves}, but its {field} limit is 0").into() });
                }
            }
        }
        Ok(())
    }
}
