//! Sensor data that may contain the robot itself.

use serde::{Deserialize, Serialize};

use super::contact::{Contact, Neighbor};
use crate::message::{Message, Setting, message};

/// Kind of obstacle that a sensor measures. A robot that is inside one at its own configuration has probably been measured
/// itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Measured {
    /// Point cloud.
    PointCloud,
    /// Occupancy grid.
    Grid,
}

impl Measured {
    /// Advice to take the robot's own points out, as a part of a sentence.
    pub(crate) fn advice(self) -> Message {
        match self {
            Self::PointCloud => message![
                "the robot's own points may be in the cloud, and ",
                Setting::WithoutRobot("PointCloud"),
                " takes them out"
            ],
            Self::Grid => message![
                "the robot's own voxels may be in the grid, and ",
                Setting::WithoutRobot("Grid"),
                " takes them out"
            ],
        }
    }
}

impl Contact {
    /// The kind of the other body, if a sensor measures it.
    pub fn measured(&self) -> Option<Measured> {
        match &self.other {
            Neighbor::Obstacle(_, name) if name == "PointCloud" => Some(Measured::PointCloud),
            Neighbor::Obstacle(_, name) if name == "Grid" => Some(Measured::Grid),
            _ => None,
        }
    }
}
