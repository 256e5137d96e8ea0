//! Search over branches and curves of solutions for [`Prefer::Best`](crate::ik::Prefer::Best).
//!
//! The self-motion of a target may have several branches, and each branch several local optima of the goals.

use super::arcs::Candidate;
use super::branch_flip::flips;
use super::curve_tracing::{CurveTracer, Visit};
use crate::ik::attempt::Attempt;
use crate::ik::solution::Solution;
use crate::ik::whole_turns::bring_near;
use crate::objective::{Bounds, Objective, Point};
use crate::solver::Status;
use crate::task::Goals;

/// Consecutive solutions without improvement, or on known curves, after which the search ends.
const PATIENCE: usize = 40;

/// Evaluations without a new curve after which the search ends: near the end of the reach most starts fail, each after many
/// evaluations.
const PATIENCE_FOR_CURVES: usize = 1200;

/// Largest squared error of a branch flip from which the search starts.
const NEAR: f64 = 0.1;

/// Largest difference of costs that count as equal.
const SAME: f64 = 1e-9;

/// Returns the solution with the least cost found until [`PATIENCE`] consecutive solutions, or [`PATIENCE_FOR_CURVES`]
/// evaluations, bring nothing new; the best miss if there is no solution.
pub(in crate::ik) fn best_solution(attempt: &mut Attempt<'_, '_>, start: Option<&[f64]>) -> Solution {
    let context = attempt.context;
    let x0 = attempt.first_start(start);
    let first = attempt.solve_from(&x0);
    if first.status != Status::Solved {
        return first;
    }
    let mut search = BestSearch {
        attempt,
        start,
        goals: context.goals().clone(),
        tracer: CurveTracer::new(context.robot(), context.bounds()),
        bounds: context.bounds().clone(),
        flipped: Vec::new(),
        best: (f64::INFINITY, first.q.clone()),
        patience: usize::MAX,
    };
    let status = search.go_on_from(first.q);
    let (_, best) = search.best;
    search.attempt.solution(status, best)
}

/// Search for a better solution than the best so far.
struct BestSearch<'s, 'm, 'p> {
    attempt: &'s mut Attempt<'m, 'p>,
    goals: Goals,
    start: Option<&'s [f64]>,
    tracer: CurveTracer<'p>,
    /// Box of the search: the limits, or unbounded once a curve was found, on which limits do not matter.
    bounds: Bounds,
    /// Branch flips of solutions, as starts.
    flipped: Vec<Point>,
    best: (f64, Point),
    /// Evaluations left before something new must be found.
    patience: usize,
}

impl BestSearch<'_, '_, '_> {
    /// Continues from the solution `q` and from other starts until nothing new is found.
    fn go_on_from(&mut self, mut q: Point) -> Status {
        self.improve(q.clone());
        let mut nothing_new = 0;
        while nothing_new < PATIENCE && !self.attempt.budget.is_spent() {
            nothing_new = if self.is_new(&q) { 0 } else { nothing_new + 1 };
            // Polls here too, since searches may be too short to poll.
            if !self.attempt.monitor.keep_going() {
                return Status::Interrupted;
            }
            let x0 = self.next_start();
            let left = self.attempt.budget.left();
            let reserve = left.saturating_sub(self.patience);
            let (status, found) = self.attempt.search(&self.bounds, &x0, reserve);
            self.patience = self.patience.saturating_sub(left - self.attempt.budget.left());
            match status {
                Status::Solved => q = found,
                Status::Interrupted => return status,
                _ => break,
            }
        }
        Status::Solved
    }

    /// Next branch flip near the target, else a random start.
    fn next_start(&mut self) -> Point {
        while self.attempt.budget.left() > 0
            && let Some(q) = self.flipped.pop()
        {
            self.attempt.budget.evaluations += 1;
            if self.attempt.problem.evaluate(&q).value < NEAR {
                return q;
            }
        }
        let mut x0 = Point::from_elem(0.0, self.attempt.problem.dimension());
        self.attempt.next_start(&mut x0);
        x0
    }

    /// Visits the solution `q` and the curve through it, if there is one. Returns whether that found anything new.
    fn is_new(&mut self, q: &Point) -> bool {
        let left = self.attempt.budget.left();
        let visit = self.tracer.visit(self.attempt.problem, &mut self.goals, q, left);
        self.attempt.budget.evaluations += self.tracer.take_evaluations();
        match visit {
            Visit::Known => false,
            Visit::NoCurve => self.improve(q.clone()),
            Visit::Curve(candidates) => {
                for Candidate { cost, q } in candidates {
                    if cost > self.best.0 - SAME {
                        break;
                    }
                    self.improve(q);
                }
                if self.attempt.context.solver().restarted_descent().is_some() {
                    let (lower, upper) = self.bounds.parts_mut();
                    lower.fill(f64::NEG_INFINITY);
                    upper.fill(f64::INFINITY);
                    self.flipped.extend(flips(self.attempt.context.robot(), q));
                    self.patience = PATIENCE_FOR_CURVES;
                }
                true
            }
        }
    }

    /// Moves `q`, at or near a solution, to the nearest optimum of the goals. Returns whether it replaces the best solution.
    fn improve(&mut self, mut q: Point) -> bool {
        let context = self.attempt.context;
        let robot = context.robot();
        if let Some(start) = self.start {
            bring_near(robot, context.bounds(), start, &mut q);
        }
        if !self.attempt.descend_goals(&mut self.goals, &mut q) {
            return false;
        }
        let cost = self.goals.cost(robot, None, &q, &mut q.clone());
        let is_better = cost < self.best.0 - SAME;
        if is_better {
            self.best = (cost, q);
        }
        is_better
    }
}
