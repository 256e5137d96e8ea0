//! Solution of tasks of several levels that cannot all be met: least error of the lowest level, then of the next among those, and so
//! on.

use super::level_descent::{Errors, LevelDescent, LevelPoint};
use crate::ik::attempt::Attempt;
use crate::ik::solution::{Nearest, Solution};
use crate::ik::whole_turns::bring_near;
use crate::objective::{Differentiable, Point};
use crate::problem::Problem;
use crate::solver::{Evaluator, LevenbergMarquardt, Status, Stop, run};
use crate::task::Levels;

/// Scattered starts in a row, none of which leads to less, after which the search ends.
const PATIENCE: usize = 16;

/// Fraction of the joints that a start near the best configuration draws anew.
const REDRAWN: f64 = 0.4;

/// Evaluation budget of the descent from such a start to the lowest level.
const TO_LOWEST: usize = 40;

/// Difference of two errors (m, rad) that counts as none.
const SAME: f64 = 1e-7;
/// Relative difference that counts as none, on top of it.
const RELATIVE: f64 = 1e-6;

/// Returns the solution in place of `missed`, which did not meet all targets; `missed` itself for tasks without levels.
#[cold]
pub(in crate::ik) fn level_solution(
    attempt: &mut Attempt<'_, '_>,
    missed: Solution,
    start: Option<&[f64]>,
) -> Solution {
    if !attempt.context.has_levels() || attempt.budget.is_spent() {
        return missed;
    }
    let levels = Levels::of(&attempt.problem.aims());
    let points = least_of(attempt, &levels, &missed.q, start);
    chosen(attempt, &levels, points, missed, start)
}

/// Starts that are known: the caller's, the miss and, unless that meets the lowest level, what the solver finds for it alone.
fn known_starts(
    attempt: &mut Attempt<'_, '_>,
    lowest: &mut Problem<'_>,
    missed: &Point,
    start: Option<&[f64]>,
) -> Vec<Point> {
    let context = attempt.context;
    let mut starts: Vec<Point> = start.map(Point::from_slice).into_iter().collect();
    starts.push(missed.clone());
    let is_open = !lowest.assess(missed).score.solved && lowest.reach_shortfall(context.bounds()).is_none();
    if is_open {
        let rest = attempt.budget.rest(attempt.budget.left() / 2);
        let objective: &mut dyn Differentiable = lowest;
        let mut evaluator = Evaluator::new(objective, context.bounds(), rest, attempt.rng, attempt.monitor);
        context.solver().run(&mut evaluator, start.unwrap_or(missed));
        attempt.budget.add(&evaluator);
        // Without a budget nothing was evaluated, and there is no best point.
        if evaluator.evaluations() > 0 {
            starts.push(Point::from_slice(&evaluator.best().x));
        }
    }
    starts
}

/// Writes another start into `q`, near the lowest level: scattered or, if given, with some joints of `best` drawn anew.
fn write_start(attempt: &mut Attempt<'_, '_>, lowest: &mut Problem<'_>, best: Option<&Point>, q: &mut Point) {
    let context = attempt.context;
    match best {
        None => attempt.next_start(q),
        Some(best) => {
            let [lower, upper] = context.sampling_ranges();
            for (j, q) in q.iter_mut().enumerate() {
                let is_redrawn = attempt.rng.uniform_in(0.0, 1.0) < REDRAWN;
                *q = if is_redrawn { attempt.rng.uniform_in(lower[j], upper[j]) } else { best[j] };
            }
        }
    }
    let objective: &mut dyn Differentiable = lowest;
    let stop = Stop { max_evaluations: TO_LOWEST, ..Stop::default() };
    let mut evaluator = Evaluator::new(objective, context.bounds(), stop, attempt.rng, attempt.monitor);
    run(&LevenbergMarquardt::default(), &mut evaluator, q);
    attempt.budget.add(&evaluator);
    q.copy_from_slice(&evaluator.best().x);
}

