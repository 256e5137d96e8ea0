//! Planning along a given path.

use std::borrow::Cow;

use super::cost::Cost;
use super::motion_limits::MotionLimits;
use super::plan::Plan;
use super::planner_options::{AlongPathMethod, AlongPathOptions};
use super::tip_path::TipPath;
use super::{clear_path, timed, tpbso};
use crate::error::{Error, Result};
use crate::robot::Robot;
use crate::solver::Monitor;

/// Plans a motion of `robot` whose tip follows `tip_path`.
///
/// # Errors
/// Any [`Error`] for wrong input, [`Error::Unreachable`] if a point is out of reach. A plan that violates limits or comes
/// too near to something is a status, not an error.
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
    let tip_path = options
        .task
        .map_or(Ok(Cow::Borrowed(tip_path)), |task| tip_path.for_task(&task, options.accuracy).map(Cow::Owned))?;
    let with_tool = options.task.map_or(Ok(None), |task| task.robot(robot))?;
    let robot = with_tool.as_ref().unwrap_or(robot);
    let space = options.surroundings.clear_space(robot)?;
    let mut plan = match (&options.method, &space) {
        (AlongPathMethod::Timed, None) => timed::along_path(robot, &tip_path, options, monitor),
        (AlongPathMethod::Timed, Some(space)) => clear_path::along_path(robot, &tip_path, space, options, monitor),
        (AlongPathMethod::Tpbso(_), _) if options.task.is_some() || space.is_some() => Err(Error::Contradiction {
            problem: "along a path task=, obstacles= and self_collision= need method=\"timed\"".into(),
        }),
        (AlongPathMethod::Tpbso(_), _) if options.solver.is_some() => Err(Error::Contradiction {
            problem: "solver is the search of method=\"timed\": give method=TPBSO(solver=...) its own".into(),
        }),
        (AlongPathMethod::Tpbso(tpbso), _) => tpbso::along_path(robot, &tip_path, tpbso, options, monitor),
    }?;
    plan.name_peak(&MotionLimits::new(robot, options.limits.as_ref(), "plan_along_path")?);
    Ok(plan)
}
