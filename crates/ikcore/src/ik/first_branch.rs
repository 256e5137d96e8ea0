//! The first solution of a pose by the closed form of the arm.

use super::all_branches::all_branches;
use super::attempt::Attempt;
use super::near_misses::{LOOKED, from_near_misses};
use super::preference::{Miss, Preference};
use super::solution::Solution;
use crate::closed_form::{ArmConfigurations, PoseFamily, VERIFIED};
use crate::math::Frame;
use crate::objective::Point;
use crate::solver::Status;
use crate::task::Target;

/// Most values of the parameter of a redundant arm that are tried before near misses are.
const SCANNED: usize = 32;

/// Values after which it is asked whether any can have a solution: most poses have one before.
const VALUES_BEFORE_DOUBT: usize = 4;

/// The search after both takes one of so many evaluations that the budget leaves.
const SEARCHED_SHARE: usize = 150;

/// Evaluations of a descent towards a pose that is proven to be out of reach: it ends within 3 % of what a whole descent reaches
/// (UR5e, measured).
const STEPS_OF_PROVEN: usize = 6;

/// Budgets of fewer evaluations are left to the search.
pub(super) const LEAST_BUDGET: usize = 500;

/// Evaluations of a search that comes before a closed form that takes longer than most searches.
const TRIAL: usize = 100;

/// The branch nearest to the start or, without one, the most central one; or the nearest configuration, if it is proven that
/// there is no solution inside the limits. None where the closed form does not apply, or leaves that open.
pub(super) fn by_closed_form(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let context = attempt.context;
    let (target @ Target::Pose(pose), _) = attempt.problem.only_target()? else { return None };
    if !context.asks_for_pose(target) || attempt.budget.left() < LEAST_BUDGET {
        return None;
    }
    let robot = context.robot();
    match (robot.solves_at_once()?, robot.family(pose)) {
        (true, Some(family)) => of_family(attempt, &family, start),
        (true, None) => of_branches(attempt, pose, start),
        (false, Some(_)) => None,
        (false, None) => after_trial(attempt, start),
    }
}

/// Of an arm that has as many joints as the pose needs.
#[inline]
fn of_branches(attempt: &mut Attempt<'_, '_>, pose: &Frame, start: Option<&[f64]>) -> Option<Solution> {
    if let Some(start) = start
        && let Some(solution) = attempt.solved_at(Point::from_slice(start))
    {
        return Some(solution);
    }
    let context = attempt.context;
    let mut likely = ArmConfigurations::none();
    context.robot().likely_branches(pose, &mut likely);
    let preference = context.preference(start);
    if let Ok(solution) = preferred(attempt, &preference, &mut likely) {
        return Some(solution);
    }
    // Limits cut all branches, the pose is nearly singular, or the tolerances are tighter than rounding allows the closed form.
    of_all_branches(attempt, &preference, start)
}

/// The preferred one of `configurations`, if it reaches the pose as well as a verified branch does.
#[inline]
fn preferred(
    attempt: &mut Attempt<'_, '_>,
    preference: &Preference,
    configurations: &mut ArmConfigurations,
) -> Result<Solution, Miss> {
    let q = preference.choose(configurations)?;
    match attempt.error_if_solved(&q) {
        Some(error) if error.position.max(error.rotation) <= VERIFIED => Ok(attempt.result(Status::Solved, q, error)),
        _ => Err(Miss::Near),
    }
}

/// Of an arm with one joint more: from the start by descent; then the first value of the parameter that has a branch inside the
/// limits.
fn of_family(attempt: &mut Attempt<'_, '_>, family: &PoseFamily<'_>, start: Option<&[f64]>) -> Option<Solution> {
    if let Some(start) = start {
        let (status, q) = attempt.search_once(start);
        if status != Status::Stalled {
            return Some(attempt.explained(status, q));
        }
    }
    let context = attempt.context;
    let preference = context.preference(start);
    let [lower, upper] = context.sampling_ranges();
    let limits = family.limits(lower, upper);
    let arcs = family.arcs(&limits);
    if arcs.is_empty() {
        return of_all_branches(attempt, &preference, start);
    }
    let mut likely = ArmConfigurations::none();
    let half_the_budget = attempt.budget.left() / 2;
    for (number, value) in arcs.scattered(SCANNED).enumerate() {
        if number == VALUES_BEFORE_DOUBT && family.is_excluded(&limits) {
            return of_all_branches(attempt, &preference, start);
        }
        family.likely_at(value, &limits, &mut likely);
        if likely.is_empty() {
            continue;
        }
        match preferred(attempt, &preference, &mut likely) {
            Ok(solution) => return Some(solution),
            Err(Miss::Far) => continue,
            Err(Miss::Near) => {}
        }
        // Beside singular poses, what is near a branch is still to be polished.
        let branches = family.branches_at(value);
        attempt.budget.evaluations += branches.evaluations;
        if let Ok(q) = preference.choose(&mut branches.configurations())
            && let Some(solution) = attempt.solved_at(q)
        {
            return Some(solution);
        }
        if attempt.budget.left() < half_the_budget {
            return None;
        }
    }
    let solution = from_near_misses(attempt, family, &arcs, &preference);
    if solution.is_some() || !family.is_sure_of_arcs() {
        return solution;
    }
    searched_in_short(attempt, start)
}

/// A search with a small share of the budget, for poses that are reached within wide tolerances alone. What it misses is reported as
/// not found, which is no proof.
#[cold]
fn searched_in_short(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let x0 = attempt.first_start(start);
    let reserve = attempt.budget.left() - attempt.budget.left() / SEARCHED_SHARE;
    let (status, q) = attempt.search(attempt.context.bounds(), &x0, reserve);
    if status != Status::BudgetSpent || attempt.budget.is_spent() {
        return Some(attempt.explained(status, q));
    }
    let mut solution = attempt.explained(Status::Stalled, q);
    if solution.obstruction.is_empty() {
        let evaluations = solution.evaluations;
        solution.obstruction = format!(
            "no solution at {} values of the redundancy, nor by a search, {evaluations} evaluations in all",
            SCANNED + LOOKED
        );
    }
    Some(solution)
}

/// Of an arm whose closed form takes longer than most searches.
#[cold]
fn after_trial(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let x0 = attempt.first_start(start);
    let reserve = attempt.budget.left().saturating_sub(TRIAL);
    let (status, q) = attempt.search(attempt.context.bounds(), &x0, reserve);
    if status != Status::BudgetSpent || attempt.budget.is_spent() {
        return Some(attempt.explained(status, q));
    }
    of_all_branches(attempt, &attempt.context.preference(start), start)
}

/// What `solve_all` finds, or proves.
#[cold]
fn of_all_branches(attempt: &mut Attempt<'_, '_>, preference: &Preference, start: Option<&[f64]>) -> Option<Solution> {
    // Of a redundant arm only whether there are any: a single value of its parameter tells.
    let all = all_branches(attempt, &preference.reference(), 1)?;
    if let Some(q) = preference.nearest(all.solutions.iter().map(|solution| solution.q)) {
        return attempt.solved_at(Point::from_slice(q));
    }
    let obstruction = all.obstruction?;
    let x0 = attempt.first_start(start);
    Some(Solution { obstruction, ..attempt.neared(&x0, STEPS_OF_PROVEN) })
}
