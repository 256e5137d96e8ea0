//! Solution of a pose of which one part comes first: least error of the first part, then least error of the second among those.

use super::ranked_descent::{MOST_EVALUATIONS, RankedDescent, RankedPoint};
use super::seeds::RankedStart;
use crate::ik::attempt::Attempt;
use crate::ik::clear::in_collision_at;
use crate::ik::solution::{Nearest, Solution};
use crate::ik::whole_turns::bring_near;
use crate::math::Frame;
use crate::objective::Point;
use crate::solver::Status;
use crate::task::{Assessment, First, Target};

/// Difference of the first error (m, rad) that counts as none.
const SAME_FIRST: f64 = 1e-9;

/// Difference of the second value, 1 - cos(angle) or half a squared distance (m^2), that counts as none.
const SAME_SECOND: f64 = 1e-10;

/// Returns the solution of an arm with a closed form for positions, whose scan decides without a search; `None` for others, and
/// where that leaves open whether the tolerances can be met.
pub(in crate::ik) fn ranked_at_once(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let (pose, first) = ranked_pose(attempt)?;
    let seeds = attempt.closed_form_seeds(&pose, first)?;
    let best = best_of(attempt, &pose, first, seeds.iter(), &mut vec![]);
    let found = chosen(attempt, best, start)?;
    let (_, criterion) = attempt.problem.only_target()?;
    // Within tolerances that are wide, another configuration may meet both parts.
    let decides = match found.status {
        Status::Solved => true,
        Status::Stalled => false,
        _ => !criterion.has_band(),
    };
    decides.then_some(found)
}

/// Returns the solution in place of `missed`, which did not meet the whole pose; `missed` itself for a task without an order.
#[cold]
pub(in crate::ik) fn ranked_solution(
    attempt: &mut Attempt<'_, '_>,
    missed: Solution,
    start: Option<&[f64]>,
) -> Solution {
    let Some((pose, first)) = ranked_pose(attempt) else { return missed };
    if attempt.budget.is_spent() {
        return missed;
    }
    let near: Vec<&[f64]> = std::iter::once(&missed.q[..]).chain(start).collect();
    let mut seeds = attempt.searched_seeds(&pose, first, &near);
    seeds.extend(attempt.closed_form_seeds(&pose, first).into_iter().flatten());
    let mut blocked = vec![];
    let best = best_of(attempt, &pose, first, seeds.iter(), &mut blocked);
    let found = chosen(attempt, best, start).filter(|found| blocked.is_empty() || found.status != Status::Stalled);
    let Some(found) = found else { return in_collision_at(attempt, &blocked).unwrap_or(missed) };
    match found.status {
        Status::Stalled => {
            let mut found = attempt.explained(missed.status, found.q);
            if found.obstruction.is_empty() {
                found.obstruction.clone_from(&missed.obstruction);
            }
            found
        }
        _ => found,
    }
}

/// The pose that is asked for, and the part that comes first, if one does.
fn ranked_pose(attempt: &Attempt<'_, '_>) -> Option<(Frame, First)> {
    match attempt.problem.only_target()? {
        (target @ Target::Pose(pose), _) => Some((*pose, attempt.context.comes_first(target)?)),
        _ => None,
    }
}

/// Descends from the seeds, and returns the points with the least error of the first part, of these those with the least of the
/// second. Points that meet the first part but are not clear are added to `blocked`.
fn best_of<'s>(
    attempt: &mut Attempt<'_, '_>,
    pose: &Frame,
    first: First,
    seeds: impl Iterator<Item = &'s RankedStart>,
    blocked: &mut Vec<Point>,
) -> Vec<RankedPoint> {
    let (robot, bounds) = (attempt.context.robot(), attempt.context.bounds());
    let mut descent = RankedDescent::new(robot, pose, first, bounds);
    let mut points: Vec<RankedPoint> = vec![];
    let mut least = f64::INFINITY;
    for start in seeds {
        if attempt.budget.left() < descent.evaluations + MOST_EVALUATIONS {
            break;
        }
        if start.least > least + SAME_SECOND {
            continue;
        }
        let point = descent.descend(&start.q);
        if point.is_met() && attempt.context.space().is_none() {
            least = least.min(point.second);
        }
        points.push(point);
    }
    attempt.budget.evaluations += descent.evaluations;
    if let Some(space) = attempt.context.space() {
        points.retain(|point| {
            let is_clear = space.holds(&point.q);
            if point.is_met() && !is_clear {
                blocked.push(point.q.clone());
            }
            is_clear
        });
    }
    let least = points.iter().map(|point| point.first).fold(f64::INFINITY, f64::min);
    points.retain(|point| point.first <= least + SAME_FIRST);
    let least = points.iter().map(|point| point.second).fold(f64::INFINITY, f64::min);
    points.retain(|point| point.second <= least + SAME_SECOND);
    points
}

/// Returns the one of `points` that the caller prefers; its status is [`Status::Stalled`] if it does not meet the first part.
fn chosen(attempt: &Attempt<'_, '_>, mut points: Vec<RankedPoint>, start: Option<&[f64]>) -> Option<Solution> {
    let context = attempt.context;
    let preference = context.preference(start);
    let reference = preference.reference();
    points.iter_mut().for_each(|point| bring_near(context.robot(), context.bounds(), &reference, &mut point.q));
    let q = Point::from_slice(preference.nearest(points.iter().map(|point| &point.q[..]))?);
    let (target, _) = attempt.problem.only_target()?;
    let Assessment { score, error } = attempt.problem.assess(&q);
    let status = match context.given_up(target, &error) {
        _ if score.solved => Status::Solved,
        Some(status) => status,
        None => Status::Stalled,
    };
    let mut solution = attempt.explained(status, q);
    if let Some(space) = context.space().filter(|_| !context.options().nearest_later) {
        solution.nearest = Some(Box::new(Nearest::at(space, &solution.q)));
    }
    Some(solution)
}
