//! One solution of one target.

use super::attempt::Attempt;
use super::best::best_solution;
use super::budget::Budget;
use super::cheapest_nearby::cheapest_nearby;
use super::clear::clear_solution;
use super::context::{Query, SolveContext};
use super::first_branch::by_closed_form;
use super::first_of_family::FamilySearch;
use super::nearest::nearest_solution;
use super::ranked::{level_solution, ranked_at_once, ranked_solution};
use super::solution::Solution;
use super::solve_options::{Prefer, SolveOptions};
use super::whole_turns::bring_near;
use crate::closed_form::ArmConfigurations;
use crate::error::Result;
use crate::math::Frame;
use crate::rng;
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stopwatch};
use crate::task::Target;

/// Number of joints that a pose needs.
const POSE: usize = 6;

/// Descents into the tolerances of a pose before its parts are ranked.
const DESCENTS: usize = 5;

/// Finds a configuration that brings the tip of `robot` to `target`.
///
/// A pose of an arm with a closed form ([`Robot::closed_form`]) is solved by it, unless a solver is named or the task has
/// weights or a region: the branch nearest to the start is returned or, without a start, the most central one inside the
/// limits. A redundant arm descends from a given start first. A pose is reported as out of reach only if the closed form proves
/// it. All other targets are solved by search.
///
/// With goals, the solution is moved along its self-motion to the nearest optimum of the goals.
///
/// With [`Prefer::Nearest`], the solve is repeated from starts at increasing distances from the given one. Each
/// solution is moved along its self-motion and by whole turns towards the start, until 24 consecutive solutions are no
/// nearer or the budget is spent. The distance is |q - start|, with joints in rad and m.
///
/// With [`Prefer::Best`], the solve is repeated from starts all over the joint space. Each solution is moved along its
/// self-motion, until 40 consecutive solutions are no better for the goals. For an arm with one joint more than its
/// task needs, each curve of solutions is traced once, beyond the limits that interrupt it, until 40 solutions or 1200
/// evaluations in a row find no new curve.
///
/// # Errors
/// Any [`Error`](crate::Error) for wrong input. A target that is not reached is a status, not an error.
pub fn solve(robot: &Robot, target: &Target, options: &SolveOptions, monitor: &mut dyn Monitor) -> Result<Solution> {
    solve_tips(robot, std::slice::from_ref(target), options, monitor)
}

/// Solves for several tips at once, otherwise like [`solve`]: `targets` belong to the tasks of [`SolveOptions::tips`], in the
/// same order. Tips without a target are free.
///
/// A search starts with the shared joints at the middle of their ranges, later anywhere; given these, each arm starts at its
/// own closed form or indexed configuration. All joints then move together.
///
/// # Errors
/// As [`solve`]; [`Error::Contradiction`](crate::Error::Contradiction) for targets that contradict each other.
pub fn solve_tips(
    robot: &Robot,
    targets: &[Target],
    options: &SolveOptions,
    monitor: &mut dyn Monitor,
) -> Result<Solution> {
    let stopwatch = Stopwatch::start();
    let context = SolveContext::new(robot, options)?;
    let targets = context.read(targets)?;
    let start = options.start.as_deref().map(|q| context.hint(q)).transpose()?;
    let start = start.as_deref();
    context.require_reference(start)?;
    Ok(solve_query(&context, &Query { targets: &targets, start, stream: 0, stopwatch }, monitor))
}

/// Solves a validated query.
pub(crate) fn solve_query(context: &SolveContext<'_>, query: &Query<'_>, monitor: &mut dyn Monitor) -> Solution {
    let mut problem = context.problem(query.targets);
    let mut rng = rng::stream(context.options().seed, query.stream);
    let budget = Budget::new(context.options().stop, query.stopwatch);
    let mut attempt = Attempt { context, problem: &mut problem, rng: &mut rng, monitor, budget };
    let mut solution = match (context.options().prefer, query.start) {
        (prefer, start)
            if (prefer != Prefer::Any || context.space().is_some())
                && let Some(found) = without_whole_pose(&mut attempt, start) =>
        {
            found
        }
        (_, start) if let Some(space) = context.space() => clear_solution(&mut attempt, space, start),
        (Prefer::Nearest, Some(start)) => nearest_solution(&mut attempt, start),
        (Prefer::Best, start) => best_solution(&mut attempt, start),
        (_, start) => first_solution(&mut attempt, start),
    };
    if is_missed(solution.status)
        && solution.status != Status::OutOfReach
        && let Some(found) = attempt.solved_within_tolerance(query.targets, &solution.q)
    {
        solution = found;
    }
    if is_missed(solution.status) {
        solution = ranked_solution(&mut attempt, solution, query.start);
    }
    if is_missed(solution.status) || solution.status == Status::InCollision {
        solution = level_solution(&mut attempt, solution, query.start);
    }
    attempt.mark_held_in_region(&mut solution);
    solution
}

