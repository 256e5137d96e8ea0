//! Result of a target without a solution: the reason, and a configuration near the target.

use super::attempt::Attempt;
use super::solution::Solution;
use crate::objective::{LeastSquares, Linearization, Point};
use crate::solver::Status;
use crate::task::Assessment;

/// Steps towards the target: on six arms they end 2 to 5 % nearer, on average, than four of the default solver from an indexed
/// start.
const STEPS: usize = 2;

/// Damping of the first step, relative to the squared error.
const DAMPING: f64 = 0.3;

/// Factor on the damping after each step: most of the error cannot be removed, and larger steps would overshoot.
const INCREASE: f64 = 2.0;

/// Tolerance (m, rad) beyond which a pose without solutions, and without candidates near one, may still be reached.
const WIDE: f64 = 1e-5;

/// Whether the tolerances are so wide that a pose may be reached without a solution inside the limits or near them.
pub(super) fn is_wide(attempt: &Attempt<'_, '_>) -> bool {
    attempt.problem.only_target().is_none_or(|(_, criterion)| {
        let tolerance = criterion.tolerance;
        tolerance.position.max(tolerance.rotation) > WIDE
    })
}

/// Reason why a pose with `count` solutions, all outside the limits, cannot be reached; `None` if the count is unknown.
pub(super) fn obstruction(attempt: &Attempt<'_, '_>, count: Option<usize>) -> String {
    if let Some(beyond) = attempt.problem.reach_shortfall(attempt.context.bounds()) {
        return beyond.to_string();
    }
    match count {
        None => "no configuration inside the limits has this pose".into(),
        Some(0) => "no configuration has this pose".into(),
        Some(1) => "its one solution is outside the limits".into(),
        Some(count) => format!("all {count} solutions are outside the limits"),
    }
}

/// Result without a solution, at a configuration a few steps nearer to the target than `from`.
#[cold]
pub(super) fn unreachable_result(attempt: &mut Attempt<'_, '_>, from: Point, obstruction: String) -> Solution {
    let (q, Assessment { error, score }) = stepped_towards(attempt, from);
    if score.solved {
        return attempt.result(Status::Solved, q, error.into());
    }
    let mut solution = attempt.result(Status::OutOfReach, q, error.into());
    solution.obstruction = obstruction;
    solution
}

/// Takes a few steps of damped least squares from `q`, and returns the last one that lowered the error.
fn stepped_towards(attempt: &mut Attempt<'_, '_>, mut q: Point) -> (Point, Assessment) {
    let Attempt { context, problem, budget, .. } = attempt;
    let limits = [context.bounds().lower(), context.bounds().upper()];
    let (mut linearization, mut damping) = (Linearization::default(), DAMPING);
    let (mut next, mut least) = (Point::from_slice(&q), f64::INFINITY);
    for _ in 0..STEPS.min(budget.left()) {
        let value = problem.linearize(&next, &mut linearization).value;
        budget.evaluations += 1;
        if !(value < least) {
            break;
        }
        least = value;
        q.copy_from_slice(&next);
        linearization.write_step(damping * value, &q, limits, &mut next);
        budget.iterations += 1;
        damping *= INCREASE;
    }
    let there = problem.assess(&next);
    if there.score.value < least {
        return (next, there);
    }
    let here = problem.assess(&q);
    (q, here)
}
