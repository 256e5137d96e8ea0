//! Budgets of one target over several runs of a solver.

use crate::objective::Objective;
use crate::solver::{Evaluator, Stop, Stopwatch};

/// Evaluations reserved for a final descent from the best miss: multi-start abandons attempts long before they
/// converge.
const DESCENT_RESERVE: usize = 200;

/// Budgets of one target, and the amounts spent.
pub(super) struct Budget {
    stop: Stop,
    stopwatch: Stopwatch,
    pub iterations: usize,
    pub restarts: usize,
    pub evaluations: usize,
}

impl Budget {
    /// Budget with nothing spent except the time on `stopwatch`.
    pub fn new(stop: Stop, stopwatch: Stopwatch) -> Self {
        Self { stop, stopwatch, iterations: 0, restarts: 0, evaluations: 0 }
    }

    /// Time since the first run began.
    pub fn elapsed(&self) -> std::time::Duration {
        self.stopwatch.elapsed()
    }

    /// Evaluations left.
    pub fn left(&self) -> usize {
        self.stop.max_evaluations.saturating_sub(self.evaluations)
    }

    /// Evaluations that the first search must leave.
    pub fn reserve(&self) -> usize {
        if self.left() > 10 * DESCENT_RESERVE { DESCENT_RESERVE } else { 0 }
    }

    /// Whether a budget is used up.
    pub fn is_spent(&self) -> bool {
        self.left() == 0
            || self.iterations >= self.stop.max_iterations
            || self.stop.max_time.is_some_and(|limit| self.stopwatch.elapsed() >= limit)
    }

    /// Remaining budgets without `reserve` evaluations.
    pub fn rest(&self, reserve: usize) -> Stop {
        Stop {
            max_evaluations: self.left() - reserve,
            max_iterations: self.stop.max_iterations.saturating_sub(self.iterations),
            max_time: self.stop.max_time.map(|limit| limit.saturating_sub(self.stopwatch.elapsed())),
            ..self.stop
        }
    }

    /// Adds the counts of a finished run.
    pub fn add<O: Objective + ?Sized>(&mut self, run: &Evaluator<'_, O>) {
        self.evaluations += run.evaluations();
        self.restarts += run.attempts() - 1;
        self.iterations += run.iterations();
    }
}
