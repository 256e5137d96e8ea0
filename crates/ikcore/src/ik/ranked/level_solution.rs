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

/// Scattered starts of the descents.
const STARTS: usize = 12;

/// Evaluation budget of the descent from such a start to the lowest level.
const TO_LOWEST: usize = 40;

/// Difference of an error (m, rad), and relative one, that count as none.
const SAME: f64 = 1e-7;
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
    let seeds = seeds(attempt, &levels, &missed.q, start);
    let points = least_of(attempt, &levels, &seeds);
    chosen(attempt, &levels, points, missed, start)
}

/// Starts that are near the lowest level: by the solver, from the miss, from the caller's start, and from scattered ones.
fn seeds(attempt: &mut Attempt<'_, '_>, levels: &Levels, missed: &Point, start: Option<&[f64]>) -> Vec<Point> {
    let context = attempt.context;
    let mut seeds: Vec<Point> = start.map(Point::from_slice).into_iter().collect();
    seeds.push(missed.clone());
    let mut lowest = Problem::of_configuration(context.robot(), levels.aims(0), None);
    if !levels.lowest_is_met(context.robot(), missed) {
        let rest = attempt.budget.rest(attempt.budget.left() / 2);
        let objective: &mut dyn Differentiable = &mut lowest;
        let mut evaluator = Evaluator::new(objective, context.bounds(), rest, attempt.rng, attempt.monitor);
        context.solver().run(&mut evaluator, start.unwrap_or(missed));
        attempt.budget.add(&evaluator);
        // Without a budget nothing was evaluated, and there is no best point.
        if evaluator.evaluations() > 0 {
            seeds.push(Point::from_slice(&evaluator.best().x));
        }
    }
    let mut x0 = attempt.first_start(None);
    for _ in 0..STARTS {
        if attempt.budget.left() < TO_LOWEST || !attempt.monitor.keep_going() {
            break;
        }
        let objective: &mut dyn Differentiable = &mut lowest;
        let stop = Stop { max_evaluations: TO_LOWEST, ..Stop::default() };
        let mut evaluator = Evaluator::new(objective, context.bounds(), stop, attempt.rng, attempt.monitor);
        run(&LevenbergMarquardt::default(), &mut evaluator, &x0);
        attempt.budget.add(&evaluator);
        seeds.push(Point::from_slice(&evaluator.best().x));
        attempt.next_start(&mut x0);
    }
    seeds
}

/// Descends from the seeds, and returns the points with the least errors, level by level.
fn least_of(attempt: &mut Attempt<'_, '_>, levels: &Levels, seeds: &[Point]) -> Vec<LevelPoint> {
    let context = attempt.context;
    let descent = LevelDescent::new(context.robot(), levels, context.bounds(), attempt.budget.left());
    let mut descent = descent.within(context.space());
    let mut points: Vec<LevelPoint> = vec![];
    let mut best: Option<Errors> = None;
    for seed in seeds {
        if descent.evaluations >= descent.until || !points.is_empty() && !attempt.monitor.keep_going() {
            break;
        }
        let point = descent.descend(seed, best.as_ref());
        if context.space().is_some_and(|space| !space.holds(&point.q)) {
            continue;
        }
        if best.as_ref().is_none_or(|best| point.errors < *best) {
            best = Some(point.errors.clone());
        }
        points.push(point);
    }
    attempt.budget.evaluations += descent.evaluations;
    for k in 0..levels.len() {
        let error = |point: &LevelPoint| point.errors[k].sqrt();
        let least = points.iter().map(error).fold(f64::INFINITY, f64::min);
        points.retain(|point| error(point) <= least * (1.0 + RELATIVE) + SAME);
    }
    points
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
