//! Planning along a given path.

use std::borrow::Cow;

use super::with_breaks::BrokenPath;
use crate::along_path::timed::{PathKeeps, PathProblem};
use crate::along_path::{TipPath, clear_path, missed_points, timed};
use crate::error::{Error, Result};
use crate::limits::AdmittedStart;
use crate::message::{Setting, message};
use crate::plan::{AlongPathMethod, AlongPathOptions, Cost, Plan};
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stop, Stopwatch};
use crate::timing::ConstantLimits;
use crate::tpbso;

/// Parts of the tolerance within which a motion is sought where none was found in all of it.
const PARTS: [f64; 3] = [0.1, 0.01, 0.0];

/// Plans a motion of `robot` whose tip follows `tip_path`.
///
/// # Errors
/// Any [`Error`] for wrong input, [`Error::Unreachable`] if a point is out of reach, [`Error::NotFound`] if no motion was found. A plan
/// that violates limits or comes too near to something is a status, not an error.
pub fn plan_along_path(
    robot: &Robot,
    tip_path: &TipPath,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    robot.require_one_tip("plan_along_path")?;
    if options.objective == Cost::TipTravel {
        return Err(Error::unknown_option("objective along a path", "tip_travel", &["time", "joint_travel"]));
    }
    if let Some(first) = options.task.and_then(|task| task.first) {
        let problem = message![
            Setting::First(first.name()),
            " has no effect along a path, to all of which the tip keeps: give the other part a tolerance, or leave it free"
        ];
        return Err(Error::Contradiction { problem });
    }
    let mut tip_path = options
        .task
        .map_or(Ok(Cow::Borrowed(tip_path)), |task| tip_path.for_task(&task, options.accuracy).map(Cow::Owned))?;
    if options.accuracy.is_none() && tip_path.turn_coarseness() > 0.0 {
        tip_path = Cow::Owned(tip_path.into_owned().into_sampled());
    }
    options.keeps.iter().try_for_each(|keep| keep.require_tips(robot))?;
    let keeps = PathKeeps { robot, keeps: &options.keeps };
    let with_tool = options.task.map_or(Ok(None), |task| task.robot(robot))?;
    let robot = with_tool.as_ref().unwrap_or(robot);
    let limits = ConstantLimits::for_robot(keeps.robot, options.limits.as_ref(), options.method.named())?;
    if options.breaks && matches!(options.method, AlongPathMethod::Tpbso(_)) {
        let problem = message!["leaving the path at breaks needs ", Setting::Method("timed")];
        return Err(Error::Contradiction { problem });
    }
    let planned = match options.admitted_start(robot, &limits)? {
        None => plan_admitted(robot, &tip_path, keeps, options, monitor),
        Some(start) => plan_from(robot, &tip_path, keeps, (start, &limits), options, monitor),
    };
    let broken = BrokenPath { robot, tip_path: &tip_path, keeps, options };
    let mut plan = match options.breaks {
        true if is_lost(&planned) => broken.plan(monitor)?.map_or(planned, Ok)?,
        true if limits.limit_torque() && matches!(planned, Err(Error::Infeasible { .. })) => match broken.plan(monitor)
        {
            Err(Error::NotFound { .. } | Error::Unreachable { .. } | Error::Infeasible { .. }) => planned?,
            broken => broken?.map_or(planned, Ok)?,
        },
        _ => planned?,
    };
    plan.note_kept(keeps.robot, keeps.keeps)?;
    plan.name_peak(&limits);
    Ok(plan)
}

/// Whether no motion was found that follows the whole path.
fn is_lost(planned: &Result<Plan>) -> bool {
    match planned {
        Ok(plan) => !plan.violations.is_empty() && plan.status != Status::Interrupted && plan.start_outside.is_empty(),
        Err(error) => matches!(error, Error::NotFound { .. } | Error::Unreachable { .. }),
    }
}

