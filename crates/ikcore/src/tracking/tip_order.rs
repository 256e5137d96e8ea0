//! What was last asked of several tips.

use crate::error::{Error, Result};
use crate::ik::{checked_tasks, reduce};
use crate::robot::Robot;
use crate::task::{Target, TargetRow, TipCriterion, TipTask};

/// Weight of pairs beside other tasks, so that what is not within reach costs them little: they are then held exactly.
const PAIR_WEIGHT: f64 = 100.0;

/// The tasks of the last targets.
#[derive(Debug, Default)]
pub(super) struct TipOrder {
    asked: Vec<TipTask>,
    tasks: Vec<TipCriterion>,
}

impl TipOrder {
    /// The tasks, in the order of their targets.
    pub fn tasks(&self) -> &[TipCriterion] {
        &self.tasks
    }

    /// The parts of targets that their tasks use, validated, and whether the tasks are not those of the last targets.
    ///
    /// # Errors
    /// Those of [`checked_tasks`] and [`reduce`], and [`Error::Contradiction`] for a task with a region; the tasks are then as before.
    pub fn read(&mut self, robot: &Robot, asked: &[(TipTask, Target)]) -> Result<(TargetRow, bool)> {
        asked.iter().try_for_each(|(_, target)| target.validate())?;
        let mut targets: TargetRow = asked.iter().map(|(_, target)| *target).collect();
        if asked.iter().map(|(task, _)| task).eq(&self.asked) && !asked.is_empty() {
            reduce(robot, &self.tasks, &mut targets)?;
            return Ok((targets, false));
        }
        let tasks: Vec<TipTask> = asked.iter().map(|(task, _)| *task).collect();
        let checked = checked(robot, &tasks)?;
        reduce(robot, &checked, &mut targets)?;
        (self.asked, self.tasks) = (tasks, checked);
        Ok((targets, true))
    }
}

fn checked(robot: &Robot, tasks: &[TipTask]) -> Result<Vec<TipCriterion>> {
    if tasks.is_empty() {
        let problem = "no tip has a target: name one tip at least".into();
        return Err(Error::Contradiction { problem });
    }
    if tasks.iter().any(|task| task.task.is_some_and(|task| task.region.is_some())) {
        let problem = "a tracked region is for one tip: leave within= out of the tasks of several".into();
        return Err(Error::Contradiction { problem });
    }
    let weighed = |task: TipCriterion| if task.subject.is_pair() { task.weighing(PAIR_WEIGHT) } else { task };
    Ok(checked_tasks(robot, tasks)?.into_iter().map(weighed).collect())
}
