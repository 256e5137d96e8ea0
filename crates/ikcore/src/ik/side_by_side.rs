//! Many targets, four side by side. Results are bit-identical to [`solve_query`].

use super::attempt::Attempt;
use super::budget::Budget;
use super::context::{Query, SolveContext};
use super::shared_time::SharedTime;
use super::solution::Solution;
use super::solve::solve_query;
use crate::objective::Point;
use crate::problem::Problem;
use crate::rng::{self, LazyRng};
use crate::solver::{Evaluator, LevenbergMarquardt, Monitor, MultiStart, run_side_by_side};

/// Targets for which it does not pay yet: lanes stand empty until the last one has ended.
const TOO_FEW: usize = 8;

/// What the evaluator of a run borrows.
struct Workspace<'a, M> {
    number: usize,
    problem: Problem<'a>,
    rng: LazyRng,
    monitor: M,
}

/// [`solve_query`] for all `queries`; calls `on_done(number, solution)` as each ends. Each asks a copy of the `monitor`; those
/// that it keeps from beginning are left out.
pub(crate) fn solve_queries<M: Monitor + Clone>(
    context: &SolveContext<'_>,
    queries: &[Query<'_>],
    monitor: &M,
    mut on_done: impl FnMut(usize, Solution),
) {
    let descent = context.side_by_side_descent().filter(|_| queries.len() >= TOO_FEW && std::env::var("FOUR").is_ok());
    let mut workspaces = Vec::new();
    for (number, query) in queries.iter().enumerate() {
        let mut monitor = monitor.clone();
        if !monitor.keep_going() {
            return;
        }
        let problem = descent.and_then(|_| side_by_side_problem(context, query));
        if let Some(problem) = problem {
            let rng = rng::stream(context.options().seed, query.stream);
            workspaces.push(Workspace { number, problem, rng, monitor });
        } else {
            on_done(number, solve_query(context, query, &mut monitor));
        }
    }
    if let Some(descent) = descent {
        run_in_lanes(context, &descent, queries, &mut workspaces, on_done);
    }
}

/// The problem of a query that can run beside others.
fn side_by_side_problem<'p>(context: &'p SolveContext<'_>, query: &'p Query<'_>) -> Option<Problem<'p>> {
    let problem = context.problem(&query.target);
    let fits = query.target.goes_side_by_side(problem.criterion()) && problem.beyond_reach(context.bounds()).is_none();
    fits.then_some(problem)
}

/// Runs the default solver, side by side until the last run is left alone.
fn run_in_lanes<'a, M: Monitor>(
    context: &'a SolveContext<'a>,
    descent: &MultiStart<LevenbergMarquardt>,
    queries: &[Query<'_>],
    workspaces: &'a mut [Workspace<'a, M>],
    mut on_done: impl FnMut(usize, Solution),
) {
    let shared = SharedTime::start();
    let runs = workspaces.iter_mut().map_while(|Workspace { number, problem, rng, monitor }| {
        if !monitor.keep_going() {
            return None;
        }
        let (budget, begun) = (Budget::new(context.options().stop), shared.enter());
        let x0 = context.first_start(problem, queries[*number].start, rng);
        let stop = budget.rest(budget.reserve());
        let evaluator = Evaluator::new(problem, context.bounds(), stop, rng, monitor);
        Some(((*number, budget, begun), evaluator, x0))
    });
    run_side_by_side(descent, context.bounds(), runs, |(number, mut budget, begun), evaluator, status| {
        budget.add(&evaluator);
        let q = Point::from_slice(&evaluator.best().x);
        let (problem, rng, monitor) = evaluator.into_parts();
        let solution = match status {
            Some(status) => Attempt { context, problem, rng, monitor, budget }.finish(&descent.solver, status, q),
            None => solve_query(context, &queries[number], monitor),
        };
        on_done(number, Solution { elapsed: shared.leave(begun), ..solution });
    });
}
