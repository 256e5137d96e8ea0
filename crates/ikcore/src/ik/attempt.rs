//! The search for one target: attempts within a budget, and what is made of those that miss.

use super::context::Prepared;
use super::solution::Solution;
use crate::objective::{Bounds, Differentiable, Objective, Point};
use crate::problem::Problem;
use crate::problem::obstruction;
use crate::rng::LazyRng;
use crate::solver::stop::Stopwatch;
use crate::solver::{Evaluator, LevenbergMarquardt, Monitor, MultiStart, Outcome, Status, Stop, run};

/// Evaluations kept back for going on from the best miss: attempts are abandoned long before they are as near as they get.
const RESERVE: usize = 200;

/// Starts from which a target beyond the reach is approached.
const APPROACHES: usize = 8;

/// What one target has cost so far.
pub(super) struct Run {
    stop: Stop,
    stopwatch: Stopwatch,
    iterations: usize,
    restarts: usize,
    evaluations: usize,
}

impl Run {
    /// Nothing spent yet.
    pub fn new(stop: Stop) -> Self {
        Self { stop, stopwatch: Stopwatch::start(), iterations: 0, restarts: 0, evaluations: 0 }
    }

    /// Evaluations that may still be made.
    pub fn left(&self) -> usize {
        self.stop.max_evaluations.saturating_sub(self.evaluations)
    }

    /// Counts evaluations made elsewhere.
    pub fn count(&mut self, evaluations: usize) {
        self.evaluations += evaluations;
    }

    /// Whether a budget is used up.
    pub fn is_spent(&self) -> bool {
        self.left() == 0
            || self.iterations >= self.stop.max_iterations
            || self.stop.max_time.is_some_and(|limit| self.stopwatch.elapsed() >= limit)
    }

    /// One run of the solver from `x0`, and, where it missed, on from its best point; a target that is provably beyond the
    /// reach is only approached.
    pub fn attempt(
        &mut self,
        prepared: &Prepared<'_>,
        problem: &mut Problem<'_>,
        x0: &[f64],
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Solution {
        let bounds = prepared.bounds();
        let Some(MultiStart { solver: descent, .. }) = prepared.options().solver.restarted_descent() else {
            let (status, q) = self.search(prepared, problem, bounds, x0, 0, rng, monitor);
            return self.explained(status, q, prepared, problem);
        };
        if prepared.beyond_reach(problem.target()).is_some() {
            let q = self.approach(prepared, problem, &descent, x0, rng, monitor);
            return self.explained(Status::OutOfReach, q, prepared, problem);
        }
        let (status, q) = self.search(prepared, problem, bounds, x0, self.reserve(), rng, monitor);
        self.concluded(prepared, problem, &descent, (status, q), rng, monitor)
    }

    /// Evaluations to keep back from the search.
    pub fn reserve(&self) -> usize {
        if self.left() > 10 * RESERVE { RESERVE } else { 0 }
    }

    /// What a search came to; where it missed, on from its best point.
    pub fn concluded(
        &mut self,
        prepared: &Prepared<'_>,
        problem: &mut Problem<'_>,
        descent: &LevenbergMarquardt,
        (status, q): (Status, Point),
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Solution {
        if !matches!(status, Status::BudgetSpent | Status::Stalled) {
            return self.explained(status, q, prepared, problem);
        }
        let (solved, q) = self.descend(prepared, problem, descent, q, rng, monitor);
        self.explained(if solved { Status::Solved } else { status }, q, prepared, problem)
    }

    /// The solver's own run within `bounds`, leaving `reserve` evaluations.
    #[allow(clippy::too_many_arguments)]
    pub fn search(
        &mut self,
        prepared: &Prepared<'_>,
        problem: &mut Problem<'_>,
        bounds: &Bounds,
        x0: &[f64],
        reserve: usize,
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> (Status, Point) {
        let stop = self.rest(reserve);
        let objective: &mut dyn Differentiable = problem;
        let mut evaluator = Evaluator::new(objective, bounds, stop, rng, monitor);
        let outcome = prepared.options().solver.run(&mut evaluator, x0);
        self.found(&evaluator, outcome)
    }

    /// Counts a search that ended; how it ended, and its best point.
    pub fn found<O: Objective + ?Sized>(&mut self, evaluator: &Evaluator<'_, O>, outcome: Outcome) -> (Status, Point) {
        self.evaluations += evaluator.evaluations();
        self.restarts += evaluator.attempts() - 1;
        self.iterations += outcome.iterations;
        (outcome.status(), Point::from_slice(&evaluator.best().x))
    }

    /// One descent to its end from `q`: whether it solved, and the best point.
    fn descend(
        &mut self,
        prepared: &Prepared<'_>,
        problem: &mut Problem<'_>,
        descent: &LevenbergMarquardt,
        q: Point,
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> (bool, Point) {
        if self.is_spent() {
            return (false, q);
        }
        let objective: &mut dyn Differentiable = problem;
        let mut evaluator = Evaluator::new(objective, prepared.bounds(), self.rest(0), rng, monitor);
        let outcome = run(descent, &mut evaluator, &q);
        self.evaluations += evaluator.evaluations();
        self.iterations += outcome.iterations;
        (evaluator.best().solved, Point::from_slice(&evaluator.best().x))
    }

    /// The nearest of a few descents towards what cannot be reached.
    fn approach(
        &mut self,
        prepared: &Prepared<'_>,
        problem: &mut Problem<'_>,
        descent: &LevenbergMarquardt,
        x0: &[f64],
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Point {
        let mut best: Option<(f64, Point)> = None;
        let mut x = Point::from_slice(x0);
        for approach in 0..APPROACHES {
            if approach > 0 {
                problem.propose_start(approach, prepared.bounds(), rng, &mut x);
                self.restarts += 1;
            }
            let (_, q) = self.descend(prepared, problem, descent, x.clone(), rng, monitor);
            let value = problem.assess(&q).score.value;
            if best.as_ref().is_none_or(|(least, _)| value < *least) {
                best = Some((value, q));
            }
        }
        best.map_or(x, |(_, q)| q)
    }

    /// What is left of the budgets, less `reserve` evaluations.
    pub fn rest(&self, reserve: usize) -> Stop {
        Stop {
            max_evaluations: self.left() - reserve,
            max_iterations: self.stop.max_iterations.saturating_sub(self.iterations),
            max_time: self.stop.max_time.map(|limit| limit.saturating_sub(self.stopwatch.elapsed())),
            ..self.stop
        }
    }

    fn explained(&self, status: Status, q: Point, prepared: &Prepared<'_>, problem: &Problem<'_>) -> Solution {
        let mut solution = self.solution(status, q, problem);
        if status != Status::Solved {
            let beyond = prepared.beyond_reach(problem.target());
            let passed = problem.outside_region(&solution.q);
            solution.obstruction = obstruction(prepared.robot(), prepared.bounds(), &solution.q, beyond, passed);
        }
        solution
    }

    /// The result at `q`.
    pub fn solution(&self, status: Status, q: Point, problem: &Problem<'_>) -> Solution {
        Solution {
            status,
            error: problem.assess(&q).error.into(),
            obstruction: String::new(),
            iterations: self.iterations,
            restarts: self.restarts,
            evaluations: self.evaluations,
            elapsed: self.stopwatch.elapsed(),
            q,
        }
    }
}
