//! Tasks of a solve: validation, the target components that they use, and their errors.

use smallvec::{SmallVec, smallvec};

use super::solve_options::SolveOptions;
use crate::error::{Error, Result};
use crate::interrupt::checkpoint_at;
use crate::message::Setting;
use crate::robot::Robot;
use crate::task::{Aims, CheckedTask, NamedTask, Subject, Target, TargetRow, TipError};

/// Validates the tasks of `options`; without named tips, the one task of a plain target.
#[inline]
pub(super) fn asked_tasks(robot: &Robot, options: &SolveOptions) -> Result<SmallVec<[CheckedTask; 1]>> {
    if options.tips.is_empty() {
        robot.require_one_tip("a plain target")?;
        return Ok(smallvec![NamedTask::of_only(options.task, options.tolerance).validated()?]);
    }
    if options.task.is_some() {
        return Err(Error::Contradiction { problem: Setting::TaskOfEachTip.into() });
    }
    Ok(checked_tasks(robot, &options.tips)?.into())
}

/// Validates these tasks.
///
/// # Errors
/// [`Error::OutOfRange`] for an unknown tip, [`Error::Contradiction`] for a tip or pair that is named twice; errors of
/// [`Subject::center_of_mass`], of wrong tasks and tolerances.
pub(crate) fn checked_tasks(robot: &Robot, tasks: &[NamedTask]) -> Result<Vec<CheckedTask>> {
    let tips: Vec<&str> = robot.tips().collect();
    for (i, task) in tasks.iter().enumerate() {
        let numbers = match task.subject {
            Subject::Tip(tip) => [tip; 2],
            Subject::Pair { from, of } => [from, of],
            Subject::CenterOfMass => {
                Subject::center_of_mass(robot)?;
                [0; 2]
            }
        };
        if let Some(number) = numbers.into_iter().find(|number| *number >= tips.len()) {
            let expected = format!("the number of one of {} tips, from 0 on", tips.len());
            return Err(Error::out_of_range("tip", &expected, number as f64));
        }
        if matches!(task.subject, Subject::Pair { .. }) && numbers[0] == numbers[1] {
            let problem = format!("tip '{}' cannot be seen from itself: name two tips", tips[numbers[0]]);
            return Err(Error::Contradiction { problem: problem.into() });
        }
        let same = |other: &NamedTask| other.subject == task.subject || other.subject == turned(task.subject);
        if tasks[..i].iter().any(same) {
            let [from, of] = numbers.map(|number| tips[number]);
            let problem = match task.subject {
                Subject::Tip(_) => format!("tip '{of}' has two targets"),
                Subject::Pair { .. } => format!("the pair of tips '{from}' and '{of}' has two targets: leave one out"),
                Subject::CenterOfMass => "the centre of mass has two targets".into(),
            };
            return Err(Error::Contradiction { problem: problem.into() });
        }
    }
    tasks.iter().map(NamedTask::validated).collect()
}

/// Reverses a pair, as seen from its other tip.
fn turned(subject: Subject) -> Subject {
    match subject {
        Subject::Tip(_) | Subject::CenterOfMass => subject,
        Subject::Pair { from, of } => Subject::Pair { from: of, of: from },
    }
}

/// Reduces targets to the parts that their tasks use.
///
/// # Errors
/// [`Error::WrongLength`], [`Error::WrongTarget`], or [`Error::Contradiction`] for targets that contradict each other.
pub(crate) fn reduce(robot: &Robot, tasks: &[CheckedTask], targets: &mut [Target]) -> Result<()> {
    if tasks.len() != targets.len() {
        let expected = format!("{} targets, one for each task", tasks.len());
        return Err(Error::WrongLength { what: "targets".into(), expected, got: targets.len() });
    }
    tasks.iter().zip(&mut *targets).try_for_each(|(task, target)| task.reduce(target))?;
    Aims { tasks, targets }.require_consistent(robot)
}

/// Errors of each task of several tips at each of the configurations `qs` (m, n), row-major; NaN if a configuration or a target
/// is not finite. `targets` returns the targets of a row.
///
/// # Errors
/// Errors of wrong tasks.
pub fn tip_errors(
    robot: &Robot,
    targets: impl Fn(usize) -> TargetRow,
    options: &SolveOptions,
    qs: &[f64],
) -> Result<Vec<TipError>> {
    let tasks = asked_tasks(robot, options)?;
    let mut errors = Vec::with_capacity(tasks.len() * qs.len() / robot.dof());
    for (row, q) in qs.chunks_exact(robot.dof()).enumerate() {
        checkpoint_at(row)?;
        let mut targets = targets(row);
        match reduce(robot, &tasks, &mut targets) {
            Ok(()) if q.iter().all(|value| value.is_finite()) => {
                errors.extend(Aims { tasks: &tasks, targets: &targets }.errors(robot, q));
            }
            _ => errors.extend(tasks.iter().map(|_| TipError { position: f64::NAN, rotation: f64::NAN })),
        }
    }
    Ok(errors)
}
