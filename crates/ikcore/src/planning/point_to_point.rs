//! Planning from point to point.

use super::admitted_ends::AdmittedEnds;
use super::several_tips::tip_ends;
use crate::approach_retreat::composed;
use crate::error::{Error, Result};
use crate::message::{Message, Setting, message};
use crate::obstacle::ClearSpace;
use crate::plan::{Cost, EndName, Endpoint, Plan, PointToPointMethod, PointToPointOptions, motion_space};
use crate::robot::Robot;
use crate::solver::{Monitor, Stopwatch};
use crate::task::Task;
use crate::timing::ConstantLimits;
use crate::{free_path, tpbso};

/// Plans a motion of `robot` from `start` to rest at one of `ends`, the one with the lowest cost of those found. It begins at
/// rest, or with the velocity of the options.
///
/// Ends that cannot be reached or are in collision are passed over, unless all are.
///
/// # Errors
/// Any [`Error`] for wrong input, [`Error::Unreachable`] if the start or the only end is out of reach,
/// [`Error::NoUsableEnd`] if all of several ends are. A plan that violates limits is a status, not an error.
pub fn plan_point_to_point(
    robot: &Robot,
    start: &Endpoint,
    ends: &[Endpoint],
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    check_point_to_point(robot, start, ends, options)?;
    require_joint_space(robot, options)?;
    let space = motion_space(&options.surroundings, robot)?;
    let admitted = AdmittedEnds::read(robot, start, ends, options)?;
    let mut plan = plan_admitted(robot, &admitted, space.as_ref(), options, monitor)?;
    plan.note_kept(robot, &options.keeps)?;
    admitted.note(robot, ends, &mut plan);
    Ok(plan)
}

/// [`plan_point_to_point`] between ends that the gate has taken.
fn plan_admitted(
    robot: &Robot,
    AdmittedEnds { start, ends, .. }: &AdmittedEnds,
    space: Option<&ClearSpace<'_>>,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let names_tips = |end: &Endpoint| matches!(end, Endpoint::Targets { tips, .. } if !tips.is_empty());
    if !std::iter::once(start).chain(ends).any(names_tips) {
        return plan_joined(robot, start, ends, space, options, monitor);
    }
    let stopwatch = Stopwatch::start();
    let tips = tip_ends(robot, start, ends, space, options, monitor)?;
    let mut plan = plan_joined(robot, &tips.start, &tips.ends, space, options, monitor)?;
    plan.chosen_end = plan.chosen_end.and_then(|chosen| tips.origins.get(chosen).copied());
    plan.evaluations += tips.evaluations;
    plan.elapsed = stopwatch.elapsed();
    Ok(plan)
}

/// [`plan_point_to_point`] between configurations, or plain targets of the only tip, which have been checked.
fn plan_joined(
    robot: &Robot,
    start: &Endpoint,
    ends: &[Endpoint],
    space: Option<&ClearSpace<'_>>,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let mut plan = match &options.method {
        PointToPointMethod::MinMax if options.has_pieces() => composed(robot, start, ends, space, options, monitor),
        PointToPointMethod::MinMax => free_path::point_to_point(robot, start, ends, space, options, monitor),
        PointToPointMethod::Tpbso(tpbso) => {
            let end = only_end(ends, options)?;
            tpbso::point_to_point(robot, [start, end], space, (tpbso, options), monitor)
        }
    }
    .map_err(|error| with_way_out(error, options))?;
    plan.name_peak(&ConstantLimits::for_robot(robot, options.limits.as_ref(), "plan_point_to_point")?);
    Ok(plan)
}

/// Checks that options for one tip alone are not given for several.
///
/// # Errors
/// [`Error::SeveralTips`].
fn require_joint_space(robot: &Robot, options: &PointToPointOptions) -> Result<()> {
    let cases = [
        (options.task.is_some(), Setting::OneTask.into()),
        (options.has_pieces(), "plan_point_to_point with approach, retreat or free_start".into()),
        (
            matches!(options.method, PointToPointMethod::Tpbso(_)),
            message![Setting::Method("tpbso"), " of plan_point_to_point"],
        ),
        (options.objective == Cost::TipTravel, "the objective 'tip_travel' of plan_point_to_point".into()),
    ];
    cases.into_iter().filter(|(is_asked, _)| *is_asked).try_for_each(|(_, call)| robot.require_one_tip(call))
}

/// Checks the arguments of [`plan_point_to_point`]: numbers, lengths and kinds, not what only a planner finds out.
///
/// # Errors
/// Any [`Error`] for wrong input.
pub(crate) fn check_point_to_point(
    robot: &Robot,
    start: &Endpoint,
    ends: &[Endpoint],
    options: &PointToPointOptions,
) -> Result<()> {
    let task = options.task.as_ref();
    task.map_or(Ok(()), Task::validate)?;
    start.check(EndName::Start, robot, task)?;
    if ends.is_empty() {
        return Err(Error::Contradiction { problem: "no end was given: give at least one".into() });
    }
    for (line, what) in [(&options.approach, "approach"), (&options.retreat, "retreat")] {
        if let Some(line) = line {
            line.validate(what)?;
            line.check_obstacles(what, options.surroundings.obstacles().len())?;
        }
    }
    if options.start_velocity.is_some() && (options.retreat.is_some() || options.free_start) {
        let problem = message![
            Setting::StartVelocity,
            " cannot be kept by a motion that begins with retreat or free_start, from rest"
        ];
        return Err(Error::Contradiction { problem });
    }
    for (i, end) in ends.iter().enumerate() {
        end.check(EndName::of(i, ends.len()), robot, task)?;
    }
    options.keeps.iter().try_for_each(|keep| keep.require_tips(robot))?;
    options.surroundings.kept_margin().map(|_| ())
}

/// Names the remedy for a start in contact, or says that it did not help.
fn with_way_out(error: Error, options: &PointToPointOptions) -> Error {
    match error {
        Error::InCollision { what, link, other, depth, remedy }
            if what == EndName::Start.of_configuration()
                && remedy.is_empty()
                && options.start_velocity.is_none()
                && options.method == PointToPointMethod::MinMax =>
        {
            let does =
                if options.free_start { " found no way out on which nothing comes nearer" } else { " moves out first" };
            Error::InCollision { what, link, other, depth, remedy: message!["; ", Setting::FreeStart, does] }
        }
        other => other,
    }
}

/// The end of a motion by [`Tpbso`](super::Tpbso), checked for options beyond the published method.
fn only_end<'a>(ends: &'a [Endpoint], options: &PointToPointOptions) -> Result<&'a Endpoint> {
    let refused = |what: Message, does: &str| {
        let [other, method] = ["minmax", "tpbso"].map(Setting::Method);
        Err(Error::Contradiction { problem: message![what, " by ", other, ": ", method, " ", does] })
    };
    match ends {
        _ if options.start_velocity.is_some() => {
            refused(message![Setting::StartVelocity, " is kept"], "begins at rest")
        }
        _ if options.has_pieces() => refused("approach, retreat and free_start are kept".into(), "has no such pieces"),
        _ if !options.keeps.is_empty() => refused("keep is held".into(), "checks nothing on the way"),
        _ if options.task.is_some() => refused("task is kept".into(), "reaches whole targets"),
        [end] => Ok(end),
        _ => refused("several ends are taken".into(), "plans to one"),
    }
}
