//! The planner that searches the ends' configurations first: those that lie nearest to each other in time, joined by a
//! straight line in joint space, or by a way around obstacles.
//!
//! | file | what |
//! |---|---|
//! | [`ends`] | pairs of configurations for start and end |
//! | [`branches`] | the same from all solutions of inverse kinematics |
//! | [`nearer`] | smallest largest displacement, along what the targets leave free |
//! | [`pace`] | the quickest smooth timing of straight lines |
//! | [`around`] | a way around obstacles, its timing certified |
//! | [`connect`] | two trees that grow towards each other, and shortcuts |
//! | [`clear`] | a trajectory as a motion that can be certified |
//! | [`travel`] | what a motion costs |

mod around;
mod branches;
mod clear;
mod connect;
mod ends;
mod nearer;
mod pace;
mod travel;

pub(super) use self::around::{refuse_collision, too_near};
pub(super) use self::clear::InTime;
use self::ends::{Pair, Search};
use self::pace::Polyline;
use super::{Cost, End, Improvement, MotionLimits, Plan, PointToPointOptions};
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
    start: &End,
    end: &End,
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
    let mut search = Search::new(robot, &limits, [start, end], options.seed)?;
    let shape_known = !robot.capsules().is_empty() && robot.unread_collision_shapes().is_empty();
    let mut plan = if options.obstacles.is_empty() && !shape_known {
        freely(&mut search, options.objective, monitor)?
    } else {
        around::plan(&mut search, options, monitor)?
    };
    plan.elapsed = stopwatch.elapsed();
    Ok(plan)
}

/// Without anything to touch: straight from end to end.
fn freely(search: &mut Search, objective: Cost, monitor: &mut dyn Monitor) -> Result<Plan> {
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
        elapsed: NO_TIME,
    })
}

/// Until the stopwatch is read.
const NO_TIME: std::time::Duration = std::time::Duration::ZERO;

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

/// Err for a joint without a velocity and an acceleration limit: nothing would set its pace.
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
