//! Masses of the links, payloads and gravity.

use serde::{Deserialize, Serialize};

use crate::dynamics::Inertia;

/// Acceleration of free fall (m/s^2), the z axis upward.
pub(super) const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// Inertia of a link, in its frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinkInertia {
    /// Name of the link.
    pub link: String,
    /// Its inertia.
    pub inertia: Inertia,
}

/// Inertia that a file gives and no body can have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct InertiaFault {
    /// Name of the link; of a joint, "joint 'name'".
    pub owner: String,
    /// Place and reason, as a sentence.
    pub problem: String,
    /// Mass and centre, where these are possible and the inertia matrix alone is not: all that counts of a link that stands still.
    pub point: Option<Inertia>,
}

/// Masses of a robot. Kinematics needs none of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Masses {
    /// Inertias of the links that have one.
    pub links: Vec<LinkInertia>,
    pub faults: Vec<InertiaFault>,
    /// At most one for each link.
    pub payloads: Vec<LinkInertia>,
    /// Acceleration of free fall in the frame of the robot's base (m/s^2).
    pub gravity: [f64; 3],
}

impl Default for Masses {
    fn default() -> Self {
        Self { links: vec![], faults: vec![], payloads: vec![], gravity: GRAVITY }
    }
}
