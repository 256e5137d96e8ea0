//! Planning from point to point.

use super::endpoint::Endpoint;
use super::plan::Plan;
use super::planner_options::{PointToPointMethod, PointToPointOptions};
use super::{minmax, tpbso};
use crate::error::Result;
use crate::robot::Robot;
use crate::solver::Monitor;

/// Plans a motion of `robot` from rest at `start` to rest at `end`.
///
/// # Errors
/// Any [`Error`](crate::Error) for wrong input, [`Error::Unreachable`](crate::Error::Unreachable) if an end is out of
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
    options.kept_margin()?;
    match &options.method {
        PointToPointMethod::MinMax => minmax::point_to_point(robot, start, end, options, monitor),
        PointToPointMethod::Tpbso(tpbso) => tpbso::point_to_point(robot, [start, end], tpbso, options, monitor),
    }
}
