//! The start or end of a motion.

use smallvec::smallvec;

use super::collision_checks::configuration_at;
use crate::error::{Error, Result};
use crate::ik::{checked_tasks, reduce};
use crate::message::{Message, message};
use crate::robot::Robot;
use crate::task::{NamedTask, Target, TargetRow, Task, Tolerance};
use crate::trajectory::Trajectory;

/// The start of a motion, or one of its possible ends.
#[derive(Debug, Clone, PartialEq)]
pub enum Endpoint {
    /// Targets of the tips; the planner chooses the configuration.
    Targets {
        /// The tasks of several tips, in the order of their targets; tips without one are free. Empty for a plain target of the only tip.
        tips: Vec<NamedTask>,
        /// The targets.
        targets: TargetRow,
    },
    /// A configuration (n,) (rad, m).
    Configuration(Vec<f64>),
}

impl Endpoint {
    /// The configuration at the end of a motion.
    ///
    /// # Errors
    /// None in practice: the duration is finite.
    pub(crate) fn at_end_of(motion: &Trajectory) -> Result<Self> {
        configuration_at(motion, motion.duration()).map(Self::Configuration)
    }
}

impl From<Target> for Endpoint {
    fn from(target: Target) -> Self {
        Self::Targets { tips: vec![], targets: smallvec![target] }
    }
}

/// Number of ends that a message lists.
const NAMED_IN_MESSAGE: usize = 8;

impl Endpoint {
    /// Checks that all numbers are finite, that a configuration has one per joint, and that `task` takes a target of this
    /// kind; `name` names the end.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::WrongLength`], [`Error::WrongTarget`], or those of wrong tasks of several tips.
    pub(crate) fn check(&self, name: EndName, robot: &Robot, task: Option<&Task>) -> Result<()> {
        match self {
            Self::Targets { tips, targets } if tips.is_empty() => {
                robot.require_one_tip("a plain target of plan_point_to_point")?;
                targets.iter().try_for_each(|target| target.validate_as(&name.of_target()))?;
                let only = NamedTask::of_only(task.copied(), Tolerance::default()).validated()?;
                reduce(robot, &[only], &mut targets.clone())
            }
            Self::Targets { tips, targets } => {
                targets.iter().try_for_each(Target::validate)?;
                reduce(robot, &checked_tasks(robot, tips)?, &mut targets.clone())
            }
            Self::Configuration(q) => robot.check(&name.of_configuration(), q),
        }
    }
}

/// The name of an end in messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EndName {
    /// The start.
    Start,
    /// The only end.
    End,
    /// One of several ends, counted from 0.
    OneOf(usize),
}

impl EndName {
    /// The name of end `index` of `count`.
    pub(crate) fn of(index: usize, count: usize) -> Self {
        if count == 1 { Self::End } else { Self::OneOf(index) }
    }

    /// The argument of the target, e.g. `end[3]`.
    pub(crate) fn of_target(self) -> String {
        self.argument("")
    }

    /// The argument of the configuration, e.g. `end_q[3]`.
    pub(crate) fn of_configuration(self) -> String {
        self.argument("_q")
    }

    /// The argument of this end as it was given.
    pub(crate) fn of_given(self, end: &Endpoint) -> String {
        match end {
            Endpoint::Targets { .. } => self.of_target(),
            Endpoint::Configuration(_) => self.of_configuration(),
        }
    }

    fn argument(self, suffix: &str) -> String {
        match self {
            Self::Start => format!("start{suffix}"),
            Self::End => format!("end{suffix}"),
            Self::OneOf(index) => format!("end{suffix}[{index}]"),
        }
    }
}

/// The error of a motion to `count` ends, none of which can be used; `problems` holds the error of each.
pub(crate) fn no_usable_end(count: usize, mut problems: Vec<Error>) -> Error {
    if count == 1 && problems.len() == 1 {
        return problems.swap_remove(0);
    }
    let brief = |error: &Error| match error {
        Error::Unreachable { what, problem } => message![what.as_str(), ": ", problem.clone()],
        other => other.to_string().into(),
    };
    let mut named: Vec<Message> = problems.iter().take(NAMED_IN_MESSAGE).map(brief).collect();
    if let Some(more @ 1..) = problems.len().checked_sub(NAMED_IN_MESSAGE) {
        named.push(format!("and {more} more").into());
    }
    Error::NoUsableEnd { count, problems: Message::joined(named, "; ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_several_ends_names_each_and_that_of_one_is_its_own() {
        let missed = |i: usize| Error::Unreachable { what: format!("end[{i}]"), problem: format!("{i} m away").into() };
        assert_eq!(no_usable_end(1, vec![missed(0)]), missed(0));
        assert_eq!(
            no_usable_end(2, vec![missed(0), missed(1)]).to_string(),
            "none of the 2 ends can be reached: end[0]: 0 m away; end[1]: 1 m away"
        );
        let many = no_usable_end(10, (0..10).map(missed).collect()).to_string();
        assert!(many.ends_with("end[7]: 7 m away; and 2 more"), "{many}");
    }
}
