//! `self_motion`: every curve of configurations that keep the tip at a target.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::cut::{Part, parts};
use super::seeds::{Seeds, by_closed_form};
use super::trace::{TracedCurve, traced};
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

/// Every point is at least as near to the target as this (m, rad).
const EXACT: f64 = 1e-9;

/// A configuration nearer to a curve than this (rad, m) is on it.
const ON_CURVE: f64 = 0.01;

/// Solutions in a row on known curves after which the search for others ends.
const PATIENCE: usize = 40;

/// Smallest and largest spacing (rad, m).
const SPACINGS: [f64; 2] = [1e-3, 0.5];

/// How to follow a self-motion.
#[derive(Debug, Clone)]
pub struct SelfMotionOptions {
    /// Curves are sorted by their distance from this configuration (n,). None: by length, the longest first.
    pub start: Option<Vec<f64>>,
    /// Largest distance |q - q'| of consecutive points (rad, m).
    pub spacing: f64,
    /// Position limits to keep. None: the robot's.
    pub limits: Option<Limits>,
    /// Seed of the random draws of a search.
    pub seed: u64,
}

impl Default for SelfMotionOptions {
    fn default() -> Self {
        Self { start: None, spacing: 0.05, limits: None, seed: 0 }
    }
}

/// A curve of configurations, all with the tip at the target and within the limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SelfMotion {
    joints: usize,
    /// The configurations (k, n), row by row.
    values: Vec<f64>,
    /// The last configuration is followed by the first, whole turns of joints without limits aside.
    pub closed: bool,
    /// The joint whose limit ends the curve at its first configuration.
    pub lower_cut: Option<usize>,
    /// The joint whose limit ends the curve at its last configuration.
    pub upper_cut: Option<usize>,
    /// The closed form proves that there is no other curve: each passes every arm angle.
    pub complete: bool,
}

impl SelfMotion {
    /// The configurations (k, n), row by row (rad, m).
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The configurations, in order (rad, m).
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.values.chunks_exact(self.joints)
    }

    /// Its length in joint space (rad, m).
    pub fn length(&self) -> f64 {
        self.iter().zip(self.iter().skip(1)).map(|(a, b)| distance(a, b)).sum()
    }
}

/// All curves of the self-motion of an arm with one joint more than the task needs: seven joints and a pose, four and a position.
///
/// Curves are found by the closed form, at 64 values of its parameter, or by a search from random starts; each is followed in short
/// steps, past the joint limits, which then cut it.
///
/// # Errors
/// Any [`enum@Error`] for wrong input; [`Error::Contradiction`] for an arm without one joint more than the task needs.
pub fn self_motion(
    robot: &Robot,
    target: &Target,
    options: &SelfMotionOptions,
    monitor: &mut dyn Monitor,
) -> Result<Vec<SelfMotion>> {
    let SelfMotionOptions { start, spacing, limits, seed } = options;
    let [least, most] = SPACINGS;
    if !(least..=most).contains(spacing) {
        return Err(Error::out_of_range("spacing", &format!("from {least} to {most}"), *spacing));
    }
    let each = SolveOptions { limits: limits.clone(), seed: *seed, ..SolveOptions::default() };
    let context = SolveContext::new(robot, &each)?;
    let target = context.read(target)?;
    require_curves(robot, &target)?;
    start.as_ref().map_or(Ok(()), |q| robot.check("start", q))?;
    let mut problem = context.problem(&target);
    let mut rng = rng::stream(*seed, 0);
    let mut attempt = Attempt::new(&context, &mut problem, &mut rng, monitor);
    let limits = WrappedLimits::new(robot, context.bounds());
    let (mut curves, complete) = match by_closed_form(robot, &mut attempt) {
        Some(Seeds { seeds, complete }) => (through(&seeds, &mut attempt, &limits, *spacing), complete),
        None => (searched(&mut attempt, &limits, *spacing), false),
    };
    let mut found = Vec::new();
    for curve in &mut curves {
        make_exact(curve, &mut attempt);
        for part in parts(curve, &limits) {
            found.extend(placed(part, &mut attempt, &limits));
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
        ),
    })
}

/// The curves through these configurations.
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

/// The curves through solutions from random starts, until [`PATIENCE`] of them in a row are on known ones.
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

/// Brings the points of a curve to the target.
fn make_exact(curve: &mut TracedCurve, attempt: &mut Attempt<'_, '_>) {
    let descent = LevenbergMarquardt::default();
    let anywhere = Bounds::from_ranges(
        curve.points.first().map_or(0..0, |point| 0..point.q.len()).map(|_| (f64::NEG_INFINITY, f64::INFINITY)),
    );
    for point in &mut curve.points {
        point.q = attempt.descend_beyond(&descent, point.q.clone(), EXACT, &anywhere);
    }
}

