//! Distinct solutions of one target.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::all_branches::{AllBranches, all_branches};
use super::attempt::{APPROACHES, Attempt};
use super::clear::{clear_solution, made_clear};
use super::context::SolveContext;
use super::solution::{Nearest, Solution, SolveReport};
use super::solutions::{SolutionView, Solutions};
use super::solve_options::SolveOptions;
use super::whole_turns::{all_turns, bring_near, count_of_turns, has_endless_turns};
use crate::error::{Error, Result, require_at_least_one, require_positive};
use crate::message::{Message, Setting, message};
use crate::objective::{Bounds, Point};
use crate::obstacle::ClearSpace;
use crate::rng;
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::Target;

/// Consecutive known solutions after which the search ends.
const PATIENCE: usize = 100;

/// Default number of solutions of a search, and their smallest separation.
const COLLECTED: usize = 16;
const APART: f64 = 0.1;

/// Largest number of configurations that whole turns may generate from one pose.
const MOST_TURNED: f64 = 10_000.0;

/// Options of [`solve_all`].
#[derive(Debug, Clone)]
pub struct AllOptions {
    /// Options of each solve. The budgets apply to the whole search; a closed form needs no search.
    pub each: SolveOptions,
    /// Largest number of solutions to return. `None` means all of a closed form, 16 of a search.
    pub limit: Option<usize>,
    /// Joint difference (rad, m), whole turns aside, below which two solutions count as the same. `None` returns all solutions
    /// of a closed form; those of a search differ by 0.1.
    pub separation: Option<f64>,
    /// Number of parameter values at which a redundant arm with a closed form is solved, spread over those that its limits
    /// allow. 0 means a search.
    pub redundancy: usize,
    /// Whether to return each solution at all whole turns inside the limits. A joint that is unlimited on a side has endlessly
    /// many: it stays at the nearest one, and the set is not complete.
    pub turns: bool,
}

impl Default for AllOptions {
    fn default() -> Self {
        Self { each: SolveOptions::default(), limit: None, separation: None, redundancy: 16, turns: false }
    }
}

/// Distinct solutions, and how the search ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolutionSet {
    /// Solutions, nearest to the start first; without a start in the order of discovery.
    pub solutions: Solutions,
    /// Nearest two bodies at each solution, if obstacles or self-collision were checked.
    pub nearest: Option<Vec<Nearest>>,
    /// Reason for having no solution, if that is proven. [`nearest_miss`] then finds a configuration near the target.
    pub obstruction: Option<String>,
    /// Best miss of a search that found no solution.
    pub miss: Option<Box<Solution>>,
    /// Whether there is provably no other solution inside the limits, whole turns aside unless all of them were asked for.
    pub complete: bool,
    /// Whether the pose is singular: a solution represents a family in which a joint is free.
    pub singular: bool,
    /// Iterations of a search, over all starts.
    pub iterations: usize,
    /// Starts of a search beyond the first.
    pub restarts: usize,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
    /// Whether the monitor asked to stop.
    pub interrupted: bool,
}

impl SolutionSet {
    /// Status [`Status::Solved`] if there is a solution, else the reason for having none.
    pub fn status(&self) -> Status {
        match (&self.obstruction, &self.miss) {
            (Some(_), _) => Status::OutOfReach,
            (None, Some(miss)) => miss.status,
            (None, None) if !self.solutions.is_empty() => Status::Solved,
            (None, None) if self.interrupted => Status::Interrupted,
            (None, None) => Status::InCollision,
        }
    }

    /// Returns a sentence with the number of solutions, or the reason for having none.
    pub fn message(&self) -> Message {
        if let Some(obstruction) = &self.obstruction {
            return message![format!("no solution ({obstruction}): "), Status::OutOfReach.advice()];
        }
        let count = match (self.solutions.len(), &self.miss) {
            (0, Some(miss)) => return message!["no solution; best miss: ", miss.message()],
            (0, None) => return message!["no solution: ", self.status().advice()],
            (1, _) => "1 solution".into(),
            (count, _) => format!("{count} distinct solutions"),
        };
        let complete = if self.complete { ", no others inside the limits" } else { "" };
        let singular = if self.singular { "; the pose is singular: a family counts as one solution" } else { "" };
        format!("{count}{complete}{singular}").into()
    }

    /// Set of these solutions, all other fields empty.
    fn of(solutions: Solutions) -> Self {
        Self {
            solutions,
            nearest: None,
            obstruction: None,
            miss: None,
            complete: false,
            singular: false,
            iterations: 0,
            restarts: 0,
            evaluations: 0,
            elapsed: Duration::ZERO,
            interrupted: false,
        }
    }

    /// Solution number `i`, counted from 0, with the counts of all; `None` beyond the last.
    pub fn solution(&self, i: usize) -> Option<Solution> {
        let SolutionView { q, error } = self.solutions.get(i)?;
        let report = SolveReport {
            status: Status::Solved,
            error,
            obstruction: String::new(),
            own_points: None,
            nearest: self.nearest.as_ref().and_then(|nearest| nearest.get(i).cloned()).map(Box::new),
            iterations: self.iterations,
            restarts: self.restarts,
            evaluations: self.evaluations,
            elapsed: self.elapsed,
        };
        Some(Solution { q: Point::from_slice(q), report })
    }
}

