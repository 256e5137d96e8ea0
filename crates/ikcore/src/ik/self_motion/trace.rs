//! Tracing of a self-motion curve in short steps, without joint limits.

use super::curve_walk::{CurvePoint, StepKind, Walk};
use super::wrapped_limits::WrappedLimits;
use crate::math::vector::{distance, dot};
use crate::problem::Problem;
use crate::solver::Monitor;

/// Longest step as a fraction of the spacing: the correction of a step makes it longer by at most a third.
const STEP_FRACTION: f64 = 0.75;

/// Longest curve (rad, m).
const MOST_LENGTH: f64 = 100.0;

/// Steps between two polls of the monitor.
const STEPS_BETWEEN_LOOKS: usize = 64;

/// Traced curve, its points no farther apart than the spacing.
#[derive(Debug, Clone)]
pub(super) struct TracedCurve {
    pub points: Vec<CurvePoint>,
    /// Whether the last point is followed by the first, whole turns aside.
    pub closed: bool,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
}

/// Traces the curve through the solution `seed`, or the one in the direction `along` where several cross; `None` if it is not on
/// exactly one curve. The limits of a prismatic joint end the curve.
pub(super) fn traced(
    problem: &mut Problem<'_>,
    limits: &WrappedLimits<'_>,
    seed: &[f64],
    along: Option<&[f64]>,
    spacing: f64,
    monitor: &mut dyn Monitor,
) -> Option<TracedCurve> {
    let longest = STEP_FRACTION * spacing;
    let most_steps = (MOST_LENGTH / longest) as usize;
    let mut walk = match along {
        Some(along) => Walk::enter_along(problem, seed, along, 16 * most_steps, longest)?,
        None => Walk::enter(problem, seed, 16 * most_steps, longest)?,
    };
    let begin = walk.here().clone();
    let mut points = vec![begin.clone()];
    let closed = walk_on(&mut walk, limits, spacing, most_steps, monitor, &mut points);
    if !closed {
        // Opposite direction: its points precede those found before.
        walk.turn_back_at(&begin);
        let mut others = vec![walk.here().clone()];
        walk_on(&mut walk, limits, spacing, most_steps, monitor, &mut others);
        let reversed = others.drain(1..).rev().map(|CurvePoint { q, along }| {
            let along = along.iter().map(|slope| -slope).collect();
            CurvePoint { q, along }
        });
        points.splice(0..0, reversed.collect::<Vec<_>>());
    }
    let evaluations = walk.evaluations();
    Some(TracedCurve { points, closed, evaluations })
}

/// Adds points until the curve closes or ends. Returns whether it closes.
fn walk_on(
    walk: &mut Walk<'_, '_>,
    limits: &WrappedLimits<'_>,
    spacing: f64,
    most_steps: usize,
    monitor: &mut dyn Monitor,
    points: &mut Vec<CurvePoint>,
) -> bool {
    let begin = walk.here().clone();
    for count in 1..=most_steps {
        if count % STEPS_BETWEEN_LOOKS == 0 && !monitor.keep_going() {
            return false;
        }
        let Some((from, step)) = walk.step() else { return false };
        let there = walk.here();
        let length = distance(&there.q, &from.q);
        // The walk may be on another curve after a corner.
        if length > spacing || step == StepKind::Corner && length > 0.5 * spacing || limits.slid_out(&there.q) {
            return false;
        }
        if count > 3 && there.has_closed_at(&begin, length, limits) {
            return true;
        }
        points.push(there.clone());
    }
    false
}

impl TracedCurve {
    /// Whether `q` is nearer to the curve than `near` (rad, m).
    pub fn passes(&self, limits: &WrappedLimits<'_>, q: &[f64], near: f64, spacing: f64) -> bool {
        let may_reach = |at: &[f64]| (0..q.len()).all(|j| limits.turned(j, q[j] - at[j]).abs() < spacing + near);
        self.points.iter().filter(|at| may_reach(&at.q)).any(|at| {
            let there = limits.apart(q, &at.q);
            let along = dot(&there, &at.along);
            let aside = (dot(&there, &there) - along * along).max(0.0).sqrt();
            along.abs() < spacing && aside < near
        })
    }
}
