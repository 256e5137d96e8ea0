//! Clear solution with the least cost of the goals, among those found.

use super::clear_search::{ClearSearch, Exhausted, Found};
use crate::objective::Point;
use crate::solver::Status;
use crate::task::Goals;

/// Consecutive solutions without improvement after which the search ends.
const PATIENCE: usize = 40;

/// Largest difference of costs that count as equal.
const SAME: f64 = 1e-9;

impl ClearSearch<'_, '_, '_> {
    /// Searches from `start`, or an indexed configuration, then from other starts. Each solution is made clear, then descends
    /// on `goals` inside the clear space.
    pub(super) fn least_cost(&mut self, goals: &mut Goals, start: Option<&[f64]>) -> Found {
        let context = self.attempt.context;
        let mut best: Option<(f64, Point)> = None;
        let mut x0 = self.attempt.first_start(start);
        let mut no_better = 0;
        while no_better < PATIENCE {
            let solution = self.attempt.solve_from(&x0);
            if solution.status != Status::Solved {
                let missed = || self.in_collision(Exhausted::Tried).unwrap_or_else(|| Box::new(solution));
                return best.map(|(_, q)| q).ok_or_else(missed);
            }
            no_better += 1;
            if let Some(mut q) = self.cleared(solution.q) {
                if let Some(start) = start {
                    self.bring_near(start, &mut q);
                }
                self.attempt.descend_goals(goals, &mut q);
                let cost = goals.cost(context.robot(), context.space(), &q, &mut q.clone());
                if best.as_ref().is_none_or(|(least, _)| cost < least - SAME) {
                    (best, no_better) = (Some((cost, q)), 0);
                }
            }
            if self.is_hopeless() || self.attempt.budget.is_spent() || !self.attempt.monitor.keep_going() {
                break;
            }
            self.attempt.next_start(&mut x0);
        }
        match (best, self.in_collision(Exhausted::Tried)) {
            (Some((_, q)), _) => Ok(q),
            (None, Some(blocked)) => Err(blocked),
            (None, None) => Err(Box::new(self.attempt.explained(Status::Stalled, x0))),
        }
    }
}
