//! Of several solutions, the one that serves the goals best: the self-motion of a target may have several branches, and
//! on each of them several places where nothing near is better.

use super::nearest::bring_near;
use super::prepared::Prepared;
use super::run::Run;
use super::solution::Solution;
use crate::objective::{Objective, Point};
use crate::rng::LazyRng;
use crate::solver::{Monitor, Status};
use crate::task::Target;

/// Solutions in a row that are no better, before the search is over.
const PATIENCE: usize = 40;

/// Costs that differ by less are the same.
const SAME: f64 = 1e-9;

impl Prepared<'_> {
    /// The solution with the least cost among those found until [`PATIENCE`] of them in a row were no better; the best miss
    /// where there is none.
    pub(super) fn run_best(
        &self,
        target: &Target,
        start: Option<&[f64]>,
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Solution {
        let mut problem = self.problem(target);
        let mut goals = self.goals().clone();
        let mut run = Run::new(self.options().stop);
        let mut best: Option<(f64, Point)> = None;
        let mut no_better = 0;
        let mut x0 = Point::from_elem(0.0, self.robot().dof());
        match start {
            Some(q) => x0.copy_from_slice(q),
            None => problem.propose_start(0, self.bounds(), rng, &mut x0),
        }
        let mut gradient = x0.clone();
        let solution = loop {
            let mut solution = run.attempt(self, &mut problem, &x0, rng, monitor);
            if solution.status != Status::Solved {
                break solution;
            }
            if let Some(start) = start {
                bring_near(self.robot(), self.bounds(), start, &mut solution.q);
            }
            self.descend_to(&mut problem, &mut goals, &mut run, &mut solution.q);
            let cost = goals.cost(self.robot(), &solution.q, &mut gradient);
            if best.as_ref().is_none_or(|(least, _)| cost < least - SAME) {
                (best, no_better) = (Some((cost, solution.q.clone())), 0);
            } else {
                no_better += 1;
            }
            if no_better == PATIENCE || run.is_spent() {
                break solution;
            }
            problem.propose_start(1, self.bounds(), rng, &mut x0);
        };
        match best {
            Some((_, q)) if solution.status != Status::Interrupted => run.solution(Status::Solved, q, &problem),
            Some((_, q)) => run.solution(Status::Interrupted, q, &problem),
            None => solution,
        }
    }
}
