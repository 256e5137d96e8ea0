//! The first solution of a pose by the closed form of the arm.

use super::all_branches::all_branches;
use super::attempt::Attempt;
use super::preference::Preference;
use super::solution::Solution;
use crate::task::Target;

/// The branch nearest to the start or, without one, the most central; or the nearest configuration, if it is proven that there
/// is no solution inside the limits. None where the closed form does not apply, or leaves that open.
pub(super) fn by_closed_form(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let (context, target) = (attempt.context, attempt.problem.target());
    let Target::Pose(pose) = target else { return None };
    if !context.asks_for_pose_alone(target) {
        return None;
    }
    let branches = context.robot().branches(pose)?;
    if let Some(start) = start
        && let Some(solution) = attempt.solved_at(start.into())
    {
        return Some(solution);
    }
    let preference = Preference::new(context, start);
    attempt.budget.evaluations += branches.evaluations;
    if let Some(q) = preference.choose(branches.qs.iter().map(|q| q.as_slice()))
        && let Some(solution) = attempt.solved_at(q)
    {
        return Some(solution);
    }
    // Limits cut all branches, or the tolerances are tighter than rounding allows the closed form.
    let all = all_branches(attempt, &preference.reference())?;
    all.solutions.into_iter().next().or(all.miss)
}
