//! Result of a target without a solution: the reason, and a configuration near the target.

use super::attempt::Attempt;
use super::solution::Solution;
use crate::objective::Point;
use crate::solver::Status;

/// Number of descents towards the target, the first from the configuration known. On four arms the better of two ends as near, in the
/// median, as many long ones.
const APPROACHES: usize = 2;

/// Maximum number of evaluations of each.
const STEPS: usize = 8;

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

/// Result without a solution, at the end of the best of a few descents, the first of them from `from`; at `from` itself where only whole
/// solutions count, or a search for the part of the pose that comes first follows.
#[cold]
pub(super) fn unreachable_result(attempt: &mut Attempt<'_, '_>, from: Point, obstruction: String) -> Solution {
    let is_ordered =
        attempt.problem.only_target().is_some_and(|(target, _)| attempt.context.comes_first(target).is_some());
    let stays = is_ordered || attempt.context.options().whole_only;
    let mut solution = attempt.approached(&from, if stays { 0 } else { APPROACHES }, STEPS);
    if solution.status != Status::Solved {
        solution.obstruction = obstruction;
    }
    solution
}
