//! Attempt at one target: runs of the solver within the target's budget, and a final descent from the best miss.

use super::budget::Budget;
use super::context::SolveContext;
use super::goal_descent::GoalDescent;
use super::preference::{Miss, Preference};
use super::solution::{Solution, SolveReport};
use crate::closed_form::{ArmConfigurations, VERIFIED};
use crate::objective::{Bounds, Differentiable, Objective, Point};
use crate::problem::Problem;
use crate::rng::LazyRng;
use crate::solver::{Evaluator, LevenbergMarquardt, Monitor, MultiStart, RestartRule, Status, Stop, Stopwatch, run};
use crate::task::{Aims, Assessment, Components, Criterion, Goals, Target, TipError, Tolerance};

/// Number of starts of the approach to a target out of reach.
pub(super) const APPROACHES: usize = 8;

/// Evaluation budget of a search that another follows.
const BRIEF: usize = 2000;

/// Evaluation budget of a descent beyond the tolerances.
const REFINEMENT: usize = 200;

/// Evaluation budget of a descent from an approximate closed form; four evaluations are usual.
const NEAR_SOLUTION: usize = 8;

/// State of solving one target.
pub(super) struct Attempt<'m, 'p> {
    pub context: &'p SolveContext<'p>,
    pub problem: &'m mut Problem<'p>,
    pub rng: &'m mut LazyRng,
    pub monitor: &'m mut dyn Monitor,
    pub budget: Budget,
}

impl<'m, 'p> Attempt<'m, 'p> {
    /// Attempt with its full budget.
    pub fn new(
        context: &'p SolveContext<'p>,
        problem: &'m mut Problem<'p>,
        rng: &'m mut LazyRng,
        monitor: &'m mut dyn Monitor,
    ) -> Self {
        let budget = Budget::new(context.options().stop, Stopwatch::start());
        Self { context, problem, rng, monitor, budget }
    }

    /// Caller's start, or the indexed configuration nearest to the target.
    pub fn first_start(&mut self, start: Option<&[f64]>) -> Point {
        if let Some(start) = start {
            return Point::from_slice(start);
        }
        let mut x0 = Point::from_elem(0.0, self.context.robot().dof());
        self.problem.propose_start(0, self.context.bounds(), self.rng, &mut x0);
        x0
    }

    /// Writes another start into `x`.
    pub fn next_start(&mut self, x: &mut [f64]) {
        self.problem.propose_start(1, self.context.bounds(), self.rng, x);
    }

    /// Runs the solver from `x0` and, after a miss, descends from its best point. A target provably out of reach is only
    /// approached.
    pub fn solve_from(&mut self, x0: &[f64]) -> Solution {
        if self.budget.left() == 0 {
            return self.explained(Status::BudgetSpent, Point::from_slice(x0));
        }
        let bounds = self.context.bounds();
        let Some(MultiStart { solver: descent, .. }) = self.context.solver().restarted_descent() else {
            let (status, q) = self.search(bounds, x0, 0);
            return self.explained(status, q);
        };
        if self.problem.reach_shortfall(bounds).is_some() {
            let q = self.approach(&descent, x0, APPROACHES, usize::MAX);
            return self.explained(Status::OutOfReach, q);
        }
        let (status, q) = self.search(bounds, x0, self.budget.reserve());
        self.finish(&descent, status, q)
    }

    /// Searches for all parts of a target that has an order: briefly, since another search follows a miss.
    pub fn solve_briefly_from(&mut self, x0: &[f64]) -> Solution {
        let bounds = self.context.bounds();
        if self.problem.reach_shortfall(bounds).is_some() {
            return self.explained(Status::OutOfReach, Point::from_slice(x0));
        }
        let reserve = self.budget.left().saturating_sub(BRIEF);
        let (status, q) = self.search(bounds, x0, reserve);
        self.explained(status, q)
    }

    /// Searches once more after a miss at `q`, for a configuration within the tolerances instead of the exact target.
    #[cold]
    pub fn solved_within_tolerance(&mut self, targets: &[Target], q: &[f64]) -> Option<Solution> {
        let tasks = self.context.tasks_beyond_tolerance()?;
        let mut problem = Problem::of_configuration(self.context.robot(), Aims { tasks: &tasks, targets }, None);
        let objective: &mut dyn Differentiable = &mut problem;
        let rest = self.budget.rest(self.budget.left().saturating_sub(BRIEF));
        let mut evaluator = Evaluator::new(objective, self.context.bounds(), rest, self.rng, self.monitor);
        let status = self.context.solver().run(&mut evaluator, q);
        self.budget.add(&evaluator);
        let found = Point::from_slice(&evaluator.best().x);
        let is_clear = || self.context.space().is_none_or(|space| space.holds(&found));
        // Without a budget nothing was evaluated, and there is no best point.
        (status == Status::Solved && is_clear()).then(|| self.solution(Status::Solved, found))
    }

