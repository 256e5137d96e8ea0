//! The loop: start, step, check; the same for every solver.

use super::domain::Conduct;
use super::evaluator::{Evaluator, Halt};
use super::stop::Status;
use crate::objective::Objective;

/// An algorithm: options in `self`, progress in `State`.
pub trait Solver<O: Objective + ?Sized> {
    /// What the algorithm remembers between steps.
    type State;

    /// Where it searches and what ends it; by default, inside the box and until solved.
    fn conduct(&self) -> Conduct {
        Conduct::default()
    }

    /// Evaluates the start `x0` (first of all) and whatever else the algorithm begins with.
    ///
    /// # Errors
    /// The evaluator's [`Halt`].
    fn start(&self, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<Self::State, Halt>;

    /// Begins anew at `x0`; who has large buffers writes into those of `state`.
    ///
    /// # Errors
    /// The evaluator's [`Halt`].
    fn restart(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Halt> {
        *state = self.start(evaluator, x0)?;
        Ok(())
    }

    /// One iteration.
    ///
    /// # Errors
    /// The evaluator's [`Halt`], or [`Halt::Stalled`] by the algorithm's own rule.
    fn step(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Halt>;
}

impl<O: Objective + ?Sized, S: Solver<O>> Solver<O> for &S {
    type State = S::State;

    fn conduct(&self) -> Conduct {
        (*self).conduct()
    }

    fn start(&self, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<Self::State, Halt> {
        (*self).start(evaluator, x0)
    }

    fn restart(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Halt> {
        (*self).restart(state, evaluator, x0)
    }

    fn step(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Halt> {
        (*self).step(state, evaluator)
    }
}

/// How a run ended. The best point and the counts stay with the evaluator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outcome {
    /// Why it ended.
    pub halt: Halt,
    /// Steps that were finished.
    pub iterations: usize,
}

impl Outcome {
    /// That of a run that was halted so.
    pub(super) fn of<O: Objective + ?Sized>(evaluator: &Evaluator<'_, O>, halt: Halt, iterations: usize) -> Self {
        // A budget that runs out in mid-step may have met a solution in that step.
        let halt = if evaluator.best().solved { Halt::Solved } else { halt };
        Self { halt, iterations }
    }

    /// The status of a solve that ended so.
    pub fn status(&self) -> Status {
        match self.halt {
            Halt::Solved => Status::Solved,
            Halt::BelowValue => Status::Improved,
            Halt::BelowThreshold => Status::BelowThreshold,
            Halt::OutsideBox => Status::OutsideLimits,
            Halt::Stalled => Status::Stalled,
            Halt::Budget => Status::BudgetSpent,
            Halt::Time => Status::TimeUp,
            Halt::Interrupted => Status::Interrupted,
        }
    }
}

/// Runs `solver` from `x0` until something halts it. A start that is solved already is returned untouched.
pub fn run<O: Objective + ?Sized, S: Solver<O>>(solver: &S, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Outcome {
    let mut iterations = 0;
    evaluator.adopt(solver.conduct());
    let mut until_halt = || -> Result<std::convert::Infallible, Halt> {
        let mut state = solver.start(evaluator, x0)?;
        evaluator.before_steps()?;
        loop {
            solver.step(&mut state, evaluator)?;
            iterations += 1;
            evaluator.after_step(iterations)?;
        }
    };
    let Err(halt) = until_halt();
    Outcome::of(evaluator, halt, iterations)
}
