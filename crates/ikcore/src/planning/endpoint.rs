//! Where a motion starts or ends.

use crate::error::{Error, Result};
use crate::robot::Robot;
use crate::task::Target;

/// Where a motion starts or ends.
#[derive(Debug, Clone, PartialEq)]
pub enum Endpoint {
    /// The tip is there; which configuration is the planner's choice.
    Target(Target),
    /// Exactly this configuration (n,) (rad, m).
    Configuration(Vec<f64>),
}

impl Endpoint {
    /// Err unless all numbers are finite and a configuration has one a joint; `what` names the end.
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
