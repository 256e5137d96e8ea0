//! Targets that no configuration reaches.

use super::{Criterion, Target};
use crate::kinematics::Beyond;
use crate::objective::Bounds;
use crate::robot::Robot;

impl Criterion {
    /// How far `target` is out of the reach of `robot` within `bounds`, where it is beyond doubt.
    pub fn beyond_reach(&self, target: &Target, robot: &Robot, bounds: &Bounds) -> Option<Beyond> {
        if self.components.is_some() {
            return None; // their weights and tolerances may leave free what is out of reach
        }
        let aim = self.aim(target);
        let orientation = match &aim {
            Target::Pose(frame) | Target::Orientation(frame) => Some(frame),
            Target::Position(_) | Target::Pointing { .. } => None,
        };
        let tolerance = [self.tolerance.position, self.tolerance.rotation];
        robot.reach(bounds.lower(), bounds.upper()).beyond(aim.position().as_ref(), orientation, tolerance)
    }
}
