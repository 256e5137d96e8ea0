//! Robots as bytes.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::description::Description;
use super::link_capsule::Bodies;
use super::model::Robot;
use crate::error::Result;
use crate::math::Pose;
use crate::stored;

/// The stored part of a robot; the rest is derived from it.
#[derive(Serialize, Deserialize)]
struct StoredRobot<'a> {
    description: Cow<'a, Description>,
    base: Pose,
    tool: Pose,
    bodies: Cow<'a, Bodies>,
}

impl Robot {
    /// Returns the robot as bytes, for storing and for copying between processes.
    ///
    /// # Errors
    /// [`Error::Corrupt`](crate::Error::Corrupt) if the encoder fails.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let stored = StoredRobot {
            description: Cow::Borrowed(self.description()),
            base: *self.base(),
            tool: *self.tool(),
            bodies: Cow::Borrowed(self.bodies()),
        };
        stored::to_bytes("robot", &stored)
    }

    /// Returns the robot stored by [`to_bytes`](Self::to_bytes).
    ///
    /// # Errors
    /// [`Error::Corrupt`](crate::Error::Corrupt) for bytes of another version, of another type, or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let StoredRobot { description, base, tool, bodies } = stored::from_bytes("robot", bytes)?;
        let bare = Self::assembled(description.into_owned(), base, tool, Bodies::default())?;
        let checked = bare.with_capsules(bodies.capsules.clone())?;
        Ok(checked.with_bodies(bodies.into_owned()))
    }
}