/// Plans from a start that the gate has taken. Where no motion leads its joints inside at once, they may stay outside, but go no farther
/// out, and must be inside at the end.
fn plan_from(
    robot: &Robot,
    tip_path: &TipPath,
    keeps: PathKeeps<'_>,
    (start, limits): (AdmittedStart, &ConstantLimits),
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let AdmittedStart { q, outside } = start;
    let options = AlongPathOptions { start: Some(q.clone()), ..options.clone() };
    let mut planned = plan_admitted(robot, tip_path, keeps, &options, monitor);
    let begins_there = |planned: &Result<Plan>| planned.as_ref().is_ok_and(|plan| plan.trajectory.start() == q);
    let succeeded = |planned: &Result<Plan>| planned.as_ref().is_ok_and(|plan| plan.violations.is_empty());
    let is_led = begins_there(&planned) && succeeded(&planned);
    if !outside.is_empty() && !is_led {
        let widened = limits.widened_to(robot, options.limits.as_ref(), &q)?;
        let wider = AlongPathOptions { limits: Some(widened), ..options };
        let again = plan_admitted(robot, tip_path, keeps, &wider, monitor);
        let ends_inside = again.as_ref().is_ok_and(|plan| limits.contain(&plan.trajectory.end()));
        if !begins_there(&planned) || (succeeded(&again) && ends_inside) {
            planned = again;
        }
    }
    planned.map(|plan| Plan { start_outside: outside, ..plan })
}

/// [`plan_along_path`] with checked options.
fn plan_admitted(
    robot: &Robot,
    tip_path: &TipPath,
    keeps: PathKeeps<'_>,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let space = options.surroundings.clear_space(robot)?;
    match (&options.method, &space) {
        (AlongPathMethod::Timed, space) => within_tolerance(tip_path, options.stop, |tip_path| {
            let problem = PathProblem::new(robot, tip_path, keeps, options)?;
            match space {
                None => free_motion(&problem, monitor),
                Some(space) => clear_path::along_path(&problem, Some(space), monitor),
            }
        }),
        (AlongPathMethod::Tpbso(_), _) if options.task.is_some() || space.is_some() => Err(Error::Contradiction {
            problem: message!["along a path a task, obstacles and self-collision need ", Setting::Method("timed")],
        }),
        (AlongPathMethod::Tpbso(_), _) if !options.keeps.is_empty() => Err(Error::Contradiction {
            problem: message!["what is to be kept along a path needs ", Setting::Method("timed")],
        }),
        (AlongPathMethod::Tpbso(_), _) if options.solver.is_some() => Err(Error::Contradiction {
            problem: message![
                "solver is the search of ",
                Setting::Method("timed"),
                ": give ",
                Setting::MethodWithSolver,
                " its own",
            ],
        }),
        (AlongPathMethod::Tpbso(tpbso), _) => tpbso::along_path(robot, tip_path, tpbso, options, monitor),
    }
}

/// Plans within the whole tolerance and, where no motion is found, within parts of it, until the time of `stop` is over.
fn within_tolerance(
    tip_path: &TipPath,
    stop: Option<Stop>,
    mut along: impl FnMut(&TipPath) -> Result<Plan>,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let planned = along(tip_path);
    if tip_path.largest_tolerance() == 0.0 || !is_lost(&planned) || matches!(planned, Err(Error::Unreachable { .. })) {
        return planned;
    }
    let evaluations_of = |planned: &Result<Plan>| planned.as_ref().map_or(0, |plan| plan.evaluations);
    let mut evaluations = evaluations_of(&planned);
    let is_over = || stop.and_then(|stop| stop.max_time).is_some_and(|most| stopwatch.elapsed() >= most);
    for part in PARTS.into_iter().take_while(|_| !is_over()) {
        let narrower = along(&tip_path.within_part(part));
        evaluations += evaluations_of(&narrower);
        if !is_lost(&narrower) {
            return narrower.map(|plan| Plan { evaluations, elapsed: stopwatch.elapsed(), ..plan });
        }
    }
    planned
}

