//! Multi-start: restarts any solver that stalls or makes too little progress.

use super::domain::Domain;
use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::error::{Error, Result, require_at_least_one};
use crate::objective::{Objective, Point};

/// Rule for abandoning an attempt and restarting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestartRule {
    /// Total number of starts, including the caller's.
    pub max_starts: usize,
    /// Number of steps that must lower the best value by the factor `min_reduction`, or the attempt is abandoned.
    pub patience: usize,
    /// Factor by which `patience` steps must lower the best value.
    pub min_reduction: f64,
}

impl RestartRule {
    /// Rule with as many starts as the budget allows, each abandoned if `patience` steps do not halve its best value.
    pub fn with_patience(patience: usize) -> Self {
        Self { max_starts: usize::MAX, patience, min_reduction: 2.0 }
    }
}

/// Solver with restarts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultiStart<S> {
    /// Solver that runs from each start.
    pub solver: S,
    /// Rule for restarts.
    pub rule: RestartRule,
}

impl<S> MultiStart<S> {
    /// Checks the options of the rule.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        let RestartRule { max_starts, patience, min_reduction } = self.rule;
        require_at_least_one("max_starts", max_starts)?;
        require_at_least_one("patience", patience)?;
        if !(min_reduction >= 1.0 && min_reduction.is_finite()) {
            return Err(Error::out_of_range("min_reduction", "at least 1 and finite", min_reduction));
        }
        Ok(())
    }
}

/// State of the running attempt.
#[derive(Debug, Clone, Default)]
pub struct State<T> {
    inner: T,
    attempt: AttemptProgress,
}

/// Progress of an attempt.
#[derive(Debug, Clone, Copy, Default)]
struct AttemptProgress {
    steps: usize,
    /// Best value when `steps` was last a multiple of the patience.
    milestone: f64,
}

impl AttemptProgress {
    /// Progress of an attempt that starts at a point with this value.
    fn begun_at(value: f64) -> Self {
        Self { steps: 0, milestone: value }
    }
}

impl RestartRule {
    /// Counts a step of the attempt. Returns whether to abandon it, given its best `value` so far.
    #[inline]
    fn abandons(&self, attempt: &mut AttemptProgress, value: f64) -> bool {
        attempt.steps += 1;
        if !attempt.steps.is_multiple_of(self.patience) {
            return false;
        }
        let hopeless = value * self.min_reduction > attempt.milestone || value == f64::INFINITY;
        attempt.milestone = value;
        hopeless
    }

    /// Returns whether to restart after `step`.
    ///
    /// # Errors
    /// The status of a step that ended the run.
    #[inline]
    fn begins_again(
        &self,
        step: Result<(), Status>,
        attempt: &mut AttemptProgress,
        value: f64,
    ) -> Result<bool, Status> {
        match step {
            Ok(()) => Ok(self.abandons(attempt, value)),
            Err(Status::Stalled | Status::OutsideLimits) => Ok(true),
            Err(halt) => Err(halt),
        }
    }

    /// Returns the start of the next attempt.
    ///
    /// # Errors
    /// [`Status::Solved`] after an attempt that solved it, [`Status::Stalled`] after the last one.
    fn next_start<O>(&self, evaluator: &mut Evaluator<'_, O>) -> Result<Point, Status>
    where
        O: Objective + ?Sized,
    {
        evaluator.check_solved()?;
        if evaluator.attempts() >= self.max_starts {
            return Err(Status::Stalled);
        }
        let mut x = Point::from_elem(0.0, evaluator.dimension());
        evaluator.next_attempt(&mut x);
        Ok(x)
    }
}

impl<O: Objective + ?Sized, S: Solver<O>> Solver<O> for MultiStart<S> {
    type State = State<S::State>;

    fn domain(&self) -> Domain {
        self.solver.domain()
    }

    fn has_own_threshold(&self) -> bool {
        self.solver.has_own_threshold()
    }

    fn start(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        self.solver.start(&mut state.inner, evaluator, x0)?;
        state.attempt = AttemptProgress::begun_at(evaluator.attempt_value());
        Ok(())
    }

    fn step(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let step = self.solver.step(&mut state.inner, evaluator);
        if self.rule.begins_again(step, &mut state.attempt, evaluator.attempt_value())? {
            let x = self.rule.next_start(evaluator)?;
            self.start(state, evaluator, &x)?;
        }
        Ok(())
    }
}
