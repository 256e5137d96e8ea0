//! Obstacles, margin and self-collision, as a caller asks for them.

use serde::{Deserialize, Serialize};

use super::obstacles::{Obstacle, Obstacles};
use crate::error::{Error, Result};

/// Distance kept where none is given (m).
const DEFAULT_MARGIN: f64 = 1e-3;

/// Obstacles, and the distance to keep. By default nothing is checked.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Surroundings {
    /// The obstacles; an empty list checks the links against each other alone. `None`: no obstacles.
    pub obstacles: Option<Obstacles>,
    /// Distance to keep from obstacles and between links (m). `None` means 1 mm.
    pub margin: Option<f64>,
    /// Whether links must not touch each other. `None`: where obstacles are given.
    pub self_collision: Option<bool>,
}

impl Surroundings {
    /// These obstacles, at the default distance.
    pub fn among(obstacles: impl Into<Obstacles>) -> Self {
        Self { obstacles: Some(obstacles.into()), ..Self::default() }
    }

    /// Whether there is anything to keep clear of.
    pub fn is_given(&self) -> bool {
        self.obstacles.is_some() || self.self_collision == Some(true)
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
