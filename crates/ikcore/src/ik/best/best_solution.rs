//! Of several solutions, the one that serves the goals best: the self-motion of a target may have several branches, and
//! on each of them several places where nothing near is better.

use super::arcs::Promise;
use super::branch_flip::flips;
use super::curve_tracing::{Round, Visit};
use crate::ik::attempt::Run;
use crate::ik::context::Prepared;
use crate::ik::nearest::bring_near;
use crate::ik::solution::Solution;
use crate::objective::{Bounds, Objective, Point};
use crate::problem::Problem;
use crate::rng::LazyRng;
use crate::solver::{Monitor, Status};
use crate::task::{Goals, Target};

/// Solutions in a row that are no better, or on curves known already, before the search is over.
const PATIENCE: usize = 40;

/// Evaluations in a row that may be spent on finding curves and bring no new one, before the search is over: near the end of
/// the reach most starts fail, each at length.
const PATIENCE_FOR_CURVES: usize = 1200;

/// A flip that misses the target by no more, as the weighted sum of squares, is a start.
const NEAR: f64 = 0.1;

/// Costs that differ by less are the same.
const SAME: f64 = 1e-9;

impl Prepared<'_> {
    /// The solution with the least cost among those found until [`PATIENCE`] of them in a row, or [`PATIENCE_FOR_CURVES`]
    /// evaluations, brought nothing new; the best miss where there is none.
    pub(in crate::ik) fn run_best(
        &self,
        target: &Target,
        start: Option<&[f64]>,
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Solution {
        let mut problem = self.problem(target);
        let mut run = Run::new(self.options().stop);
        let mut x0 = Point::from_elem(0.0, self.robot().dof());
        match start {
            Some(q) => x0.copy_from_slice(q),
            None => problem.propose_start(0, self.bounds(), rng, &mut x0),
        }
        let first = run.attempt(self, &mut problem, &x0, rng, monitor);
        if first.status != Status::Solved {
            return first;
        }
        let mut search = Search {
            prepared: self,
            start,
            goals: self.goals().clone(),
            round: Round::new(self.robot(), self.bounds()),
            bounds: self.bounds().clone(),
            flipped: Vec::new(),
            best: (f64::INFINITY, first.q.clone()),
            patience: usize::MAX,
            problem,
            run,
        };
        let status = search.go_on_from(first.q, rng, monitor);
        let (_, best) = search.best;
        search.run.solution(status, best, &search.problem)
    }
}

/// The search for a better solution than those found so far.
struct Search<'s, 'p> {
    prepared: &'s Prepared<'p>,
    problem: Problem<'s>,
    goals: Goals,
    start: Option<&'s [f64]>,
    run: Run,
    round: Round<'s>,
    /// Where solutions are sought: between the limits, or anywhere once curves were met, on which limits do not matter.
    bounds: Bounds,
    /// Flips of solutions, to be begun from.
    flipped: Vec<Point>,
    best: (f64, Point),
    /// Evaluations that may still be spent before something new must have come.
    patience: usize,
}

impl Search<'_, '_> {
    /// Goes on from the solution `q`, and from others, until nothing new comes.
    fn go_on_from(&mut self, mut q: Point, rng: &mut LazyRng, monitor: &mut dyn Monitor) -> Status {
        self.improve(q.clone());
        let mut nothing_new = 0;
        while nothing_new < PATIENCE && !self.run.is_spent() {
            nothing_new = if self.is_new(&q) { 0 } else { nothing_new + 1 };
            // Searches may be too short to ask.
            if !monitor.keep_going() {
                return Status::Interrupted;
            }
            let x0 = self.next_start(rng);
            let left = self.run.left();
            let reserve = left.saturating_sub(self.patience);
            let (status, found) =
                self.run.search(self.prepared, &mut self.problem, &self.bounds, &x0, reserve, rng, monitor);
            self.patience = self.patience.saturating_sub(left - self.run.left());
            match status {
                Status::Solved => q = found,
                Status::Interrupted => return status,
                _ => break,
            }
        }
        Status::Solved
    }

    /// The next flip that comes near the target, else a start from all over.
    fn next_start(&mut self, rng: &mut LazyRng) -> Point {
        while self.run.left() > 0
            && let Some(q) = self.flipped.pop()
        {
            self.run.count(1);
            if self.problem.evaluate(&q).value < NEAR {
                return q;
            }
        }
        let mut x0 = Point::from_elem(0.0, self.problem.dimension());
        self.problem.propose_start(1, self.prepared.bounds(), rng, &mut x0);
        x0
    }

    /// Looks at the solution `q` and at the curve through it, if it is on one; whether that brought anything new.
    fn is_new(&mut self, q: &Point) -> bool {
        let visit = self.round.visit(&mut self.problem, &mut self.goals, q, self.run.left());
        self.run.count(self.round.take_evaluations());
        match visit {
            Visit::Known => false,
            Visit::NoCurve => self.improve(q.clone()),
            Visit::Curve(promises) => {
                for Promise { cost, q } in promises {
                    if cost > self.best.0 - SAME {
                        break;
                    }
                    self.improve(q);
                }
                if self.prepared.options().solver.restarted_descent().is_some() {
                    let (lower, upper) = self.bounds.parts_mut();
                    lower.fill(f64::NEG_INFINITY);
                    upper.fill(f64::INFINITY);
                    self.flipped.extend(flips(self.prepared.robot(), q));
                    self.patience = PATIENCE_FOR_CURVES;
                }
                true
            }
        }
    }

    /// Moves on from `q`, at or near a solution, to where the goals are best near it. Whether that is better than the best,
    /// which it then replaces.
    fn improve(&mut self, mut q: Point) -> bool {
        let prepared = self.prepared;
        let robot = prepared.robot();
        if let Some(start) = self.start {
            bring_near(robot, prepared.bounds(), start, &mut q);
        }
        if !prepared.descend_to(&mut self.problem, &mut self.goals, &mut self.run, &mut q) {
            return false;
        }
        let cost = self.goals.cost(robot, &q, &mut q.clone());
        let is_better = cost < self.best.0 - SAME;
        if is_better {
            self.best = (cost, q);
        }
        is_better
    }
}
