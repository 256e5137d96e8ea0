//! Clouds and grids of sensors without the robot's own points.

use super::obstacles::{Obstacle, Obstacles};
use super::scene::Scene;
use crate::error::{Error, Result, require_not_negative};
use crate::interrupt::checkpoint;
use crate::robot::Robot;

/// A cloud or grid without the robot's own points, from [`Obstacle::without_robot`].
#[derive(Debug, Clone, PartialEq)]
pub struct WithoutRobot {
    /// Remaining obstacle; the links that may touch it are the same.
    pub obstacle: Obstacle,
    /// Number of points or voxels that were removed.
    pub removed: usize,
}

impl Obstacle {
    /// Removes the points of a cloud, or the occupied voxels of a grid, whose distance from a body of `robot` at `q` (n,) is at
    /// most `padding` (m): those that a sensor took of the robot itself.
    ///
    /// All bodies count, those of the base, of held links and of attached shapes too. The distance of a point is that of the
    /// ball about it, as in [`Scene::clearance`].
    ///
    /// # Errors
    /// [`Error::NoCapsules`] for a robot without bodies; [`Error::WrongLength`], [`Error::NotFinite`];
    /// [`Error::OutOfRange`] for a padding that is negative or not finite; [`Error::InvalidObstacle`] for another shape;
    /// [`Error::Interrupted`].
    pub fn without_robot(&self, robot: &Robot, q: &[f64], padding: f64) -> Result<WithoutRobot> {
        require_not_negative("padding", padding)?;
        let Some(count) = self.shape.piece_count() else {
            let problem = format!("a {} has no points of its own: expected a PointCloud or a Grid", self.shape.name());
            return Err(Error::InvalidObstacle { problem });
        };
        let scene = Scene::new(robot, Obstacles::default())?;
        robot.check("joint angles", q)?;
        let poses = scene.poses(q);
        let mut near = vec![false; count];
        for body in 0..scene.bodies.carried.len() {
            checkpoint()?;
            self.shape.mark_near(&scene.posed(body, &poses), padding, &mut near);
        }
        checkpoint()?;
        let removed = near.iter().filter(|near| **near).count();
        let left = || self.reshaped(self.shape.without_pieces(&near));
        Ok(WithoutRobot { obstacle: if removed == 0 { self.clone() } else { left() }, removed })
    }
}