/// Returns all solutions of a pose if the arm has a closed form ([`Robot::closed_form`]); otherwise searches for distinct
/// solutions until a hundred consecutive ones were known already, or the budget is spent.
///
/// The closed form applies to whole poses with the default solver, without weights, region or goals.
///
/// Each solution is returned at the whole turns nearest to the start or, without one, to the middle of the limits. A redundant
/// arm has infinitely many solutions: those returned are at least the separation apart.
///
/// # Errors
/// Any [`enum@Error`] for wrong input; [`Error::Contradiction`] if whole turns make more than 10,000 configurations.
pub fn solve_all(
    robot: &Robot,
    target: &Target,
    options: &AllOptions,
    monitor: &mut dyn Monitor,
) -> Result<SolutionSet> {
    solve_all_tips(robot, std::slice::from_ref(target), options, monitor)
}

/// Searches for distinct solutions of several tips, otherwise like [`solve_all`]. `targets` belong to the tasks of
/// [`SolveOptions::tips`], in the same order.
///
/// # Errors
/// As [`solve_all`]; [`Error::Contradiction`] for tasks of different levels, which choose among configurations that do not meet all.
pub fn solve_all_tips(
    robot: &Robot,
    targets: &[Target],
    options: &AllOptions,
    monitor: &mut dyn Monitor,
) -> Result<SolutionSet> {
    let AllOptions { each, limit, separation, redundancy, turns } = options;
    separation.map_or(Ok(()), |separation| require_positive("separation", separation))?;
    limit.map_or(Ok(()), |limit| require_at_least_one("limit", limit))?;
    let context = SolveContext::new(robot, each)?;
    context.require_one_level()?;
    let targets = context.read(targets)?;
    let start = each.start.as_deref().map(|q| context.hint(q)).transpose()?;
    let start = start.as_deref();
    let mut problem = context.problem(&targets);
    let mut rng = rng::stream(each.seed, 0);
    let mut attempt = Attempt::new(&context, &mut problem, &mut rng, monitor);
    let reference = start.map_or_else(|| middle(context.robot(), context.bounds()), Point::from_slice);
    let branches = all_branches(&mut attempt, &reference, *redundancy);
    let limit = limit.unwrap_or(if branches.is_some() { usize::MAX } else { COLLECTED });
    let mut found = match branches {
        Some(branches) => by_closed_form(&attempt, branches, *separation),
        None => search(&mut attempt, start, &reference, limit, separation.unwrap_or(APART)),
    };
    if let Some(space) = context.space() {
        require_clear(&mut found, &mut attempt, space, start);
    }
    if *turns {
        found.solutions = at_all_turns(&context, &found.solutions)?;
        let is_endless = has_endless_turns(context.robot(), context.bounds());
        found.complete &= !is_endless || found.solutions.is_empty();
    }
    if let Some(start) = start {
        found.solutions.sort_by_distance(start);
    }
    found.complete &= found.solutions.len() <= limit;
    found.solutions.truncate(limit);
    if let Some(space) = context.space() {
        // Rounding in whole turns may have taken a solution out of the clear space.
        found.solutions = found.solutions.filtered(|_, q| space.holds(q));
        found.nearest = Some(found.solutions.iter().map(|one| Nearest::at(space, one.q)).collect());
    }
    (found.iterations, found.restarts) = (attempt.budget.iterations, attempt.budget.restarts);
    (found.evaluations, found.elapsed) = (attempt.budget.evaluations, attempt.budget.elapsed());
    Ok(found)
}

/// Keeps the clear solutions of a closed form. If there is none, searches for one, or reports the obstruction.
fn require_clear<'p>(
    found: &mut SolutionSet,
    attempt: &mut Attempt<'_, 'p>,
    space: &'p ClearSpace<'p>,
    start: Option<&[f64]>,
) {
    let any = !found.solutions.is_empty();
    found.solutions = found.solutions.filtered(|_, q| space.holds(q));
    if any && found.solutions.is_empty() && !found.interrupted {
        let solution = clear_solution(attempt, space, start);
        found.complete &= solution.status == Status::InCollision;
        match solution.status {
            Status::Solved => found.solutions.push(&solution.q, solution.error),
            _ => found.miss = Some(Box::new(solution)),
        }
    }
}

