//! Levenberg-Marquardt in a box. The damping is proportional to the squared error, so steps are careful far from the target and
//! converge quadratically near it. A step is accepted only if the value decreases.

use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::error::{Error, Result, require_factor, require_positive, require_proper_fraction};
use crate::objective::{LeastSquares, Linearization, Point};

/// Options of Levenberg-Marquardt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevenbergMarquardt {
    /// Damping relative to the squared error at the start: lambda = damping * r'r.
    pub initial_damping: f64,
    /// Factor on the damping after a step that did not lower the value.
    pub increase: f64,
    /// Factor on the damping after a step that lowered the value.
    pub decrease: f64,
    /// Relative decrease of the value below which the descent stalls.
    pub min_gain: f64,
}

/// Damping above which steps are too short to be useful.
const LARGEST_DAMPING: f64 = 1e8;
/// Damping below which there is no effect.
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
        require_factor("decrease", self.decrease)?;
        require_proper_fraction("min_gain", self.min_gain)
    }
}

/// State of the descent between steps.
#[derive(Debug, Clone, Default)]
pub struct State {
    x: Point,
    descent: Descent,
    /// Linearizations at the current point and at the trial; `here` is the index of the current one.
    linearizations: [Linearization; 2],
    here: usize,
}

/// Value and damping of a descent.
#[derive(Debug, Clone, Copy, Default)]
struct Descent {
    value: f64,
    damping: f64,
}

/// Decision about a trial step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TrialVerdict {
    /// Accepted; the descent continues.
    Kept,
    /// Accepted; the descent ends because the gain is negligible.
    KeptAtLast,
    /// Rejected; the next trial is shorter.
    Refused,
    /// Rejected; the descent ends because a shorter trial would make no difference.
    RefusedAtLast,
}

impl TrialVerdict {
    /// Whether the trial is accepted.
    fn keeps(self) -> bool {
        matches!(self, Self::Kept | Self::KeptAtLast)
    }

    /// Ends the descent after a last trial.
    ///
    /// # Errors
    /// [`Status::Stalled`] at the end of the descent.
    fn goes_on(self) -> Result<(), Status> {
        match self {
            Self::Kept | Self::Refused => Ok(()),
            Self::KeptAtLast | Self::RefusedAtLast => Err(Status::Stalled),
        }
    }
}

impl LevenbergMarquardt {
    /// Descent from a point with this value.
    #[inline]
    fn descent_from(&self, value: f64) -> Descent {
        Descent { value, damping: self.initial_damping }
    }

    /// Decides about a trial with `value`.
    #[inline]
    fn judge(&self, descent: &mut Descent, value: f64) -> TrialVerdict {
        let Descent { value: before, damping } = descent;
        if !(value < *before) {
            *damping *= self.increase;
            return if *damping > LARGEST_DAMPING { TrialVerdict::RefusedAtLast } else { TrialVerdict::Refused };
        }
        let gain = 1.0 - value / *before;
        *damping = (*damping * self.decrease).max(SMALLEST_DAMPING);
        *before = value;
        if gain < self.min_gain { TrialVerdict::KeptAtLast } else { TrialVerdict::Kept }
    }
}

impl Descent {
    /// Damping of the next step.
    ///
    /// # Errors
    /// [`Status::Stalled`] if the value is not finite.
    #[inline]
    fn lambda(&self) -> Result<f64, Status> {
        if self.value.is_finite() { Ok(self.damping * self.value) } else { Err(Status::Stalled) }
    }
}

impl<O: LeastSquares + ?Sized> Solver<O> for LevenbergMarquardt {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let State { x, descent, linearizations, here } = state;
        x.clear();
        x.extend_from_slice(x0);
        *descent = self.descent_from(evaluator.linearize(x, &mut linearizations[*here])?);
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { x, descent, linearizations, here } = state;
        let (bounds, lambda) = (evaluator.bounds(), descent.lambda()?);
        let mut trial = Point::from_slice(x);
        linearizations[*here].write_step(lambda, x, bounds, &mut trial);
        if trial == *x {
            return Err(Status::Stalled);
        }
        let value = evaluator.linearize(&mut trial, &mut linearizations[1 - *here])?;
        let verdict = self.judge(descent, value);
        if verdict.keeps() {
            // Copies only the entries in use: a point has capacity for many more.
            x.copy_from_slice(&trial);
            *here = 1 - *here;
        }
        verdict.goes_on()
    }
}
