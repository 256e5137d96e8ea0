//! Robots as bytes.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::bodies::CollisionModel;
use super::builder::ChainBuilder;
use super::model::Robot;
use crate::error::Result;
use crate::math::Pose;
use crate::stored;

/// What is stored of a robot: all that the rest follows from.
#[derive(Serialize, Deserialize)]
struct Stored<'a> {
    description: Cow<'a, ChainBuilder>,
    base: Pose,
    tool: Pose,
    collision: Cow<'a, CollisionModel>,
}

impl Robot {
    /// The robot as bytes, for storing and for copying between processes.
    ///
    /// # Errors
    /// [`Error::Corrupt`](crate::Error::Corrupt) if the encoder fails.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let stored = Stored {
            description: Cow::Borrowed(self.description()),
            base: *self.base(),
            tool: *self.tool(),
            collision: Cow::Borrowed(self.collision()),
        };
        stored::to_bytes("robot", &stored)
    }

    /// The robot that [`to_bytes`](Self::to_bytes) stored.
    ///
    /// # Errors
    /// [`Error::Corrupt`](crate::Error::Corrupt) for bytes of another version, damaged ones, or those of something else.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let Stored { description, base, tool, collision } = stored::from_bytes("robot", bytes)?;
        let bare = Self::assembled(description.into_owned(), base, tool, CollisionModel::default())?;
        let checked = bare.with_capsules(collision.capsules.clone())?;
        Ok(checked.with_collision(collision.into_owned()))
    }
}
