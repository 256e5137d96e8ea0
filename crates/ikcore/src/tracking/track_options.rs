//! Options of `track` and of a session.

use super::rule::TickRule;
use crate::error::{Error, Result};
use crate::limits::{LimitAt, Limits};
use crate::robot::Robot;
use crate::task::{Criterion, Goal, Task, Tolerance};

/// Options of [`track`](super::track) and [`Session`](super::Session).
#[derive(Debug, Clone, Default)]
pub struct TrackOptions {
    /// The rule that runs in every tick.
    pub rule: TickRule,
    /// The part of the path that matters; None: all of it.
    pub task: Option<Task>,
    /// Goals in the null space of the task.
    pub goals: Vec<Goal>,
    /// The error band.
    pub tolerance: Tolerance,
    /// Limits to keep; None keeps the robot's.
    pub limits: Option<Limits>,
    /// Where in a tick its velocity limit is taken.
    pub limit_at: LimitAt,
    /// Seed of the random draws: the same seed, the same bits.
    pub seed: u64,
}

impl TrackOptions {
    /// When a tick is within its band.
    pub(super) fn criterion(&self) -> Result<Criterion> {
        self.task.as_ref().map_or(Ok(()), Task::validate)?;
        let criterion = self.task.map_or(self.tolerance.into(), |task| task.criterion(self.tolerance));
        criterion.validate().map(|()| criterion)
    }

    /// Checks that the rule serves the goals, and the goals the robot.
    pub(super) fn check_goals(&self, robot: &Robot) -> Result<()> {
        if !self.goals.is_empty() && !self.rule.serves_goals() {
            let problem = "goals beside the path are served by the library's own rule and by WeightedPseudoInverse: leave \
                           solver out";
            return Err(Error::Contradiction { problem: problem.into() });
        }
        self.goals.iter().try_for_each(|goal| goal.validate(robot))
    }

    /// The limits in force for `robot`.
    pub(super) fn limits_for(&self, robot: &Robot) -> Limits {
        self.limits.clone().unwrap_or_else(|| Limits::of(robot))
    }
}
