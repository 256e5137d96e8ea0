//! Clear solutions by searches from many starts.

use super::clear_search::{ClearSearch, Exhausted, Found};
use crate::ik::solution::Solution;
use crate::objective::Point;
use crate::solver::Status;

/// Consecutive blocked solutions after which the search ends.
const PATIENCE: usize = 100;

impl ClearSearch<'_, '_, '_> {
    /// Searches from `x0`, then from other starts, until a solution is clear. The error is the result without one.
    pub(super) fn by_restarts(&mut self, mut x0: Point) -> Found {
        for _ in 0..PATIENCE {
            let solution = self.attempt.solve_from(&x0);
            if solution.status != Status::Solved {
                self.remember_reached(&solution.q);
                return Err(self.missed(solution));
            }
            if let Some(q) = self.cleared(solution.q.clone()) {
                return Ok(q);
            }
            if !self.attempt.monitor.keep_going() {
                return Err(self.in_collision_or(solution, Exhausted::Interrupted));
            }
            if self.is_hopeless() || self.attempt.budget.is_spent() {
                return Err(self.missed(solution));
            }
            self.attempt.next_start(&mut x0);
        }
        let reached = self.attempt.solution(Status::Stalled, x0);
        Err(self.missed(reached))
    }

    /// Remembers `q` if it solves the target but is blocked; derivative-free solvers may end at such a point.
    fn remember_reached(&mut self, q: &Point) {
        if self.attempt.problem.assess(q).score.solved {
            self.is_clear(q);
        }
    }

    /// Result of a search that ended with `last`, which is not clear.
    fn missed(&self, last: Solution) -> Box<Solution> {
        match last.status {
            Status::OutOfReach | Status::Interrupted => Box::new(last),
            _ => self.in_collision_or(last, Exhausted::Tried),
        }
    }
}
