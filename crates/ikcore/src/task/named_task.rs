//! Task of a tip, of a pair of tips or of the centre of mass, as given by the caller.

use serde::{Deserialize, Serialize};

use super::checked_task::CheckedTask;
use super::subject::Subject;
use super::tip_error::Tolerance;
use super::tip_task::{Task, TaskKind};
use crate::error::{Error, Result};
use crate::math::Frame;

/// Task of a tip, of a pair of tips, or of the centre of mass, which has a position alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NamedTask {
    /// Frame that the target refers to.
    pub subject: Subject,
    /// Part of the target to reach. `None` means all of it.
    pub task: Option<Task>,
    /// Tolerances within which the target counts as reached.
    pub tolerance: Tolerance,
}

impl NamedTask {
    /// Task of the only tip of a robot.
    #[inline]
    pub(crate) fn of_only(task: Option<Task>, tolerance: Tolerance) -> Self {
        Self { subject: Subject::Tip(0), task, tolerance }
    }

    /// Checks the task.
    ///
    /// # Errors
    /// Errors of [`Task::validate`] and of the tolerances; [`Error::Contradiction`] for a task of the centre of mass that is not
    /// of its position.
    #[inline]
    pub(crate) fn validated(&self) -> Result<CheckedTask> {
        let Self { subject, task, tolerance } = *self;
        task.map_or(Ok(()), |task| task.validate())?;
        if subject == Subject::CenterOfMass
            && let Some(Task { kind, tool, .. }) = task
            && (kind != TaskKind::Position || tool.is_some())
        {
            let given = if tool.is_some() { "a tool" } else { kind.name() };
            let problem = format!("the centre of mass takes task Position without a tool, got {given}");
            return Err(Error::Contradiction { problem: problem.into() });
        }
        let criterion = task.map_or(tolerance.into(), |task| task.criterion(tolerance));
        criterion.validate()?;
        let tool = task.and_then(|task| task.tool).map(|tool| Box::new(Frame::from(&tool)));
        let (kind, first) = (task.map(|task| task.kind), task.and_then(|task| task.first));
        let level = task.map_or(0, |task| task.level);
        Ok(CheckedTask { subject, kind, criterion, first, level, tool, weight: 1.0, is_held: false })
    }
}