/// Descends from all starts, and returns the points with the least errors, level by level.
fn least_of(attempt: &mut Attempt<'_, '_>, levels: &Levels, missed: &Point, start: Option<&[f64]>) -> Vec<LevelPoint> {
    let context = attempt.context;
    let mut lowest = Problem::of_configuration(context.robot(), levels.aims(0), None);
    let known = known_starts(attempt, &mut lowest, missed, start);
    let mut descent = LevelDescent::new(context.robot(), levels, context.bounds(), 0).within(context.space());
    let (mut points, mut best): (Vec<LevelPoint>, Option<LevelPoint>) = (vec![], None);
    let (mut number, mut idle, mut q) = (0, 0, missed.clone());
    while idle < PATIENCE {
        let is_over = attempt.budget.left() < TO_LOWEST + levels.len() || attempt.budget.is_spent();
        if is_over || !points.is_empty() && !attempt.monitor.keep_going() {
            break;
        }
        match known.get(number) {
            Some(start) => q.copy_from_slice(start),
            None => {
                let near = best.as_ref().filter(|_| number % 2 == 0).map(|best| &best.q);
                write_start(attempt, &mut lowest, near, &mut q);
                attempt.budget.restarts += 1;
                idle += 1;
            }
        }
        number += 1;
        (descent.evaluations, descent.until) = (0, attempt.budget.left());
        let point = descent.descend(&q, best.as_ref().map(|best| &best.errors));
        attempt.budget.evaluations += descent.evaluations;
        if context.space().is_some_and(|space| !space.holds(&point.q)) {
            continue;
        }
        if best.as_ref().is_none_or(|best| is_less(&point.errors, &best.errors)) {
            (best, idle) = (Some(point.clone()), 0);
        }
        points.push(point);
    }
    for k in 0..levels.len() {
        let error = |point: &LevelPoint| point.errors[k].sqrt();
        let least = points.iter().map(error).fold(f64::INFINITY, f64::min);
        points.retain(|point| error(point) <= least * (1.0 + RELATIVE) + SAME);
    }
    points
}

/// Whether the first level whose errors differ has less in `one`.
fn is_less(one: &Errors, other: &Errors) -> bool {
    let differ = |(a, b): (&f64, &f64)| {
        let [a, b] = [a.sqrt(), b.sqrt()];
        ((a - b).abs() > RELATIVE * b + SAME).then_some(a < b)
    };
    one.iter().zip(other).find_map(differ).unwrap_or(false)
}

/// Returns the one of `points` that the caller prefers, or `missed` without any.
fn chosen(
    attempt: &mut Attempt<'_, '_>,
    levels: &Levels,
    mut points: Vec<LevelPoint>,
    missed: Solution,
    start: Option<&[f64]>,
) -> Solution {
    let context = attempt.context;
    let robot = context.robot();
    let preference = context.preference(start);
    let reference = preference.reference();
    points.iter_mut().for_each(|point| bring_near(robot, context.bounds(), &reference, &mut point.q));
    let Some(q) = preference.nearest(points.iter().map(|point| &point.q[..])) else { return missed };
    let q = Point::from_slice(q);
    let status = match (attempt.problem.assess(&q).score.solved, levels.lowest_is_met(robot, &q)) {
        (true, _) => Status::Solved,
        (false, true) => Status::LevelGivenUp,
        (false, false) if missed.status == Status::InCollision => return missed,
        (false, false) => missed.status,
    };
    let mut solution = attempt.explained(status, q);
    if status != Status::Solved {
        let limits = std::mem::take(&mut solution.obstruction);
        let parts = [levels.in_words(robot, &solution.q), limits];
        solution.obstruction = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ");
    }
    if let Some(space) = context.space().filter(|_| !context.options().nearest_later) {
        solution.nearest = Some(Box::new(Nearest::at(space, &solution.q)));
    }
    solution
}
