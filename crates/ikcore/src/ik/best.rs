//! Of several solutions, the one that serves the goals best: the self-motion of a target may have several branches, and
//! on each of them several places where nothing near is better.

use super::nearest::bring_near;
use super::prepared::Prepared;
use super::round::{Round, Visit};
use super::run::Run;
use super::solution::Solution;
use crate::objective::{Objective, Point};
use crate::problem::Problem;
use crate::rng::LazyRng;
use crate::solver::{Monitor, Status};
use crate::task::{Goals, Target};

/// Solutions in a row that are no better, or on curves known already, before the search is over.
const PATIENCE: usize = 40;

/// Costs that differ by less are the same.
const SAME: f64 = 1e-9;

/// The best of the solutions so far, and its cost.
type Best = Option<(f64, Point)>;

impl Prepared<'_> {
    /// The solution with the least cost among those found until [`PATIENCE`] of them in a row brought nothing new; the best
    /// miss where there is none. Where solutions form curves, each curve is followed once, and its best places are gone on
    /// from.
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
        let mut round = Round::new(self.robot(), self.bounds());
        let (mut best, mut nothing_new) = (None, 0);
        let mut x0 = Point::from_elem(0.0, self.robot().dof());
        match start {
            Some(q) => x0.copy_from_slice(q),
            None => problem.propose_start(0, self.bounds(), rng, &mut x0),
        }
        let solution = loop {
            let solution = run.attempt(self, &mut problem, &x0, rng, monitor);
            if solution.status != Status::Solved {
                break solution;
            }
            let visit = round.visit(&mut problem, &mut goals, &solution.q, run.left());
            run.count(round.take_evaluations());
            let is_new = match visit {
                Visit::Known => false,
                Visit::Curve(places) => {
                    places.into_iter().for_each(|place| {
                        self.improve(&mut best, place, start, &mut problem, &mut goals, &mut run);
                    });
                    true
                }
                Visit::NoCurve => {
                    self.improve(&mut best, solution.q.clone(), start, &mut problem, &mut goals, &mut run)
                }
            };
            nothing_new = if is_new { 0 } else { nothing_new + 1 };
            if nothing_new == PATIENCE || run.is_spent() {
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

    /// Moves on from `q`, at or near a solution, to where the goals are best near it. Whether that is better than `best`,
    /// which it then replaces.
    fn improve(
        &self,
        best: &mut Best,
        mut q: Point,
        start: Option<&[f64]>,
        problem: &mut Problem<'_>,
        goals: &mut Goals,
        run: &mut Run,
    ) -> bool {
        if let Some(start) = start {
            bring_near(self.robot(), self.bounds(), start, &mut q);
        }
        if !self.descend_to(problem, goals, run, &mut q) {
            return false;
        }
        let cost = goals.cost(self.robot(), &q, &mut q.clone());
        let is_better = best.as_ref().is_none_or(|(least, _)| cost < least - SAME);
        if is_better {
            *best = Some((cost, q));
        }
        is_better
    }
}
