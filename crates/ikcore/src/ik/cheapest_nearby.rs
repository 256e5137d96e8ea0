//! Solution nearest to the start by the weights of the joints, of those nearby.

use super::attempt::Attempt;
use super::solution::Solution;
use super::whole_turns::bring_near;
use crate::objective::Point;
use crate::solver::Status;
use crate::task::Goals;

/// Moves `solution`, found by the weights of the joints, along its self-motion towards `start`, and the end of a descent without
/// weights as well. Returns the nearer of both; `solution` itself if the target leaves no motion.
pub(super) fn cheapest_nearby(attempt: &mut Attempt<'_, '_>, start: &[f64], solution: Solution) -> Solution {
    let context = attempt.context;
    let (robot, only) = (context.robot(), attempt.problem.only_target());
    if robot.dof() <= robot.task_rank().pose && only.is_some_and(|(target, _)| context.fixes_pose(target)) {
        return solution;
    }
    let mut goals = context.distance_from(start);
    let mut best = moved(attempt, &mut goals, start, solution.q);
    let without_weights = match attempt.search_once_within(context.bounds(), start) {
        (Status::Solved, q) => Some(q),
        _ => None,
    };
    for q in without_weights.into_iter().chain(attempt.search_once_without_band(start)) {
        let other = moved(attempt, &mut goals, start, q);
        if other.0 < best.0 {
            best = other;
        }
    }
    attempt.solution(Status::Solved, best.1)
}

/// Moves the solution `q` along its self-motion towards `start`. Returns the squared distance, and the end.
fn moved(attempt: &mut Attempt<'_, '_>, goals: &mut Goals, start: &[f64], mut q: Point) -> (f64, Point) {
    let context = attempt.context;
    bring_near(context.robot(), context.bounds(), start, &mut q);
    attempt.descend_goals(goals, &mut q);
    (goals.cost(context.robot(), None, &q, &mut q.clone()), q)
}
