//! Trajectory planning by beetle swarm optimisation (TPBSO): Wang et al. (2019), "A New Trajectory-Planning Beetle Swarm
//! Optimization Algorithm for Trajectory Planning of Robot Manipulators".
//!
//! | file | paper |
//! |---|---|
//! | [`rest_segment`] | the segments of eq. (3)-(6), their extremes in closed form |
//! | [`placement`] | the redundancy at the ends; any robot by inverse kinematics |
//! | [`via_point`] | the decision vector and cost from end to end, eq. (8)-(18) |
//! | [`search`] | any solver on such a cost |

mod placement;
mod rest_segment;
mod search;
mod via_point;

use super::{AlongPathOptions, End, MotionLimits, Plan, PointToPointOptions};
use crate::error::{Error, Result};
use crate::path::Reference;
use crate::robot::Robot;
use crate::solver::Monitor;
use crate::solver::stop::Stopwatch;
use placement::Placement;
use search::Search;
use via_point::ViaPointCost;

/// Plans from end to end.
pub(super) fn point_to_point(
    robot: &Robot,
    start: &End,
    end: &End,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = MotionLimits::new(robot, options.limits.as_ref(), METHOD)?;
    limits.require_velocities(METHOD)?;
    let [start_elbow, end_elbow] = options.elbows;
    let start = Placement::new("start", start, robot, &limits, start_elbow, options.seed, monitor)?;
    let end = Placement::new("end", end, robot, &limits, end_elbow, options.seed, monitor)?;
    let mut cost = ViaPointCost::new(robot, &limits, start, end, options.objective);
    let search = Search { solver: options.solver.as_ref(), stop: options.stop, seed: options.seed };
    let bounds = cost.bounds();
    let found = search.run(&mut cost, &bounds, monitor)?;
    let trajectory = cost.trajectory(&found.x).unwrap_or_else(|| Err(no_configuration()))?;
    let violations = limits.violations(&trajectory);
    let status = found.status(violations.is_empty());
    Ok(Plan {
        objective: options.objective,
        cost: options.objective.of(robot, &trajectory)?,
        history: found.history,
        clearance: None,
        status,
        violations,
        evaluations: found.evaluations,
        elapsed: stopwatch.elapsed(),
        trajectory,
    })
}

const METHOD: &str = "method=\"tpbso\"";

/// All that a search met had no inverse kinematics: of thousands of vectors that means a budget of a few.
fn no_configuration() -> Error {
    let problem = "the search met no configuration that reaches it: raise the budget in stop=Stop(...)".into();
    Error::Unreachable { what: "start or end".into(), problem }
}

pub(super) fn along_path(
    _robot: &Robot,
    _path: &Reference,
    _options: &AlongPathOptions,
    _monitor: &mut dyn Monitor,
) -> Result<Plan> {
    Err(Error::unknown_option("method", "tpbso", &[]))
}
