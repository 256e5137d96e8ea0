//! The min-max planner: end configurations, then a straight line or a path around obstacles.

use super::moving_start::Beginning;
use super::pair_search::PairSearch;
use super::straight_line_plan::without_obstacles;
use crate::error::Result;
use crate::free_path::{among_obstacles, moving_start};
use crate::message::Setting;
use crate::obstacle::ClearSpace;
use crate::plan::{Deadline, Endpoint, Plan, PointToPointOptions};
use crate::robot::Robot;
use crate::solver::Monitor;
use crate::timing::ConstantLimits;

const METHOD: Setting = Setting::Method("minmax");

/// Plans from `start` to one of `ends` in `space`; see [`plan_point_to_point`](crate::planning::plan_point_to_point).
pub(crate) fn point_to_point(
    robot: &Robot,
    start: &Endpoint,
    ends: &[Endpoint],
    space: Option<&ClearSpace<'_>>,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let deadline = Deadline::start(options.stop.as_ref());
    let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), METHOD)?;
    limits.require_pace()?;
    let mut search = PairSearch::new(robot, &limits, start, ends, options, deadline)?;
    if let Some(velocity) = &options.start_velocity {
        match moving_start::begin(&mut search, velocity, space, options, monitor)? {
            Beginning::Whole(plan) => return Ok(*plan),
            Beginning::Stop(stop) => {
                let at_rest = Endpoint::at_end_of(&stop)?;
                let options = PointToPointOptions { start_velocity: None, ..options.clone() };
                let rest = point_to_point(robot, &at_rest, ends, space, &options, monitor)?;
                return moving_start::followed_by(stop, rest, robot, space);
            }
            Beginning::Rest => {}
        }
    }
    match space {
        Some(space) => among_obstacles::plan(&mut search, space, options, monitor),
        None if options.keeps.is_empty() && !limits.limit_torque() => {
            without_obstacles(&mut search, options.objective, monitor)
        }
        None => {
            let plan = among_obstacles::plan(&mut search, &ClearSpace::empty(robot)?, options, monitor)?;
            Ok(Plan { clearance: None, surroundings: None, ..plan })
        }
    }
}
