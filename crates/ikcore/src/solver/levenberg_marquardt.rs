//! Levenberg-Marquardt on a box: damping in proportion to the squared error, so that far targets get careful steps and
//! near ones converge quadratically. A step is kept only where the value falls.

use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::error::{Error, Result, require_positive};
use crate::math::box_step::BoxStep;
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
    descent: Descent,
    /// One for the point, one for the trial; `here` says which is which.
    linearizations: [Linearization; 2],
    here: usize,
}

/// The value at the point that the descent has come to, and how carefully it goes on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Descent {
    value: f64,
    damping: f64,
}

/// What becomes of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It is where the descent goes on.
    Kept,
    /// It is where the descent ends: it gained next to nothing.
    KeptAtLast,
    /// The next trial is nearer.
    Refused,
    /// There is none nearer that makes a difference.
    RefusedAtLast,
}

impl Verdict {
    /// Whether the trial becomes the point.
    pub fn keeps(self) -> bool {
        matches!(self, Self::Kept | Self::KeptAtLast)
    }

    /// # Errors
    /// [`Status::Stalled`] where the descent is at its end.
    pub fn goes_on(self) -> Result<(), Status> {
        match self {
            Self::Kept | Self::Refused => Ok(()),
            Self::KeptAtLast | Self::RefusedAtLast => Err(Status::Stalled),
        }
    }
}

impl LevenbergMarquardt {
    /// A descent from a point of this value.
    #[inline]
    pub(super) fn descent_from(&self, value: f64) -> Descent {
        Descent { value, damping: self.initial_damping }
    }

    /// What becomes of a trial with `value`.
    #[inline]
    pub(super) fn judge(&self, descent: &mut Descent, value: f64) -> Verdict {
        let Descent { value: before, damping } = descent;
        if !(value < *before) {
            *damping *= self.increase;
            return if *damping > LARGEST_DAMPING { Verdict::RefusedAtLast } else { Verdict::Refused };
        }
        let gain = 1.0 - value / *before;
        *damping = (*damping * self.decrease).max(SMALLEST_DAMPING);
        *before = value;
        if gain < self.min_gain { Verdict::KeptAtLast } else { Verdict::Kept }
    }
}

impl Descent {
    /// The damping of the next step.
    ///
    /// # Errors
    /// [`Status::Stalled`] where the value says nothing.
    #[inline]
    pub fn lambda(&self) -> Result<f64, Status> {
        if self.value.is_finite() { Ok(self.damping * self.value) } else { Err(Status::Stalled) }
    }
}

impl<O: LeastSquares + ?Sized> Solver<O> for LevenbergMarquardt {
    type State = State;

    fn start(&self, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<State, Status> {
        let mut x = Point::from_slice(x0);
        let mut linearizations = [Linearization::default(), Linearization::default()];
        let value = evaluator.linearize(&mut x, &mut linearizations[0])?;
        Ok(State { x, descent: self.descent_from(value), linearizations, here: 0 })
    }

    fn restart(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let State { x, descent, linearizations, here } = state;
        x.copy_from_slice(x0);
        *descent = self.descent_from(evaluator.linearize(x, &mut linearizations[*here])?);
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { x, descent, linearizations, here } = state;
        let (bounds, lambda) = (evaluator.bounds(), descent.lambda()?);
        let mut trial = Point::from_slice(x);
        let Linearization { columns, residual } = &linearizations[*here];
        let (lower, upper) = (bounds.lower(), bounds.upper());
        BoxStep { columns, residual, lambda, x, lower, upper }.write(&mut trial);
        if trial == *x {
            return Err(Status::Stalled);
        }
        let value = evaluator.linearize(&mut trial, &mut linearizations[1 - *here])?;
        let verdict = self.judge(descent, value);
        if verdict.keeps() {
            // Entries in use only: a point has room for many more.
            x.copy_from_slice(&trial);
            *here = 1 - *here;
        }
        verdict.goes_on()
    }
}
