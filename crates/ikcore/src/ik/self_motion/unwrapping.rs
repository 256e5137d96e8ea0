//! Unwrapping of curves: whole turns that bring a part within the limits, its points at the target, and its ends at the limits.

use std::f64::consts::TAU;

use super::curve::SelfMotion;
use super::cut::CurvePart;
use super::wrapped_limits::WrappedLimits;
use crate::ik::attempt::Attempt;
use crate::math::vector::{distance, norm};
use crate::objective::{Bounds, Point};
use crate::solver::LevenbergMarquardt;

/// Accuracy of the points: each reaches the target to twice this (m, rad).
pub(super) const EXACT: f64 = 1e-9;

/// Returns the curve of a part, at the whole turns that bring it within the limits; several curves if it takes several turns.
/// Points that do not reach the target from within the limits are omitted; so is an end where the curve grazes its limit and
/// the solution at the limit is elsewhere. A gap wider than `spacing` divides the curve.
pub(super) fn unwrapped(
    part: CurvePart,
    spacing: f64,
    attempt: &mut Attempt<'_, '_>,
    limits: &WrappedLimits<'_>,
    start: Option<&[f64]>,
) -> Vec<SelfMotion> {
    let bounds = attempt.context.bounds();
    let CurvePart { mut points, closed, cut } = part;
    follow(&mut points, limits);
    let anchor = start.map_or(0, |start| nearest_to(&points, start, limits));
    let Some(winding) = fitted(&mut points, anchor, closed, bounds, limits) else {
        // A joint of several turns leaves its limits along the curve.
        let half = points.len() / 2;
        if half < 2 {
            return Vec::new();
        }
        let first = CurvePart { points: points[..=half].to_vec(), closed: false, cut: [cut[0], false] };
        let second = CurvePart { points: points[half..].to_vec(), closed: false, cut: [false, cut[1]] };
        return [first, second].into_iter().flat_map(|part| unwrapped(part, spacing, attempt, limits, start)).collect();
    };
    let end = points.len() - 1;
    let [lower_cut, upper_cut] =
        [(cut[0], 0), (cut[1], end)].map(|(cut, k)| cut.then(|| nearest_limit(&points[k], bounds)));
    let mut runs: Vec<Vec<Point>> = Vec::new();
    for (k, point) in points.into_iter().enumerate() {
        let is_cut = k == 0 && cut[0] || k == end && cut[1];
        let Some(q) = settled(point, is_cut, attempt) else { continue };
        match runs.last_mut() {
            Some(run) if distance(&q, &run[run.len() - 1]) <= spacing => run.push(q),
            _ => runs.push(vec![q]),
        }
    }
    let whole = runs.len() == 1;
    runs.retain(|run| whole || run.len() > 1);
    let last = runs.len().saturating_sub(1);
    let curve = |(i, run): (usize, Vec<Point>)| SelfMotion {
        joints: limits.joints(),
        closed: whole && closed && !winding,
        lower_cut: lower_cut.flatten().filter(|_| i == 0),
        upper_cut: upper_cut.flatten().filter(|_| i == last),
        complete: false,
        values: run.iter().flatten().copied().collect(),
    };
    runs.into_iter().enumerate().map(curve).collect()
}

/// Returns the configuration near `q` that reaches the target from within the limits. At a cut, the joint nearest to a limit is
/// fixed at the limit.
fn settled(mut q: Point, is_cut: bool, attempt: &mut Attempt<'_, '_>) -> Option<Point> {
    let mut bounds = attempt.context.bounds().clone();
    if is_cut && let Some(joint) = nearest_limit(&q, &bounds) {
        let (lower, upper) = bounds.parts_mut();
        let limit = if q[joint] - lower[joint] < upper[joint] - q[joint] { lower[joint] } else { upper[joint] };
        (lower[joint], upper[joint]) = (limit, limit);
    }
    let before = q.clone();
    bounds.clip(&mut q);
    if is_cut || q != before {
        q = attempt.descend_beyond(&LevenbergMarquardt::default(), q, EXACT, &bounds);
    }
    let error = attempt.problem.assess(&q).error;
    let missed = error.position.unwrap_or(0.0).max(error.rotation.unwrap_or(0.0));
    (missed <= 4.0 * EXACT * EXACT).then_some(q)
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

/// Index of the point nearest to `start`, whole turns aside.
fn nearest_to(points: &[Point], start: &[f64], limits: &WrappedLimits<'_>) -> usize {
    let away = |i: &usize| norm(&limits.apart(&points[*i], start));
    (0..points.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0)
}

/// Shifts the points by whole turns within the limits, point `anchor` near the middle. Returns whether a joint with limits ends
/// a whole turn from its start; `None` if the points do not fit.
fn fitted(
    points: &mut [Point],
    anchor: usize,
    closed: bool,
    bounds: &Bounds,
    limits: &WrappedLimits<'_>,
) -> Option<bool> {
    const OFF_CURVE: f64 = 1e-6;
    let joints = limits.joints();
    let mut winding = false;
    for j in 0..joints {
        let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
        let range =
            points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(q[j]), high.max(q[j])]);
        let shift = limits.near_middle(j, points[anchor][j]) - points[anchor][j];
        let fits = |shift: f64| lower - OFF_CURVE <= range[0] + shift && range[1] + shift <= upper + OFF_CURVE;
        let turns = if limits.repeats(j) { [0.0, TAU, -TAU] } else { [0.0; 3] };
        let shift = turns.into_iter().map(|turn| shift + turn).find(|shift| fits(*shift))?;
        points.iter_mut().for_each(|q| q[j] += shift);
        let back = points[0][j] - points[points.len() - 1][j];
        winding |= closed && lower.is_finite() && upper.is_finite() && back.abs() > 1.0;
    }
    Some(winding)
}

/// Joint nearest to one of its limits.
fn nearest_limit(q: &[f64], bounds: &Bounds) -> Option<usize> {
    let room = |j: &usize| (q[*j] - bounds.lower()[*j]).min(bounds.upper()[*j] - q[*j]);
    (0..q.len()).min_by(|a, b| room(a).total_cmp(&room(b)))
}
