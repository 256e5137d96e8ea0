//! First solution of a pose by the closed form of the arm.

use super::all_branches::nearest_of_all_branches;
use super::attempt::Attempt;
use super::first_of_family::FamilySearch;
use super::out_of_reach::{is_wide, obstruction, unreachable_result};
use super::preference::Miss;
use super::ranked::ranked_at_once;
use super::solution::Solution;
use crate::closed_form::ArmConfigurations;
use crate::math::Frame;
use crate::objective::Point;
use crate::solver::Status;
use crate::task::Target;

/// Smallest evaluation budget for the closed form; smaller ones are left to the search.
pub(super) const LEAST_BUDGET: usize = 500;

/// Evaluations of the search before a closed form that is slower than most searches.
const TRIAL: usize = 100;

/// Returns the branch nearest to the start or, without one, the most central branch; the nearest configuration if there is
/// provably no solution inside the limits. `None` if the closed form does not apply, or cannot decide.
pub(super) fn by_closed_form(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let context = attempt.context;
    let (target @ Target::Pose(pose), _) = attempt.problem.only_target()? else { return None };
    if !context.asks_for_pose(target) || attempt.budget.left() < LEAST_BUDGET {
        return None;
    }
    let robot = context.robot();
    match (robot.solves_at_once()?, robot.family(pose)) {
        (true, Some(family)) => FamilySearch::new(context, &family, start).first(attempt),
        (true, None) => of_branches(attempt, pose, start),
        (false, Some(_)) => None,
        (false, None) => after_trial(attempt, start),
    }
}

/// Solves for an arm with as many joints as the pose needs.
#[inline]
fn of_branches(attempt: &mut Attempt<'_, '_>, pose: &Frame, start: Option<&[f64]>) -> Option<Solution> {
    if let Some(start) = start
        && let Some(solution) = attempt.solved_at(Point::from_slice(start))
    {
        return Some(solution);
    }
    let context = attempt.context;
    let preference = context.preference(start);
    let mut likely = ArmConfigurations::none();
    if context.robot().approximate_branches(pose, &mut likely)
        && let Some(solution) = attempt.descended_from(&preference, &mut likely)
    {
        return Some(solution);
    }
    context.robot().likely_branches(pose, &mut likely);
    match attempt.preferred(&preference, &mut likely) {
        Ok(solution) => Some(solution),
        Err(_) if let Some(solution) = ranked_at_once(attempt, start) => Some(solution),
        Err(Miss::Far) if likely.is_all && !is_wide(attempt) => {
            let obstruction = obstruction(attempt, Some(likely.len()));
            let from = match start {
                None => preference.nearest_miss(&mut likely),
                Some(start) => Some(Point::from_slice(start)),
            };
            let from = from.unwrap_or_else(|| attempt.first_start(None));
            Some(unreachable_result(attempt, from, obstruction))
        }
        // Nearly singular pose, or tolerances below the rounding of the closed form.
        Err(_) => nearest_of_all_branches(attempt, &preference, start),
    }
}

/// Searches briefly before a closed form that is slower than most searches.
#[cold]
fn after_trial(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let x0 = attempt.first_start(start);
    let reserve = attempt.budget.left().saturating_sub(TRIAL);
    let (status, q) = attempt.search(attempt.context.bounds(), &x0, reserve);
    if status != Status::BudgetSpent || attempt.budget.is_spent() {
        return Some(attempt.explained(status, q));
    }
    if let Some(solution) = ranked_at_once(attempt, start) {
        return Some(solution);
    }
    nearest_of_all_branches(attempt, &attempt.context.preference(start), start)
}
