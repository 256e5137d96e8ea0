//! Robots as bytes.

use super::model::Robot;
use super::parts::Parts;
use crate::error::{Error, Result, require_finite};
use crate::message::with_article;
use crate::stored;

impl Robot {
    /// Returns the robot as bytes, for storing and for copying between processes.
    ///
    /// # Errors
    /// None in practice: any robot can be encoded.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        stored::to_bytes("robot", self.parts())
    }

    /// Returns the robot stored by [`to_bytes`](Self::to_bytes).
    ///
    /// # Errors
    /// [`Error::Corrupt`](crate::Error::Corrupt) for bytes of another version, of another type, or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let robot = Self::assembled(stored::from_bytes::<Parts>("robot", bytes)?)?;
        for visual in robot.visuals() {
            robot.link_number(&visual.link)?;
        }
        for known in robot.inertias().iter().chain(robot.payloads()) {
            robot.link_number(&known.link)?;
            known.inertia.require_possible(&format!("inertia of link '{}'", known.link))?;
        }
        require_finite("gravity", &robot.gravity(), |i| format!("entry {i}"))?;
        for body in robot.bodies() {
            robot.link_number(&body.link)?;
            if !body.shape.can_be_carried() {
                let problem = format!("{} is no body of a robot", with_article(body.shape.name()));
                return Err(Error::InvalidObstacle { problem });
            }
        }
        Ok(robot)
    }
}
