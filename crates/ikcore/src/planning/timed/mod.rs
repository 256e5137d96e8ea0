//! Along a path as fast as the limits allow: the arm's redundancy and the timing found together.
//!
//! The search outside chooses the posture in which the arm passes each point of the path, a few numbers a motion; the
//! fastest timing of the joint path that follows is exact and costs little. So what is searched is small, and what is
//! found keeps every limit.
//!
//! | file | what |
//! |---|---|
//! | `self_motion` | configurations at the path's points, and what may be chosen of them |
//! | `cost` | the duration as a function of the choice |

mod cost;
mod self_motion;

use super::time_optimal::time;
use super::tpbso::extent;
use super::tpbso::search::{Found, Search};
use super::{AlongPathOptions, Cost, MotionLimits, Plan, TimingLimits, TimingOptions, Violation};
use crate::error::{Error, Result, require_positive};
use crate::limits::Limits;
use crate::path::Reference;
use crate::robot::Robot;
use crate::solver::stop::Stopwatch;
use crate::solver::{AnySolver, DerivativeFree, DifferentialEvolution, Monitor, Schedule, Status, Stop};
use crate::wording::number;
use cost::TimedCost;
use self_motion::SelfMotion;

const METHOD: &str = "method=\"timed\"";

/// Evaluations of the search: after so many the duration falls by less than a hundredth.
const EVALUATIONS: usize = 2000;

/// Members of a generation of the search.
const POPULATION: usize = 30;

/// The splines pass every second point of the path; where those in between are not met well enough, every point.
const SPARSE: usize = 2;

/// Allowed distance of the tip from the points between, as a share of the path's extent.
const ACCURACY: f64 = 0.04;

/// Plans along a path.
///
/// # Errors
/// As [`plan_along_path`](super::plan_along_path).
pub(super) fn along_path(
    robot: &Robot,
    path: &Reference,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    if options.objective == Cost::TipTravel {
        let known = ["time", "joint_travel"];
        return Err(Error::unknown_option("objective along a path", "tip_travel", &known));
    }
    let limits = MotionLimits::new(robot, options.limits.as_ref(), METHOD)?;
    let timing_limits = timing_limits_of(robot, options.limits.as_ref())?;
    if let Some(q) = &options.start {
        robot.check("start_q", q)?;
        limits.require_inside("start_q", q)?;
    }
    let accuracy = options.accuracy.unwrap_or_else(|| ACCURACY * extent(path));
    require_positive("accuracy", accuracy)?;
    if let Some(q) = &options.start {
        require_on_path(robot, q, path, accuracy)?;
    }
    let bounded = limits.applied_to(robot)?;
    let plan_with = |stride: usize, monitor: &mut dyn Monitor| {
        let motion = SelfMotion::new(&bounded, path, stride, options.start.as_deref(), options.seed)?;
        let cost = TimedCost {
            motion,
            limits: &limits,
            timing_limits: &timing_limits,
            objective: options.objective,
            accuracy,
            path,
            stride,
            scale: options.objective.scale(robot, &limits),
        };
        plan(robot, cost, options, stopwatch, monitor)
    };
    let sparse = plan_with(SPARSE, monitor)?;
    if sparse.violations.is_empty() || sparse.status == Status::Interrupted {
        return Ok(sparse);
    }
    let dense = plan_with(1, monitor)?;
    Ok(if dense.violations.len() < sparse.violations.len() { dense } else { sparse })
}

/// Searches the postures, and times the best.
fn plan(
    robot: &Robot,
    mut cost: TimedCost<'_>,
    options: &AlongPathOptions,
    stopwatch: Stopwatch,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let found = search(&mut cost, options, monitor)?;
    let z: &[f64] = found.as_ref().map_or(&[], |found| &found.x);
    let (joint_path, _) = cost.joint_path(z)?;
    let trajectory = time(&joint_path, cost.timing_limits, &TimingOptions::default())?;
    let mut violations = cost.limits.violations(&trajectory);
    violations.extend(cost.distances(&joint_path).filter(|(_, distance)| *distance > cost.accuracy).map(
        |(row, distance)| Violation {
            what: format!("distance of the tip from point {row} of the path"),
            value: distance,
            bound: cost.accuracy,
            unit: "m".into(),
        },
    ));
    let keeps_everything = violations.is_empty();
    Ok(Plan {
        objective: options.objective,
        cost: options.objective.of(robot, &trajectory),
        clearance: None,
        accuracy: Some(cost.distances(&joint_path).map(|(_, distance)| distance).fold(0.0, f64::max)),
        redundancy: vec![],
        violations,
        status: match &found {
            Some(found) => found.status(keeps_everything),
            None if keeps_everything => Status::Solved,
            None => Status::Stalled,
        },
        evaluations: found.as_ref().map_or(1, |found| found.evaluations),
        history: found.map_or_else(Vec::new, |found| found.history),
        elapsed: stopwatch.elapsed(),
        trajectory,
    })
}

/// The search; None for an arm without a choice.
fn search(cost: &mut TimedCost<'_>, options: &AlongPathOptions, monitor: &mut dyn Monitor) -> Result<Option<Found>> {
    let Some(bounds) = cost.bounds() else { return Ok(None) };
    let schedule = Schedule::of(POPULATION);
    let standard: AnySolver<DerivativeFree> =
        AnySolver::Single(DifferentialEvolution { schedule, ..DifferentialEvolution::default() }.into());
    let search = Search {
        solver: Some(options.solver.as_ref().unwrap_or(&standard)),
        stop: Some(options.stop.unwrap_or(Stop { max_evaluations: EVALUATIONS, ..Stop::default() })),
        seed: options.seed,
    };
    search.run(cost, &bounds, monitor).map(Some)
}

/// Err unless `q` has the tip at the first point of the path, as near as any point must be met.
fn require_on_path(robot: &Robot, q: &[f64], path: &Reference, accuracy: f64) -> Result<()> {
    let (tip, wanted) = (robot.tip_position(q), path.position(0));
    let distance = (0..3).map(|i| (tip[i] - wanted[i]).powi(2)).sum::<f64>().sqrt();
    if distance <= accuracy {
        return Ok(());
    }
    let (distance, accuracy) = (number(distance), number(accuracy));
    let problem = format!("start_q has the tip {distance} m from the path's first point, allowed {accuracy} m");
    Err(Error::Infeasible { problem })
}

fn timing_limits_of(robot: &Robot, limits: Option<&Limits>) -> Result<TimingLimits> {
    TimingLimits::new(&limits.cloned().unwrap_or_else(|| Limits::of(robot)), METHOD)
}
