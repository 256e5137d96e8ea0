//! All curves of configurations that keep the tip at a target: `self_motion`.

use super::curve::SelfMotion;
use super::cut::parts;
use super::seeds::{Seeds, by_closed_form};
use super::trace::{TracedCurve, traced};
use super::unwrapping::{EXACT, unwrapped};
use super::wrapped_limits::WrappedLimits;
use crate::error::{Error, Result};
use crate::ik::attempt::Attempt;
use crate::ik::context::SolveContext;
use crate::ik::solve_options::SolveOptions;
use crate::limits::Limits;
use crate::math::vector::distance;
use crate::objective::{Bounds, Point};
use crate::rng;
use crate::robot::Robot;
use crate::solver::{LevenbergMarquardt, Monitor, Status};
use crate::task::Target;

/// Number of parameter values of a closed form that are searched for curves.
const VALUES: usize = 64;

/// Distance from a curve (rad, m) within which a configuration is on it.
const ON_CURVE: f64 = 0.01;

/// Consecutive solutions on known curves after which the search ends.
const PATIENCE: usize = 40;

/// Smallest and largest spacing of points (rad, m).
const SPACINGS: [f64; 2] = [1e-3, 0.5];

/// Points brought to the target between two polls of the monitor.
const POINTS_BETWEEN_LOOKS: usize = 64;

/// Options of [`self_motion`].
#[derive(Debug, Clone)]
pub struct SelfMotionOptions {
    /// Reference (n,): curves are sorted by their distance from it. `None` means by length, the longest first.
    pub start: Option<Vec<f64>>,
    /// Largest distance |q - q'| of consecutive points (rad, m).
    pub spacing: f64,
    /// Position limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// Seed of the random draws of a search.
    pub seed: u64,
}

impl Default for SelfMotionOptions {
    fn default() -> Self {
        Self { start: None, spacing: 0.05, limits: None, seed: 0 }
    }
}

/// Returns all self-motion curves of an arm with one joint more than the task needs: seven joints and a pose, four and a
/// position.
///
/// The closed form, at 64 values of its parameter, or a search from random starts finds a point of each curve; the curve is
/// then traced in short steps, past the joint limits, which cut it afterwards.
///
/// # Errors
/// Any [`enum@Error`] for wrong input; [`Error::Contradiction`] for an arm without one joint more than the task needs.
pub fn self_motion(
    robot: &Robot,
    target: &Target,
    options: &SelfMotionOptions,
    monitor: &mut dyn Monitor,
) -> Result<Vec<SelfMotion>> {
    robot.require_one_tip("self_motion")?;
    let SelfMotionOptions { start, spacing, limits, seed } = options;
    let [least, most] = SPACINGS;
    if !(least..=most).contains(spacing) {
        return Err(Error::out_of_range("spacing", format!("from {least} to {most}"), *spacing));
    }
    let each = SolveOptions { limits: limits.clone(), seed: *seed, ..SolveOptions::default() };
    let context = SolveContext::new(robot, &each)?;
    let targets = context.read(std::slice::from_ref(target))?;
    require_curves(robot, &targets[0])?;
    start.as_ref().map_or(Ok(()), |q| robot.check("start_q", q))?;
    let mut problem = context.problem(&targets);
    let mut rng = rng::stream(*seed, 0);
    let mut attempt = Attempt::new(&context, &mut problem, &mut rng, monitor);
    let limits = WrappedLimits::new(robot, context.bounds());
    let limits = match start {
        Some(start) => limits.around(start),
        None => limits,
    };
    let (mut curves, complete) = match by_closed_form(robot, &mut attempt, VALUES) {
        Some(Seeds { seeds, complete }) => (through(&seeds, &mut attempt, &limits, *spacing), complete),
        None => (searched(&mut attempt, &limits, *spacing), false),
    };
    let mut found = Vec::new();
    for curve in &mut curves {
        make_exact(curve, &mut attempt);
        for part in parts(curve, &limits) {
            found.extend(unwrapped(part, *spacing, &mut attempt, &limits, start.as_deref()));
        }
    }
    found.iter_mut().for_each(|curve| curve.complete = complete);
    sort(&mut found, start.as_deref());
    Ok(found)
}

fn require_curves(robot: &Robot, target: &Target) -> Result<()> {
    let rank = robot.task_rank();
    let needed = match target {
        Target::Position(_) => rank.position,
        _ => rank.pose,
    };
    if robot.dof() == needed + 1 {
        return Ok(());
    }
    Err(Error::Contradiction {
        problem: format!(
            "self_motion needs one joint more than the target: robot '{}' has {} joints, and this target takes {needed}",
            robot.name(),
            robot.dof()
        ).into(),
    })
}

/// Traces the curves through these configurations.
fn through(
    seeds: &[Point],
    attempt: &mut Attempt<'_, '_>,
    limits: &WrappedLimits<'_>,
    spacing: f64,
) -> Vec<TracedCurve> {
    let mut curves: Vec<TracedCurve> = Vec::new();
    for seed in seeds {
        if !attempt.monitor.keep_going() {
            break;
        }
        if !curves.iter().any(|curve| curve.passes(limits, seed, ON_CURVE, spacing))
            && let Some(curve) = traced(attempt.problem, limits, seed, spacing, attempt.monitor)
        {
            attempt.budget.evaluations += curve.evaluations;
            curves.push(curve);
        }
    }
    curves
}

/// Traces the curves through solutions from random starts, until [`PATIENCE`] consecutive solutions are on known curves.
fn searched(attempt: &mut Attempt<'_, '_>, limits: &WrappedLimits<'_>, spacing: f64) -> Vec<TracedCurve> {
    let mut curves: Vec<TracedCurve> = Vec::new();
    let mut x0 = attempt.first_start(None);
    let mut known = 0;
    while known < PATIENCE && !attempt.budget.is_spent() && attempt.monitor.keep_going() {
        let solution = attempt.solve_from(&x0);
        if solution.status != Status::Solved {
            break;
        }
        let is_known = curves.iter().any(|curve| curve.passes(limits, &solution.q, ON_CURVE, spacing));
        known = if is_known { known + 1 } else { 0 };
        if !is_known {
            match traced(attempt.problem, limits, &solution.q, spacing, attempt.monitor) {
                Some(curve) => curves.push(curve),
                None => known += 1,
            }
        }
        attempt.next_start(&mut x0);
    }
    curves
}

/// Projects the points of a curve onto the target.
fn make_exact(curve: &mut TracedCurve, attempt: &mut Attempt<'_, '_>) {
    let descent = LevenbergMarquardt::default();
    let anywhere = Bounds::from_ranges(
        curve.points.first().map_or(0..0, |point| 0..point.q.len()).map(|_| (f64::NEG_INFINITY, f64::INFINITY)),
    );
    for (k, point) in curve.points.iter_mut().enumerate() {
        if k % POINTS_BETWEEN_LOOKS == 0 && !attempt.monitor.keep_going() {
            break;
        }
        point.q = attempt.descend_beyond(&descent, point.q.clone(), EXACT, &anywhere);
    }
}

/// Sorts by the distance from `start`, or by length.
fn sort(curves: &mut [SelfMotion], start: Option<&[f64]>) {
    match start {
        Some(start) => {
            let nearest = |curve: &SelfMotion| curve.iter().map(|q| distance(q, start)).fold(f64::INFINITY, f64::min);
            curves.sort_by(|a, b| nearest(a).total_cmp(&nearest(b)));
        }
        None => curves.sort_by(|a, b| b.length().total_cmp(&a.length())),
    }
}
