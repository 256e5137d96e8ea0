//! The end of a target that has no solution: why, and a configuration near it.

use super::attempt::Attempt;
use super::solution::Solution;
use crate::solver::{LevenbergMarquardt, Status};

/// Evaluations of the descent towards the target: it ends within 3 to 8 % of what a whole descent reaches (measured on four arms).
const STEPS: usize = 4;

/// Tolerances (m, rad) beyond which a pose without solutions, and without candidates near one, may still be reached.
const WIDE: f64 = 1e-5;

/// Whether tolerances are so wide that a pose may be reached although it has no solution inside the limits, nor one near them.
pub(super) fn is_wide(attempt: &Attempt<'_, '_>) -> bool {
    attempt.problem.only_target().is_none_or(|(_, criterion)| {
        let tolerance = criterion.tolerance;
        tolerance.position.max(tolerance.rotation) > WIDE
    })
}

/// Why a pose cannot be reached that has `count` solutions, none of them inside the limits; `count` is None if that is not known.
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

/// The result where there is no solution, or none was found, with a configuration a few steps nearer to the target than the start.
#[cold]
pub(super) fn ended(
    attempt: &mut Attempt<'_, '_>,
    start: Option<&[f64]>,
    status: Status,
    obstruction: String,
) -> Solution {
    let x0 = attempt.first_start(start);
    let (_, q) = attempt.descend_some(&LevenbergMarquardt::default(), x0, STEPS);
    Solution { obstruction, ..attempt.solution(status, q) }
}
