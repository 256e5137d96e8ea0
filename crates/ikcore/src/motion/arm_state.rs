//! The state of all joints.

use crate::error::{Error, Result, require_finite};
use crate::math::one_joint::MotionState;

/// Positions, velocities and accelerations of all joints (n,) (rad or m, per s, per s^2).
#[derive(Debug, Clone, PartialEq)]
pub struct ArmState {
    /// Positions.
    pub q: Vec<f64>,
    /// Velocities.
    pub qd: Vec<f64>,
    /// Accelerations.
    pub qdd: Vec<f64>,
}

impl ArmState {
    /// The state at rest at `q`.
    pub fn at_rest(q: &[f64]) -> Self {
        Self { q: q.to_vec(), qd: vec![0.0; q.len()], qdd: vec![0.0; q.len()] }
    }

    /// Checks that there are `n` finite values each; `end` (start or end) names the state in errors.
    pub(super) fn check(&self, end: &str, joints: &[String]) -> Result<()> {
        for (what, values) in [("q", &self.q), ("qd", &self.qd), ("qdd", &self.qdd)] {
            if values.len() != joints.len() || joints.is_empty() {
                let expected = match joints.len() {
                    0 => "at least 1 joint".into(),
                    1 => "1 joint".into(),
                    n => format!("{n} joints"),
                };
                return Err(Error::WrongLength { what: format!("{end}_{what}").into(), expected, got: values.len() });
            }
            require_finite(format!("{end}_{what}"), values, |j| format!("joint '{}'", joints[j]))?;
        }
        Ok(())
    }

    /// The state of one joint.
    pub fn joint(&self, j: usize) -> MotionState {
        MotionState { q: self.q[j], v: self.qd[j], a: self.qdd[j] }
    }
}
