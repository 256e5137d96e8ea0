//! Tasks of the current targets.

use super::track_options::TrackOptions;
use crate::error::{Error, Result};
use crate::ik::{checked_tasks, reduce};
use crate::robot::Robot;
use crate::task::{Aims, CheckedTask, NamedTask, Region, Target};

/// Weight of pairs relative to other tasks: an unreachable target then costs them little accuracy, until they are held exactly.
const PAIR_WEIGHT: f64 = 100.0;

/// Tasks of the current targets; the task of the only tip never changes.
#[derive(Debug)]
pub(super) struct CurrentTasks {
    asked: Vec<NamedTask>,
    tasks: Vec<CheckedTask>,
}

impl CurrentTasks {
    /// Task of the only tip, without its tool, which the robot carries; for several tips, no task yet.
    ///
    /// # Errors
    /// Errors of a wrong task or tolerance.
    pub fn new(robot: &Robot, options: &TrackOptions) -> Result<Self> {
        let mut only = options.only_task()?;
        only.leave_tool();
        let tasks = if robot.tip_count() == 1 { vec![only] } else { vec![] };
        Ok(Self { asked: vec![], tasks })
    }

    /// Tasks with their `targets`; empty before the first.
    pub fn with<'a>(&'a self, targets: &'a [Target]) -> Aims<'a> {
        if targets.is_empty() { Aims::default() } else { Aims { tasks: &self.tasks, targets } }
    }

    /// Region of the only tip.
    pub fn region(&self) -> Option<&Region> {
        self.tasks.first().and_then(|task| task.criterion.region.as_ref())
    }

    /// Reduces validated `targets` to the parts that their tasks use. Returns the tasks of several tips, `asked`, if they differ from
    /// the current ones, to [replace](Self::replace) them.
    ///
    /// # Errors
    /// Errors of [`checked_tasks`] and [`reduce`], and [`Error::Contradiction`] for a task with a region.
    pub fn read(&self, robot: &Robot, asked: &[NamedTask], targets: &mut [Target]) -> Result<Option<Vec<CheckedTask>>> {
        targets.iter().try_for_each(Target::validate)?;
        if asked.is_empty() && !targets.is_empty() {
            robot.require_one_tip("a plain target")?;
        }
        if !asked.is_empty() && robot.tip_count() == 1 {
            let problem = format!("robot '{}' has one tip: give a plain target", robot.name());
            return Err(Error::Contradiction { problem: problem.into() });
        }
        if asked == self.asked && !targets.is_empty() {
            return reduce(robot, &self.tasks, targets).map(|()| None);
        }
        let tasks = checked(robot, asked)?;
        reduce(robot, &tasks, targets).map(|()| Some(tasks))
    }

    /// Replaces the current tasks by `tasks`, the checked form of `asked`.
    pub fn replace(&mut self, asked: Vec<NamedTask>, tasks: Vec<CheckedTask>) {
        (self.asked, self.tasks) = (asked, tasks);
    }
}

fn checked(robot: &Robot, tasks: &[NamedTask]) -> Result<Vec<CheckedTask>> {
    if tasks.is_empty() {
        let problem = "no tip has a target: name one tip at least".into();
        return Err(Error::Contradiction { problem });
    }
    if tasks.iter().any(|task| task.task.is_some_and(|task| task.region.is_some())) {
        let problem = "a tracked region is for one tip: leave it out of the tasks of several".into();
        return Err(Error::Contradiction { problem });
    }
    let tasks = checked_tasks(robot, tasks)?;
    // A pair of a higher level gives way to the tips of a lower one.
    let lowest = tasks.iter().map(|task| task.level).min().unwrap_or_default();
    let is_held = |task: &CheckedTask| task.subject.is_pair() && task.level == lowest;
    let held = |task: CheckedTask| if is_held(&task) { task.held(PAIR_WEIGHT) } else { task };
    Ok(tasks.into_iter().map(held).collect())
}
