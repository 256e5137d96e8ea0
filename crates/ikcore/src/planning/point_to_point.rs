//! Planning from point to point.

use super::endpoint::Endpoint;
use super::motion_limits::MotionLimits;
use super::plan::Plan;
use super::planner_options::{PointToPointMethod, PointToPointOptions};
use super::{minmax, tpbso};
use crate::error::{Error, Result};
use crate::obstacle::kept_margin;
use crate::robot::Robot;
use crate::solver::Monitor;

/// Plans a motion of `robot` from `start` to rest at `end`. It begins at rest, or with the velocity of the options.
///
/// # Errors
/// Any [`Error`] for wrong input, [`Error::Unreachable`] if an end is out of
/// reach. A plan that violates limits is a status, not an error.
pub fn plan_point_to_point(
    robot: &Robot,
    start: &Endpoint,
    end: &Endpoint,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    start.check("start", robot)?;
    end.check("end", robot)?;
    kept_margin(options.margin)?;
    let mut plan = match &options.method {
        PointToPointMethod::MinMax => minmax::point_to_point(robot, start, end, options, monitor),
        PointToPointMethod::Tpbso(_) if options.start_velocity.is_some() => Err(Error::Contradiction {
            problem: "start_qd is kept by method=\"minmax\": method=\"tpbso\" begins at rest".into(),
        }),
        PointToPointMethod::Tpbso(tpbso) => tpbso::point_to_point(robot, [start, end], tpbso, options, monitor),
    }?;
    plan.name_peak(&MotionLimits::new(robot, options.limits.as_ref(), "plan_point_to_point")?);
    Ok(plan)
}
