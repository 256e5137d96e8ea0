//! Space of the pieces at the ends of a motion.

use crate::error::Result;
use crate::obstacle::{ClearSpace, Obstacles, Surroundings, kept_margin};
use crate::plan::{END_RESERVE, PointToPointOptions, as_lines, can_collide};
use crate::robot::Robot;

/// A robot and its surroundings, as the planner of the motion in between sees them.
#[derive(Clone)]
pub(super) struct PieceSpace {
    /// The robot, with lines for links if it has no bodies.
    pub robot: Robot,
    pub surroundings: Surroundings,
}

impl PieceSpace {
    /// `None` if nothing can collide.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a wrong margin.
    pub(super) fn new(robot: &Robot, options: &PointToPointOptions) -> Result<Option<Self>> {
        if !can_collide(robot, options) {
            return Ok(None);
        }
        let lines = as_lines(robot, options)?;
        let may_cross = lines.is_some() || options.self_collision == Some(false);
        let surroundings = Surroundings {
            obstacles: Some(options.obstacles.clone()),
            margin: Some(kept_margin(options.margin)? + END_RESERVE),
            self_collision: Some(!may_cross),
        };
        Ok(Some(Self { robot: lines.unwrap_or_else(|| robot.clone()), surroundings }))
    }

    /// The same among other obstacles.
    pub(super) fn among(&self, obstacles: Obstacles) -> Self {
        let surroundings = Surroundings { obstacles: Some(obstacles), ..self.surroundings.clone() };
        Self { robot: self.robot.clone(), surroundings }
    }

    /// The configurations that are clear.
    ///
    /// # Errors
    /// Of the surroundings.
    pub(super) fn clear(&self) -> Result<Option<ClearSpace<'_>>> {
        self.surroundings.clear_space(&self.robot)
    }
}
