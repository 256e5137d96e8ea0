//! Jacobian transpose method: steepest descent on r'r. Without an inverse, singular configurations are harmless; the price is
//! many small steps.

use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::error::{Result, require_positive};
use crate::math::vector::dot;
use crate::objective::{LeastSquares, Linearization, Point};

/// Length of a step along -J'r.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepSize {
    /// Minimiser of the linearised residual: |g|^2 / |J g|^2 with g = J'r (Buss 2004, Introduction to inverse kinematics,
    /// section 6, which writes it <e, JJ'e> / <JJ'e, JJ'e>).
    Auto,
    /// Constant length.
    Fixed(f64),
}

/// Options of the Jacobian transpose method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JacobianTranspose {
    /// Length of a step.
    pub step_size: StepSize,
}

impl Default for JacobianTranspose {
    fn default() -> Self {
        Self { step_size: StepSize::Auto }
    }
}

impl JacobianTranspose {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        match self.step_size {
            StepSize::Auto => Ok(()),
            StepSize::Fixed(size) => require_positive("step_size", size),
        }
    }

    fn size(&self, linearization: &Linearization, gradient: &[f64]) -> f64 {
        match self.step_size {
            StepSize::Fixed(size) => size,
            StepSize::Auto => {
                let of_tasks = linearization.blocks().map(|block| {
                    let mut change = [0.0; 6];
                    for (column, slope) in block.columns.iter().zip(gradient) {
                        change.iter_mut().zip(column).for_each(|(sum, entry)| *sum += entry * slope);
                    }
                    dot(&change, &change)
                });
                dot(gradient, gradient) / of_tasks.sum::<f64>()
            }
        }
    }
}

/// State of the descent between steps.
#[derive(Debug, Clone, Default)]
pub struct State {
    x: Point,
    value: f64,
    linearization: Linearization,
}

impl<O: LeastSquares + ?Sized> Solver<O> for JacobianTranspose {
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
        let mut next = Point::from_elem(0.0, x.len());
        linearization.gradient(&mut next);
        let size = self.size(linearization, &next);
        next.iter_mut().zip(&*x).for_each(|(next, x)| *next = x - size * *next);
        // A zero gradient makes the size NaN.
        if next.iter().any(|x| !x.is_finite()) {
            return Err(Status::Stalled);
        }
        *value = evaluator.linearize(&mut next, linearization)?;
        if next == *x {
            return Err(Status::Stalled);
        }
        *x = next;
        Ok(())
    }
}
