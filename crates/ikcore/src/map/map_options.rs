//! What a pose of a map must fulfil, and how long it is looked for.

use crate::error::{Error, Result};
use crate::message::{Setting, message};
use crate::obstacle::Surroundings;
use crate::task::{Task, TaskKind};

/// Options of the chunks of a map. Those of one map are computed with the same options.
#[derive(Debug, Clone)]
pub struct MapOptions {
    /// The part of the pose that matters. `None` means all of it.
    pub task: Option<Task>,
    /// What configurations keep clear of. By default nothing is checked.
    pub surroundings: Surroundings,
    /// Most evaluations of a pose: values of the parameter of a redundant arm with a closed form, and evaluations of the forward
    /// kinematics for an arm without one.
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
    /// Whether nothing but the limits of the first joint distinguishes azimuths.
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

/// Checks that maps of a task make sense.
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
