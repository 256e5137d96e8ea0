//! Contacts: two bodies and their distance.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::message::Message;
use crate::wording::number;

/// The body that a link is near.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Neighbor {
    /// The obstacle of this index, and its kind.
    Obstacle(usize, String),
    /// Another link.
    Link(String),
}

/// A link, the body it is near, and their distance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// The link.
    pub link: String,
    /// The body that it is near to.
    pub other: Neighbor,
    /// Distance between their surfaces (m); negative by how deep they reach into each other.
    pub distance: f64,
}

/// A contact, its nearest point in the frame of the robot's base, and its gradient.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NearestContact {
    /// The two bodies and their distance.
    pub contact: Contact,
    /// The point of the link's body that is nearest to the other body (m). The nearest point of the other body is
    /// `distance` from here, against `normal`.
    pub point: [f64; 3],
    /// Direction from the other body to the link, of unit length: the distance grows fastest along it.
    pub normal: [f64; 3],
    /// Derivative of the distance by each joint (n,) (m/rad, m/m).
    pub gradient: Vec<f64>,
}

impl Contact {
    /// Words for the depth of the link in the other body, or for the distance and the margin `kept` (m): "0.01 m inside", "only 0.1 m
    /// (of a margin of 0.2 m) from".
    pub(crate) fn depth(&self, kept: f64) -> String {
        if self.distance == f64::NEG_INFINITY {
            return "perhaps (its numbers are too large to tell) inside".into();
        }
        if self.distance < 0.0 {
            return format!("{} m inside", number(-self.distance));
        }
        format!("only {} m (of a margin of {} m) from", number(self.distance), number(kept))
    }

    /// Words for the contact, of which `kept` (m) is to be kept: "link 'a' is only 0.1 m (of a margin of 0.2 m) from link 'b'".
    pub(crate) fn in_words(&self, kept: f64) -> String {
        format!("link '{}' is {} {}", self.link, self.depth(kept), self.other)
    }

    /// Advice for a body that no joint moves: to take the robot out of what was measured, or to allow the contact, where the robot
    /// stands on the other body.
    pub(crate) fn remedy(&self) -> Message {
        match self.measured() {
            Some(measured) => measured.advice(),
            None => format!("if the robot stands there, put '{}' into the obstacle's touch", self.link).into(),
        }
    }
}

impl fmt::Display for Neighbor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Obstacle(index, name) => write!(f, "obstacle {index} ({name})"),
            Self::Link(name) => write!(f, "link '{name}'"),
        }
    }
}
