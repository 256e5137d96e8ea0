//! The planner: corners, the search for postures, the timing of the best.

use super::interpolation::{Corners, Interpolation, JointWaypoints};
use super::redundant_motion::RedundantMotion;
use super::timed_cost::TimedCost;
use crate::error::{Error, Result, require_positive};
use crate::limits::Limits;
use crate::planning::deviation::TipDeviation;
use crate::planning::search::{Search, SearchResult};
use crate::planning::time_optimal::{coarse_duration, time_all};
use crate::planning::tip_path::TipPath;
use crate::planning::{AlongPathOptions, MotionLimits, Plan, TimingLimits};
use crate::robot::Robot;
use crate::solver::Stopwatch;
use crate::solver::{AnySolver, DifferentialEvolution, Monitor, Schedule, Status, Stop};
use crate::wording::number;

const METHOD: &str = "method=\"timed\"";

/// Evaluations of the search; more shorten the motion by less than 1 %.
const EVALUATIONS: usize = 2000;

/// Population size of the search.
const POPULATION: usize = 30;

/// Allowed distance of the tip from the path, relative to the extent of the path.
const ACCURACY: f64 = 1e-3;

/// Segments of the timing per piece of the spline when the alternatives at corners are compared.
const SEGMENTS_A_PIECE: usize = 4;

/// Plans along a path.
///
/// # Errors
/// As [`plan_along_path`](crate::planning::plan_along_path).
pub(crate) fn along_path(
    robot: &Robot,
    tip_path: &TipPath,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = MotionLimits::new(robot, options.limits.as_ref(), METHOD)?;
    let timing_limits = timing_limits_of(robot, options.limits.as_ref())?;
    // The accuracy of a sampled curve is limited by the distance of its points.
    let accuracy = options.accuracy.unwrap_or_else(|| ACCURACY * tip_path.extent() + tip_path.coarseness());
    require_positive("accuracy", accuracy)?;
    if let Some(q) = options.start_within(robot, &limits)? {
        require_on_path(robot, q, tip_path, accuracy)?;
    }
    let robot = limits.applied_to(robot)?;
    let mut motion = RedundantMotion::new(&robot, tip_path, options.start.as_deref(), options.seed)?;
    let interpolation = choose_corners(&mut motion, &robot, tip_path, accuracy, &timing_limits)?;
    let cost = TimedCost {
        motion,
        interpolation,
        limits: &limits,
        timing_limits: &timing_limits,
        objective: options.objective,
        accuracy,
        scale: options.objective.scale(&robot, &limits),
    };
    plan(cost, options, stopwatch, monitor)
}

/// Decides whether the arm stops at corners, depending on which nominal motion is faster, and adds the knots that
/// motion needs.
fn choose_corners<'a>(
    motion: &mut RedundantMotion<'_>,
    robot: &'a Robot,
    tip_path: &'a TipPath,
    accuracy: f64,
    limits: &TimingLimits,
) -> Result<Interpolation<'a>> {
    let mut quickest: Option<(f64, Interpolation, JointWaypoints)> = None;
    for corners in Corners::on(tip_path) {
        let interpolation = Interpolation { robot, tip_path, corners: *corners };
        let waypoints = interpolation.refined(motion.nominal().clone(), accuracy)?;
        let path = interpolation.path(&waypoints)?;
        let duration = coarse_duration(&path, limits, SEGMENTS_A_PIECE * path.pieces())?;
        if quickest.as_ref().is_none_or(|(least, ..)| duration < *least) {
            quickest = Some((duration, interpolation, waypoints));
        }
    }
    let stopping = || (Interpolation { robot, tip_path, corners: Corners::Stopped }, motion.nominal().clone());
    let (interpolation, waypoints) =
        quickest.map_or_else(stopping, |(_, interpolation, waypoints)| (interpolation, waypoints));
    motion.take(waypoints);
    Ok(interpolation)
}

/// Searches the postures, and times the best.
fn plan(
    mut cost: TimedCost<'_>,
    options: &AlongPathOptions,
    stopwatch: Stopwatch,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let found = search(&mut cost, options, monitor)?;
    let z: &[f64] = found.as_ref().map_or(&[], |found| &found.x);
    let (waypoints, _) = cost.waypoints(z);
    let waypoints = cost.interpolation.refined(waypoints, cost.accuracy)?;
    let stretches = cost.interpolation.stretches(&waypoints)?;
    let path = cost.interpolation.path(&waypoints)?;
    let trajectory = time_all(&stretches, cost.timing_limits)?;
    let Interpolation { robot, tip_path, .. } = cost.interpolation;
    let configurations = |share: f64, q: &mut [f64]| path.position(share, q);
    let deviation = TipDeviation { robot, tip_path, configurations }.largest(&waypoints.knots);
    let mut violations = cost.limits.violations(&trajectory);
    violations.extend(deviation.violations(tip_path, cost.accuracy));
    let keeps_everything = violations.is_empty();
    Ok(Plan {
        objective: options.objective,
        cost: options.objective.of(robot, &trajectory),
        clearance: None,
        accuracy: Some(deviation.distance.value),
        reference: Some(tip_path.positions().to_vec()),
        redundancy: vec![],
        path: stretches,
        peak: None,
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

/// Runs the search; `None` if the arm is not redundant.
fn search(
    cost: &mut TimedCost<'_>,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Option<SearchResult>> {
    let Some(bounds) = cost.bounds() else {
        return match &options.solver {
            None => Ok(None),
            Some(_) => Err(Error::Contradiction {
                problem: "solver searches the redundancy of the arm, but on this path it has none: leave solver out"
                    .into(),
            }),
        };
    };
    let schedule = Schedule::of(POPULATION);
    let evolution = || AnySolver::Single(DifferentialEvolution { schedule, ..DifferentialEvolution::default() }.into());
    let search = Search {
        solver: options.solver.clone().unwrap_or_else(evolution),
        stop: options.stop.unwrap_or(Stop { max_evaluations: EVALUATIONS, ..Stop::default() }),
        seed: options.seed,
    };
    search.run(cost, &bounds, monitor).map(Some)
}

/// Checks that at `q` the tip is at the start of the path, within `accuracy`.
fn require_on_path(robot: &Robot, q: &[f64], tip_path: &TipPath, accuracy: f64) -> Result<()> {
    let distance = tip_path.distance(robot.tip_position(q), 0.0, 0.0);
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
