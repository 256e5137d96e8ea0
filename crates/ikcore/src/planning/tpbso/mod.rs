//! Trajectory planning by beetle swarm optimisation (TPBSO): Wang et al. (2019), "A New Trajectory-Planning Beetle Swarm
//! Optimization Algorithm for Trajectory Planning of Robot Manipulators".
//!
//! | file | paper |
//! |---|---|
//! | [`rest_segment`] | the segments of eq. (3)-(6), their extremes in closed form |
//! | [`placement`] | the redundancy at the ends; any robot by inverse kinematics |
//! | [`via_point`] | the decision vector and cost from end to end, eq. (8)-(18) |
//! | [`surroundings`] | obstacles, eq. (14) and (18) |
//! | [`redundancy`] | the free orientations along a path, eq. (7) |
//! | [`path_cost`] | the decision vector and cost along a path, eq. (19)-(25) |
//! | [`search`] | any solver on such a cost |

mod path_cost;
mod placement;
mod redundancy;
mod rest_segment;
pub(super) mod search;
mod surroundings;
mod via_point;
mod weights;

use super::course::{Course, refuse_repetition};
use super::planar_arm::{Elbow, PlanarArm};
use super::{AlongPathOptions, Cost, End, MotionLimits, Plan, PointToPointOptions};
use crate::error::{Error, Result, require_positive};
use crate::robot::Robot;
use crate::solver::Monitor;
use crate::solver::stop::Stopwatch;
use path_cost::PathCost;
use placement::Placement;
use redundancy::Redundancy;
use search::Search;
use surroundings::Surroundings;
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
    let body = surroundings::body(robot, &options.obstacles)?;
    let lines = robot.capsules().is_empty();
    let surroundings = body.as_ref().map(|body| Surroundings::new(body, options, lines)).transpose()?;
    let mut place = |what: &str, end: &End, elbow: Elbow| {
        if let (End::Configuration(q), Some(surroundings)) = (end, &surroundings) {
            surroundings.refuse_collision(what, q)?;
        }
        Placement::new(what, end, robot, &limits, elbow, options.seed, monitor)
    };
    let [start_elbow, end_elbow] = options.elbows.unwrap_or_default();
    let (start, end) = (place("start", start, start_elbow)?, place("end", end, end_elbow)?);
    let mut cost = ViaPointCost::new(robot, &limits, [start, end], options.objective, surroundings.as_ref());
    let search = Search { solver: options.solver.as_ref(), stop: options.stop, seed: options.seed };
    let bounds = cost.bounds();
    let found = search.run(&mut cost, &bounds, monitor)?;
    let trajectory = cost.trajectory(&found.x).unwrap_or_else(|| Err(no_configuration("start or end")))?;
    let mut violations = limits.violations(&trajectory);
    let nearest = surroundings.and_then(|surroundings| surroundings.clearance(&trajectory));
    let clearance = nearest.map(|(distance, violation)| {
        violations.extend(violation);
        distance
    });
    let status = found.status(violations.is_empty());
    Ok(Plan {
        objective: options.objective,
        cost: options.objective.of(robot, &trajectory),
        accuracy: None,
        redundancy: vec![],
        history: found.history,
        clearance,
        status,
        violations,
        evaluations: found.evaluations,
        elapsed: stopwatch.elapsed(),
        trajectory,
    })
}

const METHOD: &str = "method=\"tpbso\"";

/// All that a search met had no inverse kinematics: of thousands of vectors that means a budget of a few, or free links that
/// rarely leave the others a way.
fn no_configuration(what: &str) -> Error {
    let problem = "the search met no configuration that reaches it: raise the budget in stop=Stop(...)".into();
    Error::Unreachable { what: what.into(), problem }
}

/// Plans along a path, for planar arms.
pub(super) fn along_path(
    robot: &Robot,
    course: &Course,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    require_path_cost(options)?;
    let arm = PlanarArm::of(robot).ok_or_else(|| not_planar(robot))?;
    let limits = MotionLimits::new(robot, options.limits.as_ref(), METHOD)?;
    limits.require_velocities(METHOD)?;
    if let Some(q) = &options.start {
        robot.check("start_q", q)?;
        limits.require_inside("start_q", q)?;
    }
    let elbow = options.start.as_ref().map_or(options.elbow.unwrap_or_default(), |q| arm.elbow(q));
    let accuracy = options.accuracy.unwrap_or_else(|| ACCURACY * course.extent());
    require_positive("accuracy", accuracy)?;
    refuse_repetition(course.points())?;
    let redundancy = Redundancy::new(arm, course.points(), elbow)?;
    let mut cost = PathCost::new(robot, &limits, redundancy, options.objective, accuracy, options.start.as_deref());
    let search = Search { solver: options.solver.as_ref(), stop: options.stop, seed: options.seed };
    let bounds = cost.bounds()?;
    let found = search.run(&mut cost, &bounds, monitor)?;
    let trajectory = cost.trajectory(&found.x).unwrap_or_else(|| Err(no_configuration("some point of the path")))?;
    let mut violations = limits.violations(&trajectory);
    let farthest = cost.stray(course);
    violations.extend(farthest.violations(course, accuracy));
    Ok(Plan {
        objective: options.objective,
        cost: options.objective.of(robot, &trajectory),
        clearance: None,
        accuracy: Some(farthest.distance.value),
        redundancy: cost.orientations(&found.x),
        status: found.status(violations.is_empty()),
        violations,
        history: found.history,
        evaluations: found.evaluations,
        elapsed: stopwatch.elapsed(),
        trajectory,
    })
}

/// Allowed distance from the path, as a share of the path's extent: what the published
/// planner needs for a pentagram with every second of 50 points.
const ACCURACY: f64 = 0.04;

fn require_path_cost(options: &AlongPathOptions) -> Result<()> {
    match options.objective {
        Cost::TipTravel => {
            Err(Error::unknown_option("objective along a path", "tip_travel", &["time", "joint_travel"]))
        }
        Cost::Time | Cost::JointTravel => Ok(()),
    }
}

fn not_planar(robot: &Robot) -> Error {
    let problem = format!("{METHOD} plans along paths for planar arms alone: use method=\"timed\"");
    Error::InvalidRobot { robot: robot.name().into(), problem }
}
