//! Levenberg-Marquardt on a box: damping in proportion to the squared error, so that far targets get careful steps and
//! near ones converge quadratically. A step is kept only where the value falls.

use super::driver::Solver;
use super::evaluator::{Evaluator, Halt};
use crate::error::{Error, Result, require_positive};
use crate::math::box_step::box_step;
use crate::objective::{LeastSquares, Linearization, Point};

/// Levenberg-Marquardt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevenbergMarquardt {
    /// Damping over squared error at the start: lambda = damping * r'r.
    pub initial_damping: f64,
    /// Factor on the damping after a step that did not lower the value.
    pub increase: f64,
    /// Factor on the damping after one that did.
    pub decrease: f64,
    /// Stalled when a step lowers the value by less than this share.
    pub min_gain: f64,
}

/// Damping beyond which no step of any use is left.
const LARGEST_DAMPING: f64 = 1e8;
/// Damping below which it makes no difference.
const SMALLEST_DAMPING: f64 = 1e-6;

impl Default for LevenbergMarquardt {
    fn default() -> Self {
        Self { initial_damping: 0.05, increase: 8.0, decrease: 0.5, min_gain: 1e-6 }
    }
}

impl LevenbergMarquardt {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        require_positive("initial_damping", self.initial_damping)?;
        if !(self.increase > 1.0 && self.increase.is_finite()) {
            return Err(Error::out_of_range("increase", "above 1 and finite", self.increase));
        }
        if !(self.decrease > 0.0 && self.decrease <= 1.0) {
            return Err(Error::out_of_range("decrease", "above 0 and at most 1", self.decrease));
        }
        if !(0.0..1.0).contains(&self.min_gain) {
            return Err(Error::out_of_range("min_gain", "at least 0 and below 1", self.min_gain));
        }
        Ok(())
    }
}

/// Where the descent stands.
#[derive(Debug, Clone)]
pub struct State {
    x: Point,
    value: f64,
    damping: f64,
    /// One for the point, one for the trial; `here` says which is which.
    linearizations: [Linearization; 2],
    here: usize,
}

impl<O: LeastSquares + ?Sized> Solver<O> for LevenbergMarquardt {
    type State = State;

    fn start(&self, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<State, Halt> {
        let mut x = Point::from_slice(x0);
        let mut linearizations = [Linearization::default(), Linearization::default()];
        let value = evaluator.linearize(&mut x, &mut linearizations[0])?;
        Ok(State { x, value, damping: self.initial_damping, linearizations, here: 0 })
    }

    fn restart(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Halt> {
        let State { x, value, damping, linearizations, here } = state;
        x.copy_from_slice(x0);
        *value = evaluator.linearize(x, &mut linearizations[*here])?;
        *damping = self.initial_damping;
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Halt> {
        let State { x, value, damping, linearizations, here } = state;
        if !value.is_finite() {
            return Err(Halt::Stalled);
        }
        let bounds = evaluator.bounds();
        let mut trial = Point::from_slice(x);
        let lambda = *damping * *value;
        let Linearization { columns, residual } = &linearizations[*here];
        box_step(columns, residual, lambda, x, bounds.lower(), bounds.upper(), &mut trial);
        if trial == *x {
            return Err(Halt::Stalled);
        }
        let trial_value = evaluator.linearize(&mut trial, &mut linearizations[1 - *here])?;
        if !(trial_value < *value) {
            *damping *= self.increase;
            return if *damping > LARGEST_DAMPING { Err(Halt::Stalled) } else { Ok(()) };
        }
        let gain = 1.0 - trial_value / *value;
        *damping = (*damping * self.decrease).max(SMALLEST_DAMPING);
        // Entries in use only: a point has room for many more.
        x.copy_from_slice(&trial);
        (*value, *here) = (trial_value, 1 - *here);
        if gain < self.min_gain { Err(Halt::Stalled) } else { Ok(()) }
    }
}