/// Returns the nearest of a few descents towards a target that [`solve_all`] proves to be out of reach.
///
/// # Errors
/// Any [`enum@Error`] for wrong input.
pub fn nearest_miss(
    robot: &Robot,
    target: &Target,
    options: &AllOptions,
    monitor: &mut dyn Monitor,
) -> Result<Solution> {
    let context = SolveContext::new(robot, &options.each)?;
    let targets = context.read(std::slice::from_ref(target))?;
    let mut problem = context.problem(&targets);
    let mut rng = rng::stream(options.each.seed, 0);
    let mut attempt = Attempt::new(&context, &mut problem, &mut rng, monitor);
    let start = options.each.start.as_deref().map(|q| context.hint(q)).transpose()?;
    let reference = start.as_deref().map_or_else(|| middle(context.robot(), context.bounds()), Point::from_slice);
    Ok(attempt.approached(&reference, APPROACHES, usize::MAX))
}

/// Result of the closed form, with solutions at least `separation` apart.
fn by_closed_form(attempt: &Attempt<'_, '_>, branches: AllBranches, separation: Option<f64>) -> SolutionSet {
    let AllBranches { solutions: all, obstruction, complete, singular, interrupted } = branches;
    let count = all.len();
    let robot = attempt.context.robot();
    let solutions = match separation {
        Some(apart) => all.filtered(|kept, q| !is_known(robot, kept, q, apart)),
        None => all,
    };
    SolutionSet {
        complete: complete && solutions.len() == count,
        obstruction,
        singular,
        interrupted,
        ..SolutionSet::of(solutions)
    }
}

fn search(
    attempt: &mut Attempt<'_, '_>,
    start: Option<&[f64]>,
    reference: &[f64],
    limit: usize,
    separation: f64,
) -> SolutionSet {
    let (robot, bounds) = (attempt.context.robot(), attempt.context.bounds());
    let mut x0 = attempt.first_start(start);
    let (mut solutions, mut known) = (Solutions::new(robot.dof()), 0);
    let (mut interrupted, mut blocked) = (false, None);
    let last = loop {
        let mut solution = attempt.solve_from(&x0);
        attempt.mark_held_in_region(&mut solution);
        if solution.status != Status::Solved {
            break blocked.or(Some(solution));
        }
        if let Some(space) = attempt.context.space() {
            solution = made_clear(attempt, space, solution);
        }
        bring_near(robot, bounds, reference, &mut solution.q);
        if solution.status != Status::Solved || is_known(robot, &solutions, &solution.q, separation) {
            known += 1;
        } else {
            known = 0;
            solutions.push(&solution.q, solution.error);
        }
        if solution.status != Status::Solved {
            blocked = Some(solution);
        }
        // Without a start any solutions suffice; with one, the nearest are wanted, and they may be found last.
        let enough = start.is_none() && solutions.len() == limit;
        // Polls here too, since runs may be too short to poll.
        interrupted = !attempt.monitor.keep_going();
        if interrupted || known == PATIENCE || enough || attempt.budget.is_spent() {
            break blocked;
        }
        attempt.next_start(&mut x0);
    };
    interrupted |= last.as_ref().is_some_and(|solution| solution.status == Status::Interrupted);
    let miss = last.filter(|_| solutions.is_empty()).map(Box::new);
    SolutionSet { miss, interrupted, ..SolutionSet::of(solutions) }
}

/// Each solution at all whole turns inside the limits.
fn at_all_turns(context: &SolveContext<'_>, solutions: &Solutions) -> Result<Solutions> {
    let (robot, bounds) = (context.robot(), context.bounds());
    let count: f64 = solutions.iter().map(|solution| count_of_turns(robot, bounds, solution.q)).sum();
    if count > MOST_TURNED {
        return Err(Error::Contradiction {
            problem: message![
                Setting::AllTurns,
                format!(" makes {count} configurations; at most {MOST_TURNED} are allowed: narrow the limits"),
            ],
        });
    }
    let mut turned = Solutions::new(robot.dof());
    for SolutionView { q, error } in solutions.iter() {
        all_turns(robot, bounds, q).iter().for_each(|q| turned.push(q, error));
    }
    Ok(turned)
}

/// Middle of the sampling ranges of the joints.
fn middle(robot: &Robot, bounds: &Bounds) -> Point {
    let ranges = bounds.lower().iter().zip(bounds.upper()).zip(robot.joints());
    ranges
        .map(|((lower, upper), joint)| {
            let (lower, upper) = joint.sampling_range_within(*lower, *upper);
            0.5 * (lower + upper)
        })
        .collect()
}

/// Whether one of the `solutions` differs from `q` by less than `separation` in every joint, whole turns aside.
fn is_known(robot: &Robot, solutions: &Solutions, q: &[f64], separation: f64) -> bool {
    let apart = |j: usize, other: &[f64]| {
        let difference = other[j] - q[j];
        robot.turn_period(j).map_or(difference, |turn| difference - turn * (difference / turn).round())
    };
    solutions.iter().any(|other| (0..q.len()).all(|j| apart(j, other.q).abs() < separation))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_without_solutions_says_why() {
        let set = |interrupted| SolutionSet { interrupted, ..SolutionSet::of(Solutions::new(1)) };
        assert_eq!(set(true).status(), Status::Interrupted);
        assert_eq!(set(false).status(), Status::InCollision);
        assert!(set(false).message().to_string().starts_with("no solution: move the target"));
    }
}