/// Plans without regard to obstacles: around a motion that follows the path from a few starts or, where that leads to no plan without
/// violations, through layers of postures.
fn free_motion(problem: &PathProblem<'_>, monitor: &mut dyn Monitor) -> Result<Plan> {
    let PathProblem { robot, tip_path, options, .. } = problem;
    let mut followed = match timed::along_path(problem, monitor) {
        Err(heavy @ Error::Infeasible { .. }) if problem.limits.limit_torque() => {
            return clear_path::along_path(problem, None, monitor).map_err(|error| match error {
                Error::NotFound { .. } | Error::Infeasible { .. } => heavy,
                other => other,
            });
        }
        other => other?,
    };
    if let Some(plan) = &mut followed {
        plan.note_kept(problem.keeps.robot, problem.keeps.keeps)?;
    }
    let missed = match followed {
        Some(plan) if plan.violations.is_empty() || plan.status == Status::Interrupted => return Ok(plan),
        Some(_) => None,
        None => missed_points(robot, tip_path, options.seed)?,
    };
    if let Some(proven @ Error::Unreachable { .. }) = missed {
        return Err(proven);
    }
    match (clear_path::along_path(problem, None, monitor), followed) {
        (Ok(plan), Some(followed)) => Ok(if plan.violations.is_empty() { plan } else { followed }),
        (Err(Error::NotFound { .. } | Error::Unreachable { .. }), Some(followed)) => Ok(followed),
        (Err(not_found @ Error::NotFound { .. }), None) => Err(missed.unwrap_or(not_found)),
        (result, _) => result,
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::path::Waypoints;
    use crate::task::{Components, Task, TaskKind};
    use crate::timing::Violation;
    use crate::trajectory::{Trajectory, polynomial};

    /// Plans a path of positions with a tolerance of 1 mm, along which a motion is found within `most` of it only, by five evaluations; and
    /// counts the tries.
    fn plan_within(most: f64, stop: Option<Stop>) -> (Result<Plan>, usize) {
        let points = Waypoints::new(vec![[0.0; 3], [1.0, 0.0, 0.0]], None).unwrap();
        let components = Some(Components { weights: [1.0; 6], tolerance: Some([1e-3; 6]) });
        let task = Task { components, ..Task::from(TaskKind::Position) };
        let tip_path = TipPath::through(&points).unwrap().for_task(&task, Some(0.0)).unwrap();
        let mut tries = 0;
        let along = |tip_path: &TipPath| {
            tries += 1;
            let motion = Trajectory::new(vec!["a".into()], vec![0.0, 1.0], vec![polynomial([0.0])])?;
            let plan = Plan { evaluations: 5, ..Plan::of(motion, Cost::Time, 1.0) };
            let violations = vec![Violation { what: "speed".into(), value: 2.0, bound: 1.0, unit: "rad/s".into() }];
            Ok(if tip_path.largest_tolerance() > most { Plan { violations, ..plan } } else { plan })
        };
        let planned = within_tolerance(&tip_path, stop, along);
        (planned, tries)
    }

    #[test]
    fn parts_of_a_tolerance_are_tried_until_one_leaves_a_motion() {
        for (most, tries) in [(1.0, 1), (2e-4, 2), (2e-5, 3), (0.0, 4)] {
            let (planned, tried) = plan_within(most, None);
            let plan = planned.unwrap();
            assert!(plan.violations.is_empty());
            assert_eq!((tried, plan.evaluations), (tries, 5 * tries));
        }
    }

    #[test]
    fn no_part_is_tried_after_the_time_and_the_first_plan_is_kept() {
        let stop = Stop { max_time: Some(Duration::ZERO), ..Stop::default() };
        let (planned, tried) = plan_within(2e-4, Some(stop));
        assert_eq!((tried, planned.unwrap().violations.len()), (1, 1));
        let (planned, tried) = plan_within(-1.0, None);
        assert_eq!((tried, planned.unwrap().violations.len()), (4, 1));
    }
}
