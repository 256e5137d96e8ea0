//! Along a path as fast as the limits allow: the arm's redundancy and the timing found together.
//!
//! The search outside chooses the posture in which the arm passes each point of the path, a few numbers a motion; the
//! fastest timing of the joint path that follows is exact and costs little. So what is searched is small, and what is
//! found keeps every limit.
//!
//! | file | what |
//! |---|---|
//! | `self_motion` | configurations along the path, and what may be chosen of them |
//! | `null_space` | what moves the joints and leaves the tip |
//! | `project` | the nearest configuration that reaches a target |
//! | `passage` | splines through configurations, fine enough to keep to the path |
//! | `cost` | the duration as a function of the choice |

mod cost;
mod null_space;
mod passage;
mod project;
mod self_motion;

use super::course::Course;
use super::stray::Stray;
use super::time_optimal::{coarse_duration, time};
use super::tpbso::search::{Found, Search};
use super::{AlongPathOptions, Cost, MotionLimits, Plan, TimingLimits, TimingOptions};
use crate::error::{Error, Result, require_positive};
use crate::limits::Limits;
use crate::robot::Robot;
use crate::solver::stop::Stopwatch;
use crate::solver::{AnySolver, DerivativeFree, DifferentialEvolution, Monitor, Schedule, Status, Stop};
use crate::wording::number;
use cost::TimedCost;
use passage::{Corners, Interpolation, Passage};
use self_motion::SelfMotion;

const METHOD: &str = "method=\"timed\"";

/// Evaluations of the search: after so many the duration falls by less than a hundredth.
const EVALUATIONS: usize = 2000;

/// Members of a generation of the search.
const POPULATION: usize = 30;

/// Allowed distance of the tip from the path, as a share of its extent.
const ACCURACY: f64 = 1e-3;

/// Segments of the timing in each piece of the spline when ways to take corners are compared.
const SEGMENTS_A_PIECE: usize = 4;

/// Plans along a path.
///
/// # Errors
/// As [`plan_along_path`](super::plan_along_path).
pub(super) fn along_path(
    robot: &Robot,
    course: &Course,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    require_supported(options)?;
    let limits = MotionLimits::new(robot, options.limits.as_ref(), METHOD)?;
    let timing_limits = timing_limits_of(robot, options.limits.as_ref())?;
    // Points that stand for a curve do not say more of it than this.
    let accuracy = options.accuracy.unwrap_or_else(|| ACCURACY * course.extent() + course.coarseness());
    require_positive("accuracy", accuracy)?;
    if let Some(q) = &options.start {
        robot.check("start_q", q)?;
        limits.require_inside("start_q", q)?;
        require_on_path(robot, q, course, accuracy)?;
    }
    let robot = limits.applied_to(robot)?;
    let mut motion = SelfMotion::new(&robot, course, options.start.as_deref(), options.seed)?;
    let interpolation = settle(&mut motion, &robot, course, accuracy, &timing_limits)?;
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

/// Decides how corners are taken, by what is quicker on the nominal motion, and gives that the knots it needs.
fn settle<'a>(
    motion: &mut SelfMotion<'_>,
    robot: &'a Robot,
    course: &'a Course,
    accuracy: f64,
    limits: &TimingLimits,
) -> Result<Interpolation<'a>> {
    let mut quickest: Option<(f64, Interpolation, Passage)> = None;
    for corners in Corners::on(course) {
        let interpolation = Interpolation { robot, course, corners: *corners };
        let passage = interpolation.refined(motion.nominal().clone(), accuracy)?;
        let path = interpolation.path(&passage)?;
        let duration = coarse_duration(&path, limits, SEGMENTS_A_PIECE * path.pieces())?;
        if quickest.as_ref().is_none_or(|(least, ..)| duration < *least) {
            quickest = Some((duration, interpolation, passage));
        }
    }
    let stopping = || (Interpolation { robot, course, corners: Corners::Stopped }, motion.nominal().clone());
    let (interpolation, passage) =
        quickest.map_or_else(stopping, |(_, interpolation, passage)| (interpolation, passage));
    motion.take(passage);
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
    let (passage, _) = cost.passage(z);
    let passage = cost.interpolation.refined(passage, cost.accuracy)?;
    let path = cost.interpolation.path(&passage)?;
    let trajectory = time(&path, cost.timing_limits, &TimingOptions::default())?;
    let Interpolation { robot, course, .. } = cost.interpolation;
    let configurations = |share: f64, q: &mut [f64]| path.position(share, q);
    let farthest = Stray { robot, course, configurations }.farthest(&passage.knots);
    let mut violations = cost.limits.violations(&trajectory);
    violations.extend(farthest.violations(course, cost.accuracy));
    let keeps_everything = violations.is_empty();
    Ok(Plan {
        objective: options.objective,
        cost: options.objective.of(robot, &trajectory),
        clearance: None,
        accuracy: Some(farthest.distance.value),
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

/// Err for what only the other planner, or none, can do.
fn require_supported(options: &AlongPathOptions) -> Result<()> {
    if options.objective == Cost::TipTravel {
        let known = ["time", "joint_travel"];
        return Err(Error::unknown_option("objective along a path", "tip_travel", &known));
    }
    match options.elbow {
        None => Ok(()),
        Some(_) => Err(Error::Contradiction {
            problem: format!(
                "{METHOD} chooses how the arm bends: give start_q instead of elbow, or use method=\"tpbso\""
            ),
        }),
    }
}

/// Err unless `q` has the tip at the beginning of the course, as near as it must be all along.
fn require_on_path(robot: &Robot, q: &[f64], course: &Course, accuracy: f64) -> Result<()> {
    let distance = course.distance(robot.tip_position(q), 0.0, 0.0);
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
