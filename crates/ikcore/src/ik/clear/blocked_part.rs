//! Result where a part of the target can be met, but only in collision.

use super::clear_search::{ClearSearch, Exhausted};
use crate::ik::attempt::Attempt;
use crate::ik::solution::Solution;
use crate::objective::Point;

/// Returns the one of `configurations`, which meet a part of the target and are not clear, that is least deep in collision, with the
/// status [`InCollision`](crate::solver::Status::InCollision).
pub(in crate::ik) fn in_collision_at(attempt: &mut Attempt<'_, '_>, configurations: &[Point]) -> Option<Solution> {
    let space = attempt.context.space()?;
    let mut search = ClearSearch::new(attempt, space);
    search.note_partial(configurations);
    search.in_collision(Exhausted::Tried).map(|solution| *solution)
}
