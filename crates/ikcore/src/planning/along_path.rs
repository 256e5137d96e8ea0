//! Planning along a given path.

use super::cost::Cost;
use super::motion_limits::MotionLimits;
use super::plan::Plan;
use super::planner_options::{AlongPathMethod, AlongPathOptions};
use super::tip_path::TipPath;
use super::{timed, tpbso};
use crate::error::{Error, Result};
use crate::robot::Robot;
use crate::solver::Monitor;

/// Plans a motion of `robot` whose tip follows `tip_path`.
///
/// # Errors
/// Any [`Error`] for wrong input, [`Error::Unreachable`] if a point is out of reach. A plan that violates limits is a
/// status, not an error.
pub fn plan_along_path(
    robot: &Robot,
    tip_path: &TipPath,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    if options.objective == Cost::TipTravel {
        return Err(Error::unknown_option("objective along a path", "tip_travel", &["time", "joint_travel"]));
    }
    let mut plan = match &options.method {
        AlongPathMethod::Timed => timed::along_path(robot, tip_path, options, monitor),
        AlongPathMethod::Tpbso(_) if options.solver.is_some() => Err(Error::Contradiction {
            problem: "solver is the search of method=\"timed\": give method=TPBSO(solver=...) its own".into(),
        }),
        AlongPathMethod::Tpbso(tpbso) => tpbso::along_path(robot, tip_path, tpbso, options, monitor),
    }?;
    plan.name_peak(&MotionLimits::new(robot, options.limits.as_ref(), "plan_along_path")?);
    Ok(plan)
}
