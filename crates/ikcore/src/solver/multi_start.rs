//! The one multi-start: any solver, begun again elsewhere when it stalls or its attempt is hopeless.

use super::conduct::Conduct;
use super::driver::Solver;
use super::evaluator::{Evaluator, Halt};
use crate::error::{Error, Result};
use crate::objective::{Objective, Point};

/// When to begin again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestartRule {
    /// Starts in all, the caller's included.
    pub max_starts: usize,
    /// An attempt is abandoned when this many steps lower its best value by less than the factor `min_reduction`.
    pub patience: usize,
    /// See `patience`.
    pub min_reduction: f64,
}

impl RestartRule {
    /// As many starts as the budget allows, each given up when `patience` steps do not halve its value.
    pub fn with_patience(patience: usize) -> Self {
        Self { max_starts: usize::MAX, patience, min_reduction: 2.0 }
    }
}

/// A solver and the rule by which it begins again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultiStart<S> {
    /// What runs from each start.
    pub solver: S,
    /// When to begin again.
    pub rule: RestartRule,
}

impl<S> MultiStart<S> {
    /// Checks the options of the rule.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        let RestartRule { max_starts, patience, min_reduction } = self.rule;
        for (name, count) in [("max_starts", max_starts), ("patience", patience)] {
            if count == 0 {
                return Err(Error::out_of_range(name, "at least 1", 0.0));
            }
        }
        if !(min_reduction >= 1.0 && min_reduction.is_finite()) {
            return Err(Error::out_of_range("min_reduction", "at least 1 and finite", min_reduction));
        }
        Ok(())
    }
}

/// The running attempt.
#[derive(Debug, Clone)]
pub struct State<T> {
    inner: T,
    steps: usize,
    /// Best value of the attempt when `steps` was last a multiple of the patience.
    milestone: f64,
}

impl<O: Objective + ?Sized, S: Solver<O>> Solver<O> for MultiStart<S> {
    type State = State<S::State>;

    fn conduct(&self) -> Conduct {
        self.solver.conduct()
    }

    fn start(&self, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<Self::State, Halt> {
        let inner = self.solver.start(evaluator, x0)?;
        Ok(State { inner, steps: 0, milestone: evaluator.attempt_value() })
    }

    fn step(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Halt> {
        match self.solver.step(&mut state.inner, evaluator) {
            Ok(()) if !self.hopeless(state, evaluator.attempt_value()) => Ok(()),
            Ok(()) | Err(Halt::Stalled | Halt::OutsideBox) => self.restart(state, evaluator),
            halt => halt,
        }
    }
}

impl<S> MultiStart<S> {
    fn hopeless<T>(&self, state: &mut State<T>, value: f64) -> bool {
        state.steps += 1;
        if !state.steps.is_multiple_of(self.rule.patience) {
            return false;
        }
        let hopeless = value * self.rule.min_reduction > state.milestone || value == f64::INFINITY;
        state.milestone = value;
        hopeless
    }

    fn restart<O>(&self, state: &mut State<S::State>, evaluator: &mut Evaluator<'_, O>) -> Result<(), Halt>
    where
        O: Objective + ?Sized,
        S: Solver<O>,
    {
        evaluator.check_solved()?;
        if evaluator.attempts() >= self.rule.max_starts {
            return Err(Halt::Stalled);
        }
        let mut x = Point::from_elem(0.0, evaluator.dimension());
        evaluator.next_attempt(&mut x);
        self.solver.restart(&mut state.inner, evaluator, &x)?;
        (state.steps, state.milestone) = (0, evaluator.attempt_value());
        Ok(())
    }
}
