//! Driver loop of every solver: start, step, check.

use std::convert::Infallible;

use super::domain::Domain;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::objective::Objective;

/// Minimisation algorithm: options in `self`, progress in `State`.
pub trait Solver<O: Objective + ?Sized> {
    /// Progress of the algorithm; the default is the progress before the first start.
    type State: Default;

    /// Domain of the points; by default the box.
    fn domain(&self) -> Domain {
        Domain::Clipped
    }

    /// Whether the algorithm ends at its own threshold ([`Status::BelowThreshold`]) instead of the problem's test. The test
    /// then only decides whether the result counts as solved.
    fn has_own_threshold(&self) -> bool {
        false
    }

    /// Starts or restarts at `x0`: evaluates it first, then makes any further initial evaluations.
    ///
    /// # Errors
    /// The evaluator's [`Status`].
    fn start(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status>;

    /// Makes one iteration.
    ///
    /// # Errors
    /// The evaluator's [`Status`], or [`Status::Stalled`] by a rule of the algorithm.
    fn step(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status>;
}

impl<O: Objective + ?Sized, S: Solver<O>> Solver<O> for &S {
    type State = S::State;

    fn domain(&self) -> Domain {
        (*self).domain()
    }

    fn has_own_threshold(&self) -> bool {
        (*self).has_own_threshold()
    }

    fn start(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        (*self).start(state, evaluator, x0)
    }

    fn step(&self, state: &mut Self::State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        (*self).step(state, evaluator)
    }
}

/// Runs `solver` from `x0` to its end. Returns how it ended; the evaluator keeps the best point and the counts. A start that is
/// already solved is returned unchanged.
pub fn run<O, S>(solver: &S, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Status
where
    O: Objective + ?Sized,
    S: Solver<O>,
{
    evaluator.adopt(solver.domain(), solver.has_own_threshold());
    let Err(signal) = step_until_ended(solver, evaluator, x0);
    evaluator.final_status(signal)
}

fn step_until_ended<O, S>(solver: &S, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<Infallible, Status>
where
    O: Objective + ?Sized,
    S: Solver<O>,
{
    let mut state = S::State::default();
    solver.start(&mut state, evaluator, x0)?;
    evaluator.before_steps()?;
    loop {
        solver.step(&mut state, evaluator)?;
        evaluator.after_step()?;
    }
}
