//! Newton-Raphson: full steps by the pseudo-inverse of the Jacobian. It is fast when it converges, but may overshoot or cycle
//! until its budget is spent.

use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::error::{Result, require_factor};
use crate::objective::{LeastSquares, Linearization, Point};

/// Options of Newton-Raphson.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonRaphson {
    /// Fraction of the full step to take, above 0 and at most 1.
    pub step_fraction: f64,
}

impl Default for NewtonRaphson {
    fn default() -> Self {
        Self { step_fraction: 1.0 }
    }
}

impl NewtonRaphson {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        require_factor("step_fraction", self.step_fraction)
    }
}

/// State of the iteration between steps.
#[derive(Debug, Clone, Default)]
pub struct State {
    x: Point,
    value: f64,
    linearization: Linearization,
}

impl<O: LeastSquares + ?Sized> Solver<O> for NewtonRaphson {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let State { x, value, linearization } = state;
        *x = Point::from_slice(x0);
        *value = evaluator.linearize(x, linearization)?;
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { x, value, linearization } = state;
        if !value.is_finite() {
            return Err(Status::Stalled);
        }
        let bounds = evaluator.bounds();
        linearization.blocks_mut().for_each(|block| block.residual = block.residual.map(|r| self.step_fraction * r));
        let mut next = x.clone();
        linearization.write_step(0.0, x, [bounds.lower(), bounds.upper()], &mut next);
        if next == *x {
            return Err(Status::Stalled);
        }
        *value = evaluator.linearize(&mut next, linearization)?;
        *x = next;
        Ok(())
    }
}