    /// Runs the solver from `x0` within `bounds`, leaving `reserve` evaluations.
    pub fn search(&mut self, bounds: &Bounds, x0: &[f64], reserve: usize) -> (Status, Point) {
        let objective: &mut dyn Differentiable = self.problem;
        let mut evaluator = Evaluator::new(objective, bounds, self.budget.rest(reserve), self.rng, self.monitor);
        let status = self.context.solver().run(&mut evaluator, x0);
        self.budget.add(&evaluator);
        (status, Point::from_slice(&evaluator.best().x))
    }

    /// Runs a single start of the default solver from `x0`, by the weights of the joints; it stalls as soon as it makes too little
    /// progress.
    pub fn search_once(&mut self, x0: &[f64]) -> (Status, Point) {
        self.search_once_within(self.context.weighted_bounds(), x0)
    }

    /// Runs a single start like [`search_once`](Self::search_once) within `bounds`.
    pub fn search_once_within(&mut self, bounds: &Bounds, x0: &[f64]) -> (Status, Point) {
        let Some(MultiStart { solver, rule }) = self.context.solver().restarted_descent() else {
            return (Status::Stalled, Point::from_slice(x0));
        };
        let once = MultiStart { solver, rule: RestartRule { max_starts: 1, ..rule } };
        let objective: &mut dyn Differentiable = self.problem;
        let mut evaluator = Evaluator::new(objective, bounds, self.budget.rest(0), self.rng, self.monitor);
        let status = run(&once, &mut evaluator, x0);
        self.budget.add(&evaluator);
        (status, Point::from_slice(&evaluator.best().x))
    }

    /// Runs a single start from `x0`, by the weights of the joints, to a target itself whose tolerances are a band. Returns its end if it
    /// meets the target.
    pub fn search_once_without_band(&mut self, x0: &[f64]) -> Option<Point> {
        let (target, criterion) = self.problem.only_target().filter(|(_, criterion)| criterion.has_band())?;
        let components = criterion.components.map(|components| Components { tolerance: None, ..components });
        let exact = Criterion { components, tolerance: Tolerance::default(), ..*criterion }.into();
        let MultiStart { solver, rule } = self.context.solver().restarted_descent()?;
        let once = MultiStart { solver, rule: RestartRule { max_starts: 1, ..rule } };
        let mut problem = Problem::new(self.context.robot(), Aims::of_one(&exact, target));
        let objective: &mut dyn Differentiable = &mut problem;
        let bounds = self.context.weighted_bounds();
        let mut evaluator = Evaluator::new(objective, bounds, self.budget.rest(0), self.rng, self.monitor);
        let status = run(&once, &mut evaluator, x0);
        self.budget.add(&evaluator);
        (status == Status::Solved).then(|| Point::from_slice(&evaluator.best().x))
    }

    /// Builds the solution of a search that ended with `status` at `q`. After a miss, descends from `q` first.
    pub fn finish(&mut self, descent: &LevenbergMarquardt, status: Status, q: Point) -> Solution {
        if !matches!(status, Status::BudgetSpent | Status::Stalled) {
            return self.explained(status, q);
        }
        let (solved, q) = self.descend(descent, q);
        self.explained(if solved { Status::Solved } else { status }, q)
    }

    /// Descends once from `q` until convergence. Returns whether that solved the target, and the best point.
    pub fn descend(&mut self, descent: &LevenbergMarquardt, q: Point) -> (bool, Point) {
        self.descend_some(descent, q, usize::MAX)
    }

    /// Descends like [`descend`](Self::descend) with at most this many `evaluations`.
    pub fn descend_some(&mut self, descent: &LevenbergMarquardt, q: Point, evaluations: usize) -> (bool, Point) {
        if self.budget.is_spent() {
            return (false, q);
        }
        let (objective, bounds): (&mut dyn Differentiable, _) = (self.problem, self.context.bounds());
        let rest = self.budget.rest(self.budget.left().saturating_sub(evaluations));
        let mut evaluator = Evaluator::new(objective, bounds, rest, self.rng, self.monitor);
        run(descent, &mut evaluator, &q);
        self.budget.add(&evaluator);
        (evaluator.best().solved, Point::from_slice(&evaluator.best().x))
    }

    /// Descends once from `q` within `bounds` to the tighter of the tolerances of the only tip and `tolerance` (m, rad).
    /// Returns the best point. As a refinement of a known solution it may exceed the budget.
    pub fn descend_beyond(&mut self, descent: &LevenbergMarquardt, q: Point, tolerance: f64, bounds: &Bounds) -> Point {
        let Some((target, asked)) = self.problem.only_target() else { return q };
        let asked = *asked;
        let Tolerance { position, rotation } = asked.tolerance;
        let tighter = Tolerance { position: position.min(tolerance), rotation: rotation.min(tolerance) };
        let task = Criterion { tolerance: tighter, ..asked }.into();
        let mut problem = Problem::new(self.context.robot(), Aims::of_one(&task, target)).disregarding_turns();
        let objective: &mut dyn Differentiable = &mut problem;
        let stop = Stop { max_evaluations: REFINEMENT, ..Stop::default() };
        let mut evaluator = Evaluator::new(objective, bounds, stop, self.rng, self.monitor);
        run(descent, &mut evaluator, &q);
        self.budget.add(&evaluator);
        Point::from_slice(&evaluator.best().x)
    }