/// The curve of a part, at the whole turns that bring it within the limits; two or more where it takes several turns. A point that
/// does not reach the target from within the limits is left out.
fn placed(part: Part, attempt: &mut Attempt<'_, '_>, limits: &WrappedLimits<'_>) -> Vec<SelfMotion> {
    let bounds = attempt.context.bounds();
    let Part { mut points, closed, cut } = part;
    follow(&mut points, limits);
    let Some(winding) = fitted(&mut points, closed, bounds, limits) else {
        // A joint of several turns winds out of its limits.
        let half = points.len() / 2;
        if half < 2 {
            return Vec::new();
        }
        let first = Part { points: points[..=half].to_vec(), closed: false, cut: [cut[0], true] };
        let second = Part { points: points[half..].to_vec(), closed: false, cut: [true, cut[1]] };
        return [first, second].into_iter().flat_map(|part| placed(part, attempt, limits)).collect();
    };
    let descent = LevenbergMarquardt::default();
    let mut values = Vec::with_capacity(points.len() * limits.joints());
    let (mut first, mut last) = (None, None);
    for point in points {
        let mut q = point;
        let before = q.clone();
        bounds.clip(&mut q);
        if q != before {
            q = attempt.descend_beyond(&descent, q, EXACT, bounds);
        }
        let error = attempt.problem.assess(&q).error;
        if error.position.unwrap_or(0.0).max(error.rotation.unwrap_or(0.0)) <= 4.0 * EXACT * EXACT {
            values.extend_from_slice(&q);
            first.get_or_insert_with(|| q.clone());
            last = Some(q);
        }
    }
    let at_limit = |q: &Option<Point>| q.as_ref().and_then(|q| nearest_limit(q, bounds));
    let is_closed = closed && !winding;
    vec![SelfMotion {
        joints: limits.joints(),
        closed: is_closed,
        lower_cut: if cut[0] { at_limit(&first) } else { None },
        upper_cut: if cut[1] { at_limit(&last) } else { None },
        complete: false,
        values,
    }]
    .into_iter()
    .filter(|curve| !curve.values.is_empty())
    .collect()
}

/// Removes jumps by whole turns.
fn follow(points: &mut [Point], limits: &WrappedLimits<'_>) {
    for k in 1..points.len() {
        let way = limits.apart(&points[k], &points[k - 1]);
        for (j, way) in way.iter().enumerate() {
            points[k][j] = points[k - 1][j] + way;
        }
    }
}

/// Shifts the points by whole turns within the limits. Returns whether a joint with limits ends another turn away than it began; None
/// where the points do not fit.
fn fitted(points: &mut [Point], closed: bool, bounds: &Bounds, limits: &WrappedLimits<'_>) -> Option<bool> {
    const ROUNDING: f64 = 1e-6;
    let joints = limits.joints();
    let mut winding = false;
    for j in 0..joints {
        let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
        let range =
            points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(q[j]), high.max(q[j])]);
        let shift = limits.near_middle(j, points[0][j]) - points[0][j];
        let fits = |shift: f64| lower - ROUNDING <= range[0] + shift && range[1] + shift <= upper + ROUNDING;
        let turns = if limits.repeats(j) { [0.0, TAU, -TAU] } else { [0.0; 3] };
        let shift = turns.into_iter().map(|turn| shift + turn).find(|shift| fits(*shift))?;
        points.iter_mut().for_each(|q| q[j] += shift);
        let back = points[0][j] - points[points.len() - 1][j];
        winding |= closed && lower.is_finite() && upper.is_finite() && back.abs() > 1.0;
    }
    Some(winding)
}

/// The joint nearest to one of its limits.
fn nearest_limit(q: &[f64], bounds: &Bounds) -> Option<usize> {
    let room = |j: &usize| (q[*j] - bounds.lower()[*j]).min(bounds.upper()[*j] - q[*j]);
    (0..q.len()).min_by(|a, b| room(a).total_cmp(&room(b)))
}

/// By the distance from `start`, or by length.
fn sort(curves: &mut [SelfMotion], start: Option<&[f64]>) {
    match start {
        Some(start) => {
            let nearest = |curve: &SelfMotion| curve.iter().map(|q| distance(q, start)).fold(f64::INFINITY, f64::min);
            curves.sort_by(|a, b| nearest(a).total_cmp(&nearest(b)));
        }
        None => curves.sort_by(|a, b| b.length().total_cmp(&a.length())),
    }
}
