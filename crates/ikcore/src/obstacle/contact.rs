//! What a robot is near to.

use std::fmt;

/// The body that a link is near.
#[derive(Debug, Clone, PartialEq)]
pub enum Neighbor {
    /// The obstacle of this index, and its kind.
    Obstacle(usize, &'static str),
    /// Another link.
    Link(String),
}

/// A link, the body it is near, and their distance.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// The link.
    pub link: String,
    /// The body that it is near to.
    pub other: Neighbor,
    /// Distance between their surfaces (m); negative by how deep they reach into each other.
    pub distance: f64,
}

/// A contact with its place, in the frame of the robot's base.
#[derive(Debug, Clone, PartialEq)]
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

impl fmt::Display for Neighbor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Obstacle(index, name) => write!(f, "obstacle {index} ({name})"),
            Self::Link(name) => write!(f, "link '{name}'"),
        }
    }
}
