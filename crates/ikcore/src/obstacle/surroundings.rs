//! What a caller wants configurations to keep clear of.

use serde::{Deserialize, Serialize};

use super::clear_space::ClearSpace;
use super::obstacles::Obstacles;
use super::scene::Scene;
use crate::error::{Error, Result};
use crate::message::{Setting, message};
use crate::robot::Robot;

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
    /// Whether there is anything to keep clear of.
    pub fn is_given(&self) -> bool {
        self.obstacles.is_some() || self.self_collision == Some(true)
    }

    /// The first obstacle that is a mesh which is not closed.
    pub(crate) fn first_open_mesh(&self) -> Option<usize> {
        self.obstacles.as_ref()?.first_open_mesh()
    }

    /// The space that they leave to `robot`; `None` if nothing is to be checked.
    ///
    /// # Errors
    /// Those of [`Scene::new`]; [`Error::OutOfRange`] for a margin that is negative or not finite; [`Error::Contradiction`] for a
    /// margin without anything to keep it from.
    pub fn clear_space<'a>(&'a self, robot: &'a Robot) -> Result<Option<ClearSpace<'a>>> {
        let margin = kept_margin(self.margin)?;
        if !self.is_given() {
            let problem = message![Setting::Margin, " needs ", Setting::Surroundings];
            return if self.margin.is_some() { Err(Error::Contradiction { problem }) } else { Ok(None) };
        }
        let scene = Scene::new(robot, self.obstacles.clone().unwrap_or_default())?;
        let scene = if self.self_collision == Some(false) { scene.without_self_collision() } else { scene };
        Ok(Some(ClearSpace::new(scene, margin)))
    }
}

/// The distance to keep (m): `margin`, or 1 mm.
///
/// # Errors
/// [`Error::OutOfRange`] for a margin that is negative or not finite.
pub(crate) fn kept_margin(margin: Option<f64>) -> Result<f64> {
    let margin = margin.unwrap_or(DEFAULT_MARGIN);
    if margin.is_finite() && margin >= 0.0 {
        return Ok(margin);
    }
    Err(Error::out_of_range("margin", "zero or more and finite", margin))
}