/// Whether a search ended without the whole target, nor with the part of it that comes first.
fn is_missed(status: Status) -> bool {
    matches!(status, Status::OutOfReach | Status::Stalled | Status::BudgetSpent)
}

/// Returns the solution of a pose that cannot be met as a whole, if that is known at once.
fn without_whole_pose(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let found = ranked_at_once(attempt, start).or_else(|| by_levels_at_once(attempt, start));
    found.or_else(|| by_order_at_once(attempt, start)).filter(|found| found.status != Status::Solved)
}

/// Returns the solution of a pose of which one part comes first, where a search does not meet the whole pose: then no solutions are left to
/// prefer one of.
#[cold]
fn by_order_at_once(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let (target, _) = attempt.problem.only_target()?;
    if attempt.context.options().prefer == Prefer::Any || attempt.context.comes_first(target).is_none() {
        return None;
    }
    let whole = first_solution(attempt, start);
    let found = is_missed(whole.status).then(|| ranked_solution(attempt, whole, start))?;
    (!is_missed(found.status)).then_some(found)
}

/// Returns the solution by levels, if a brief search does not meet all targets.
#[cold]
fn by_levels_at_once(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    if !attempt.context.has_levels() {
        return None;
    }
    let x0 = attempt.first_start(start);
    let brief = attempt.solve_briefly_from(&x0);
    is_missed(brief.status).then(|| level_solution(attempt, brief, start))
}

/// Returns the first solution found; with goals it is moved along its self-motion.
fn first_solution(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Solution {
    let context = attempt.context;
    let at_once = by_closed_form(attempt, start).or_else(|| in_band_of_pose(attempt, start));
    let at_once = at_once.or_else(|| ranked_at_once(attempt, start));
    let mut solution = at_once.unwrap_or_else(|| searched_solution(attempt, start));
    if solution.status != Status::Solved {
        return solution;
    }
    if let Some(start) = start.filter(|_| context.weights().is_some()) {
        return cheapest_nearby(attempt, start, solution);
    }
    if context.goals().is_empty() {
        return solution;
    }
    if let Some(start) = start {
        bring_near(context.robot(), context.bounds(), start, &mut solution.q);
    }
    attempt.descend_goals(&mut context.goals().clone(), &mut solution.q);
    attempt.solution(Status::Solved, solution.q)
}

/// Returns a configuration within the tolerances of a pose: a branch of the pose itself, or the end of one descent. A descent from
/// the caller's start comes before the branches.
fn in_band_of_pose(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Option<Solution> {
    let (target @ Target::Pose(pose), _) = attempt.problem.only_target()? else { return None };
    if !attempt.context.asks_for_band_of_pose(target) {
        return None;
    }
    let branch = |attempt: &mut Attempt<'_, '_>| branch_in_band(attempt, pose, start);
    match start {
        Some(start) => descended(attempt, start).or_else(|| branch(attempt)),
        None => branch(attempt).or_else(|| descended_from_scattered(attempt)),
    }
}

/// Returns the end of the first descent from a few scattered starts that is within the tolerances.
fn descended_from_scattered(attempt: &mut Attempt<'_, '_>) -> Option<Solution> {
    let mut x0 = attempt.first_start(None);
    for descent in 0..DESCENTS {
        if descent > 0 {
            attempt.next_start(&mut x0);
            attempt.budget.restarts += 1;
        }
        if let Some(found) = descended(attempt, &x0) {
            return Some(found);
        }
    }
    None
}

/// Returns the end of one descent from `x0`, if it is within the tolerances.
fn descended(attempt: &mut Attempt<'_, '_>, x0: &[f64]) -> Option<Solution> {
    match attempt.search_once(x0) {
        (Status::Solved, q) => Some(attempt.explained(Status::Solved, q)),
        _ => None,
    }
}

/// Returns the preferred branch of `pose`, for an arm with at least as many joints as a pose needs.
fn branch_in_band(attempt: &mut Attempt<'_, '_>, pose: &Frame, start: Option<&[f64]>) -> Option<Solution> {
    let context = attempt.context;
    let robot = context.robot();
    if robot.dof() < POSE || robot.solves_at_once() != Some(true) {
        return None;
    }
    if let Some(family) = robot.family(pose) {
        return FamilySearch::new(context, &family, start).at_first_values(attempt);
    }
    let mut likely = ArmConfigurations::none();
    robot.likely_branches(pose, &mut likely);
    let q = context.preference(start).choose(&mut likely).ok()?;
    attempt.solved_at(q)
}

/// Searches for a solution from the first start.
fn searched_solution(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Solution {
    let x0 = attempt.first_start(start);
    if attempt.context.weights().is_some()
        && let Some(solution) = descended(attempt, &x0)
    {
        return solution;
    }
    match attempt.problem.only_target() {
        Some((target, _)) if attempt.context.comes_first(target).is_some() => attempt.solve_briefly_from(&x0),
        None if attempt.context.has_levels() => attempt.solve_briefly_from(&x0),
        _ => attempt.solve_from(&x0),
    }
}
