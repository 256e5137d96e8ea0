//! The planner that searches the ends' configurations first: those that lie nearest to each other in time, joined by a
//! straight line in joint space, or by a path around obstacles.
//!
//! | file | what |
//! |---|---|
//! | [`ends`] | pairs of configurations for start and end |
//! | [`branches`] | the same from all solutions of inverse kinematics |
//! | [`displacement`] | both moved along their self-motion, to the smallest largest displacement |
//! | [`line_timing`] | the quickest smooth timing of straight lines |
//! | [`among_obstacles`] | a path around obstacles, its timing certified |
//! | [`rrt_connect`] | two trees that grow towards each other, and shortcuts |

mod among_obstacles;
mod branches;
mod displacement;
mod ends;
mod line_timing;
mod rrt_connect;

use self::ends::{Pair, Search};
use self::line_timing::Polyline;
use super::collision::can_collide;
use super::{Cost, Endpoint, Improvement, MotionLimits, Plan, PointToPointOptions};
use crate::error::{Error, Result};
use crate::robot::Robot;
use crate::solver::stop::Stopwatch;
use crate::solver::{Monitor, Status};
use crate::trajectory::Trajectory;

/// Pairs of configurations that are tried from random starts, and as many of the quickest branches.
const PAIRS: usize = 8;

/// Plans from `start` to `end`; see [`plan_point_to_point`](super::plan_point_to_point).
pub(super) fn point_to_point(
    robot: &Robot,
    start: &Endpoint,
    end: &Endpoint,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = MotionLimits::new(robot, options.limits.as_ref(), "plan_point_to_point with method='minmax'")?;
    require_pace(robot, &limits)?;
    if options.solver.is_some() {
        let problem = "method=\"minmax\" has a search of its own: leave solver out, or use method=\"tpbso\"";
        return Err(Error::Contradiction { problem: problem.into() });
    }
    if options.elbows.is_some() {
        let problem = "method=\"minmax\" chooses how the arm bends: leave elbows out, or use method=\"tpbso\"";
        return Err(Error::Contradiction { problem: problem.into() });
    }
    let mut search = Search::new(robot, &limits, [start, end], options.seed, stopwatch)?;
    if can_collide(robot, &options.obstacles) {
        among_obstacles::plan(&mut search, options, monitor)
    } else {
        without_obstacles(&mut search, options.objective, monitor)
    }
}

/// Straight from end to end.
fn without_obstacles(search: &mut Search, objective: Cost, monitor: &mut dyn Monitor) -> Result<Plan> {
    let pairs = search.pairs(PAIRS, monitor)?;
    let mut best: Option<(f64, Trajectory)> = None;
    let mut history = vec![];
    for pair in &pairs {
        let trajectory = straight(pair, search.limits)?;
        let cost = objective.of(search.robot, &trajectory);
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            history.push(Improvement { evaluations: search.evaluations, cost });
            best = Some((cost, trajectory));
        }
    }
    let (cost, trajectory) = best.ok_or_else(no_pair)?;
    let violations = search.limits.violations(&trajectory);
    let status = if violations.is_empty() { Status::Solved } else { Status::Stalled };
    let evaluations = search.evaluations;
    Ok(Plan {
        trajectory,
        objective,
        cost,
        history,
        clearance: None,
        accuracy: None,
        redundancy: vec![],
        violations,
        status,
        evaluations,
        elapsed: search.stopwatch.elapsed(),
    })
}

/// The quicker of a quintic and of constant velocity between blends.
fn straight(pair: &Pair, limits: &MotionLimits) -> Result<Trajectory> {
    pair.require_motion()?;
    let line = Polyline(vec![pair.start.to_vec(), pair.end.to_vec()]);
    let quintic = line.with_stops(limits)?;
    match line.with_blends(limits, &[1.0, 1.0]).transpose()? {
        Some(blended) if blended.duration() < quintic.duration() => Ok(blended),
        _ => Ok(quintic),
    }
}

/// Err for a joint with neither a velocity nor an acceleration limit, which would take no time.
fn require_pace(robot: &Robot, limits: &MotionLimits) -> Result<()> {
    let unlimited = |j: &usize| limits.velocity[*j].is_infinite() && limits.acceleration[*j].is_infinite();
    match (0..robot.dof()).find(unlimited) {
        None => Ok(()),
        Some(j) => Err(Error::NoPace { joint: limits.joint_name(j).into() }),
    }
}

fn no_pair() -> Error {
    Error::Unreachable { what: "end".into(), problem: "no configuration was found: try another seed".into() }
}
