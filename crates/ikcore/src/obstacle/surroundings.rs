//! Obstacles, margin and self-collision, as a caller asks for them.

use serde::{Deserialize, Serialize};

use super::obstacles::{Obstacle, Obstacles};
use crate::error::{Error, Result};
use crate::robot::Robot;

/// Distance kept where none is given (m).
const DEFAULT_MARGIN: f64 = 1e-3;

/// Obstacles, and the distance to keep. By default nothing is checked but the links of a robot with several tips against each
/// other, where all its collision shapes are known.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Surroundings {
    /// The obstacles; an empty list checks the links against each other alone. `None`: no obstacles.
    pub obstacles: Option<Obstacles>,
    /// Distance to keep from obstacles and between links (m). `None` means 1 mm.
    pub margin: Option<f64>,
    /// Whether links must not touch each other. `None`: where obstacles are given, and for several tips.
    pub self_collision: Option<bool>,
}

impl Surroundings {
    /// These obstacles, at the default distance.
    pub fn among(obstacles: impl Into<Obstacles>) -> Self {
        Self { obstacles: Some(obstacles.into()), ..Self::default() }
    }

    /// Whether there is anything that `robot` keeps clear of. Arms on one torso reach each other in most of their postures, so that
    /// their links are checked unless the caller declines.
    pub fn apply_to(&self, robot: &Robot) -> bool {
        let arms_meet =
            || robot.tip_count() > 1 && !robot.capsules().is_empty() && robot.unread_collision_shapes().is_empty();
        self.obstacles.is_some() || self.self_collision.unwrap_or_else(arms_meet)
    }

    /// The obstacles, if any.
    pub(crate) fn obstacles(&self) -> &[Obstacle] {
        self.obstacles.as_deref().unwrap_or_default()
    }

    /// The first obstacle that is a mesh which is not closed.
    pub(crate) fn first_open_mesh(&self) -> Option<usize> {
        self.obstacles.as_ref()?.first_open_mesh()
    }

    /// The distance to keep (m).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a margin that is negative or not finite.
    pub(crate) fn kept_margin(&self) -> Result<f64> {
        let margin = self.margin.unwrap_or(DEFAULT_MARGIN);
        if margin.is_finite() && margin >= 0.0 {
            return Ok(margin);
        }
        Err(Error::out_of_range("margin", "zero or more and finite", margin))
    }
}