    /// Returns the best of `approaches` descents towards a target that cannot be reached, each of at most this many `evaluations`.
    pub fn approach(
        &mut self,
        descent: &LevenbergMarquardt,
        x0: &[f64],
        approaches: usize,
        evaluations: usize,
    ) -> Point {
        let mut best: Option<(f64, Point)> = None;
        let mut x = Point::from_slice(x0);
        for approach in 0..approaches {
            if approach > 0 {
                self.next_start(&mut x);
                self.budget.restarts += 1;
            }
            let (_, q) = self.descend_some(descent, x.clone(), evaluations);
            let value = self.problem.assess(&q).score.value;
            if best.as_ref().is_none_or(|(least, _)| value < *least) {
                best = Some((value, q));
            }
        }
        best.map_or(x, |(_, q)| q)
    }

    /// Approaches a target that cannot be reached, and returns the result.
    pub fn approached(&mut self, x0: &[f64], approaches: usize, evaluations: usize) -> Solution {
        let descent = self.context.solver().restarted_descent().map_or_else(Default::default, |multi| multi.solver);
        let q = self.approach(&descent, x0, approaches, evaluations);
        self.explained(Status::OutOfReach, q)
    }

    /// Moves `q` along its self-motion to the nearest optimum of `goals`. Returns false if `q` is neither at nor near a
    /// solution.
    pub fn descend_goals(&mut self, goals: &mut Goals, q: &mut Point) -> bool {
        let mut descent = GoalDescent {
            robot: self.context.robot(),
            problem: self.problem,
            goals,
            bounds: self.context.weighted_bounds(),
            space: self.context.space(),
            evaluations: 0,
            max_evaluations: self.budget.left(),
        };
        let is_solved = descent.descend(q);
        self.budget.evaluations += descent.evaluations;
        is_solved
    }

    /// Result at `q`, with the reason for a miss. Within the tolerances it is solved, even if `status` says out of reach.
    pub fn explained(&self, status: Status, q: Point) -> Solution {
        let Assessment { score, error } = self.problem.assess(&q);
        let status = if score.solved && status == Status::OutOfReach { Status::Solved } else { status };
        let mut solution = self.result(status, q, error.into());
        if status != Status::Solved {
            solution.obstruction = self.problem.obstruction(self.context.bounds(), &solution.q);
        }
        solution
    }

    /// Result at `q` if it solves the target.
    pub fn solved_at(&mut self, q: Point) -> Option<Solution> {
        let error = self.error_if_solved(&q)?;
        Some(self.result(Status::Solved, q, error))
    }

    /// Result at the preferred one of `configurations`, if it reaches the pose as well as a verified branch does.
    #[inline]
    pub fn preferred(
        &mut self,
        preference: &Preference,
        configurations: &mut ArmConfigurations,
    ) -> Result<Solution, Miss> {
        let q = preference.choose(configurations)?;
        match self.error_if_solved(&q) {
            Some(error) if error.position.max(error.rotation) <= VERIFIED => Ok(self.result(Status::Solved, q, error)),
            _ => Err(Miss::Near),
        }
    }

    /// Result of a short descent from the preferred one of `configurations`, which are approximate.
    pub fn descended_from(
        &mut self,
        preference: &Preference,
        configurations: &mut ArmConfigurations,
    ) -> Option<Solution> {
        let q = preference.choose(configurations).ok()?;
        let (is_solved, q) = self.descend_some(&LevenbergMarquardt::default(), q, NEAR_SOLUTION);
        is_solved.then(|| self.solution(Status::Solved, q))
    }

    /// Errors at `q` if it solves the target.
    #[inline]
    pub fn error_if_solved(&mut self, q: &[f64]) -> Option<TipError> {
        self.budget.evaluations += 1;
        let Assessment { score, error } = self.problem.assess(q);
        score.solved.then(|| error.into())
    }

    /// Result at `q`.
    pub fn solution(&self, status: Status, q: Point) -> Solution {
        let error = self.problem.assess(&q).error;
        self.result(status, q, error.into())
    }

    /// Result at `q` with known errors.
    #[inline]
    pub fn result(&self, status: Status, q: Point, error: TipError) -> Solution {
        let report = SolveReport {
            status,
            error,
            obstruction: String::new(),
            own_points: None,
            nearest: None,
            iterations: self.budget.iterations,
            restarts: self.budget.restarts,
            evaluations: self.budget.evaluations,
            elapsed: self.budget.elapsed(),
        };
        Solution { q, report }
    }

    /// Changes the status of a solved `solution` to [`Status::HeldInRegion`] if the region keeps the tip from the exact target.
    pub fn mark_held_in_region(&self, solution: &mut Solution) {
        if solution.status == Status::Solved
            && let Some((target, criterion)) = self.problem.only_target()
            && let Some(obstruction) = criterion.blocked_by_region(target)
            && !target.assess(self.context.robot(), &solution.q, &criterion.exact()).score.solved
        {
            (solution.status, solution.obstruction) = (Status::HeldInRegion, obstruction);
        }
    }
}
