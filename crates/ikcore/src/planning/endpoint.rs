//! The start or end of a motion.

use crate::error::{Error, Result};
use crate::robot::Robot;
use crate::task::Target;

/// The start or end of a motion.
#[derive(Debug, Clone, PartialEq)]
pub enum Endpoint {
    /// A target of the tip; the planner chooses the configuration.
    Target(Target),
    /// A configuration (n,) (rad, m).
    Configuration(Vec<f64>),
}

impl Endpoint {
    /// Checks that all numbers are finite and that a configuration has one per joint; `what` names the end.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::WrongLength`].
    pub fn check(&self, what: &str, robot: &Robot) -> Result<()> {
        match self {
            Self::Target(target) => target.validate().map_err(|error| match error {
                Error::NotFinite { place, value, .. } => Error::NotFinite { what: what.into(), place, value },
                other => other,
            }),
            Self::Configuration(q) => robot.check(&format!("{what}_q"), q),
        }
    }
}
