//! Capsules fixed to the links of a robot.

use serde::{Deserialize, Serialize};

/// A capsule: all points within `radius` (m) of the segment from `a` to `b`, in the frame of the link (m).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinkCapsule {
    /// Name of the link that carries it.
    pub link: String,
    /// One end of the axis (m).
    pub a: [f64; 3],
    /// The other end (m); equal to `a` for a sphere.
    pub b: [f64; 3],
    /// Radius (m); zero for a thin rod.
    pub radius: f64,
}

/// The capsules of a robot, and the collision shapes that were not converted.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Bodies {
    pub capsules: Vec<LinkCapsule>,
    /// Collision shapes without a capsule, for example "a mesh of link 'hand'".
    pub unread: Vec<String>,
}
