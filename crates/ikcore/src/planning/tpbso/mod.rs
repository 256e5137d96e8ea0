//! Trajectory planning by beetle swarm optimisation (TPBSO): Wang et al. (2019), "A New Trajectory-Planning Beetle Swarm
//! Optimization Algorithm for Trajectory Planning of Robot Manipulators".
//!
//! | file | paper |
//! |---|---|
//! | [`rest_segment`] | the segments of eq. (3)-(6), their extremes in closed form |
//! | [`end_configurations`] | the redundancy at the ends; any robot by inverse kinematics |
//! | [`via_point`] | the decision vector and cost from end to end, eq. (8)-(18) |
//! | [`collision_test`] | obstacles, eq. (14) and (18) |
//! | [`redundancy`] | the free orientations along a path, eq. (7) |
//! | [`path_cost`] | the decision vector and cost along a path, eq. (19)-(25) |
//! | [`penalties`] | the weights of eq. (15) and (25) |

mod collision_test;
mod end_configurations;
mod path_cost;
mod penalties;
mod redundancy;
mod rest_segment;
mod via_point;

use super::collision::{as_lines, can_collide};
use super::planar_arm::{Elbow, PlanarArm};
use super::search::Search;
use super::tip_path::{TipPath, refuse_repetition};
use super::{AlongPathOptions, Endpoint, MotionLimits, Plan, PointToPointOptions};
use crate::error::{Error, Result, require_positive};
use crate::robot::Robot;
use crate::solver::stop::Stopwatch;
use crate::solver::{AnySolver, BeetleSwarm, DerivativeFree, Monitor, Schedule, Stop};
use collision_test::CollisionTest;
use end_configurations::EndConfigurations;
use path_cost::PathCost;
use redundancy::Redundancy;
use via_point::ViaPointCost;

/// Plans from end to end.
pub(super) fn point_to_point(
    robot: &Robot,
    start: &Endpoint,
    end: &Endpoint,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = MotionLimits::new(robot, options.limits.as_ref(), METHOD)?;
    limits.require_velocities(METHOD)?;
    let can_collide = can_collide(robot, &options.obstacles);
    let lines = if can_collide { as_lines(robot)? } else { None };
    let collisions = can_collide.then(|| CollisionTest::new(robot, lines.as_ref(), options)).transpose()?;
    let mut configurations = |what: &str, end: &Endpoint, elbow: Elbow| {
        if let (Endpoint::Configuration(q), Some(collisions)) = (end, &collisions) {
            collisions.refuse_collision(what, q)?;
        }
        EndConfigurations::new(what, end, robot, &limits, elbow, options.seed, monitor)
    };
    let [start_elbow, end_elbow] = options.elbows.unwrap_or_default();
    let (start, end) = (configurations("start", start, start_elbow)?, configurations("end", end, end_elbow)?);
    let mut cost = ViaPointCost::new(robot, &limits, [start, end], options.objective, collisions.as_ref());
    let published = published_swarm();
    let search = Search {
        solver: options.solver.as_ref().unwrap_or(&published),
        stop: options.stop.unwrap_or_else(published_budget),
        seed: options.seed,
    };
    let bounds = cost.bounds();
    let found = search.run(&mut cost, &bounds, monitor)?;
    let trajectory = cost.trajectory(&found.x).unwrap_or_else(|| Err(no_configuration("start or end")))?;
    let mut violations = limits.violations(&trajectory);
    let nearest = collisions.and_then(|collisions| collisions.clearance(&trajectory));
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

/// The beetle swarm, for as long as its budget lasts: the published one does not stop when it stalls.
fn published_swarm() -> AnySolver<DerivativeFree> {
    let swarm = BeetleSwarm::default();
    let schedule = Schedule { stall_generations: usize::MAX, ..swarm.schedule };
    AnySolver::Single(BeetleSwarm { schedule, ..swarm }.into())
}

/// 50 beetles that evaluate both antennae and their new place, 200 times, and where they start.
fn published_budget() -> Stop {
    Stop { max_evaluations: 50 * (3 * 200 + 1), ..Stop::default() }
}

/// The error of a search that met no vector with a configuration: its budget was of a few vectors, or the free links rarely
/// leave the other two a solution.
fn no_configuration(what: &str) -> Error {
    let problem = "the search met no configuration that reaches it: raise the budget in stop=Stop(...)".into();
    Error::Unreachable { what: what.into(), problem }
}

/// Plans along a path, for planar arms.
pub(super) fn along_path(
    robot: &Robot,
    tip_path: &TipPath,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let arm = PlanarArm::of(robot).ok_or_else(|| not_planar(robot))?;
    let limits = MotionLimits::new(robot, options.limits.as_ref(), METHOD)?;
    limits.require_velocities(METHOD)?;
    if let Some(q) = &options.start {
        robot.check("start_q", q)?;
        robot.require_within("start_q", q, &limits.lower, &limits.upper)?;
    }
    let elbow = options.start.as_ref().map_or(options.elbow.unwrap_or_default(), |q| arm.elbow(q));
    let accuracy = options.accuracy.unwrap_or_else(|| ACCURACY * tip_path.extent());
    require_positive("accuracy", accuracy)?;
    refuse_repetition(tip_path.points())?;
    let redundancy = Redundancy::new(arm, tip_path.points(), elbow)?;
    let mut cost = PathCost::new(robot, &limits, redundancy, options.objective, accuracy, options.start.as_deref());
    let published = published_swarm();
    let search = Search {
        solver: options.solver.as_ref().unwrap_or(&published),
        stop: options.stop.unwrap_or_else(published_budget),
        seed: options.seed,
    };
    let bounds = cost.bounds()?;
    let found = search.run(&mut cost, &bounds, monitor)?;
    let trajectory = cost.trajectory(&found.x).unwrap_or_else(|| Err(no_configuration("some point of the path")))?;
    let mut violations = limits.violations(&trajectory);
    let deviation = cost.deviation(tip_path);
    violations.extend(deviation.violations(tip_path, accuracy));
    Ok(Plan {
        objective: options.objective,
        cost: options.objective.of(robot, &trajectory),
        clearance: None,
        accuracy: Some(deviation.distance.value),
        redundancy: cost.orientations(&found.x),
        status: found.status(violations.is_empty()),
        violations,
        history: found.history,
        evaluations: found.evaluations,
        elapsed: stopwatch.elapsed(),
        trajectory,
    })
}

/// Allowed distance from the path, as a share of the path's extent: what the published planner needs for a pentagram with
/// every second of 50 points.
const ACCURACY: f64 = 0.04;

fn not_planar(robot: &Robot) -> Error {
    let problem = format!("{METHOD} plans along paths for planar arms alone: use method=\"timed\"");
    Error::InvalidRobot { robot: robot.name().into(), problem }
}
