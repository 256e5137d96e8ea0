//! Requirements on the poses of a map, and the budget of each pose.

use crate::error::{Error, Result};
use crate::message::{Setting, message};
use crate::obstacle::Surroundings;
use crate::task::{Task, TaskKind};

/// Options of a map. All chunks of one map are computed with the same options.
#[derive(Debug, Clone)]
pub struct MapOptions {
    /// Part of the pose to reach. `None` means all of it.
    pub task: Option<Task>,
    /// Obstacles and self-collision to avoid; none by default.
    pub surroundings: Surroundings,
    /// Budget of a pose: parameter values of a redundant arm with a closed form, and evaluations of the forward kinematics for
    /// an arm without one.
    pub evaluations: usize,
    /// Whether to measure manipulability and clearance of the best configuration of each voxel.
    pub quality: bool,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self { task: None, surroundings: Surroundings::default(), evaluations: 200, quality: false }
    }
}

impl MapOptions {
    /// Whether only the limits of the first joint distinguish azimuths.
    pub(super) fn treat_azimuths_alike(&self) -> bool {
        let Surroundings { obstacles, self_collision, .. } = &self.surroundings;
        obstacles.is_none() && *self_collision != Some(true)
    }

    pub(super) fn validate(&self) -> Result<()> {
        if self.evaluations == 0 {
            return Err(Error::out_of_range("evaluations", "one or more", 0.0));
        }
        require_mapped(self.task.as_ref())
    }
}

/// Checks that a map of this task is meaningful.
fn require_mapped(task: Option<&Task>) -> Result<()> {
    let Some(task) = task else { return Ok(()) };
    task.validate()?;
    let problem = if matches!(task.kind, TaskKind::Orientation) {
        message!["an orientation task leaves the position free, so all voxels are alike"]
    } else if task.region.is_some() {
        message!["the region of a task moves targets; give the map ", Setting::Region]
    } else {
        return Ok(());
    };
    Err(Error::Contradiction { problem: message!["task of a map: ", problem] })
}
