//! Quasi-Newton method with antenna differences as secants, which needs only residuals.
//!
//! Beetle antennae search uses only the sign of a difference r(x + lambda b) - r(x). The difference itself is a secant of the
//! Jacobian, lambda J b: one antenna per entry of x gives a whole Jacobian, and every step then updates it (Broyden 1965). The
//! antennae are used again when steps are predicted badly.

use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::error::{Result, require_at_least_one, require_positive};
use crate::math::box_step::LEAST_DAMPING;
use crate::math::secant::{SecantBlocks, antenna};
use crate::objective::{Point, Residual, TaskResiduals};

/// Options of Broyden's method with antenna differences.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BroydenBas {
    /// Length of the antennae (rad, m). The displacement of the tip should be far above the sensor noise, and the
    /// length far below a radian, where the motion becomes nonlinear.
    pub antenna_length: f64,
    /// Evaluations after which a tick of a track ends; the next tick continues.
    pub max_evaluations_per_step: usize,
    /// Delay of a plant's sensor, in measurements: every command is repeated that many times, and only the last
    /// measurement is used.
    pub sensor_delay: usize,
}

impl Default for BroydenBas {
    fn default() -> Self {
        Self { antenna_length: 0.01, max_evaluations_per_step: 20, sensor_delay: 0 }
    }
}

/// Antenna length without sensor noise: a compromise between rounding and curvature.
const NOISELESS_ANTENNA: f64 = 1e-6;

/// Damping after a failed step, relative to the squared norm of the Jacobian; each further failure multiplies it by ten.
pub(crate) const FIRST_DAMPING: f64 = 1e-3;

/// Damping above which steps are too short to be useful.
pub(crate) const LARGEST_DAMPING: f64 = 1e2;

/// Consecutive steps that leave more than half of the residual before the antennae are used again.
pub(crate) const SLOW_STEPS: usize = 3;

impl BroydenBas {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        require_positive("antenna_length", self.antenna_length)?;
        require_at_least_one("max_evaluations_per_step", self.max_evaluations_per_step)
    }
}

/// State between steps: point and Jacobian estimate.
#[derive(Debug, Clone, Default)]
pub struct State {
    x: Point,
    value: f64,
    residual: TaskResiduals,
    jacobian: SecantBlocks,
    damping: f64,
    /// Steps since the last antennae that left more than half of the residual.
    slow: usize,
    /// Whether no step was made since the last antennae.
    fresh: bool,
}

impl<O: Residual + ?Sized> Solver<O> for BroydenBas {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let mut x = Point::from_slice(x0);
        let mut residual = TaskResiduals::new();
        let value = evaluator.residual(&mut x, &mut residual)?;
        evaluator.before_steps()?;
        let jacobian = SecantBlocks::new(residual.len());
        *state = State { x, value, residual, jacobian, damping: LEAST_DAMPING, slow: 0, fresh: false };
        state.put_out_antennae(evaluator)
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        if !state.value.is_finite() {
            return Err(Status::Stalled);
        }
        let bounds = evaluator.bounds();
        let State { x, value, residual, jacobian, damping, .. } = state;
        let (mut trial, mut trial_residual) = (x.clone(), TaskResiduals::new());
        jacobian.step(residual, *damping, x, [bounds.lower(), bounds.upper()], &mut trial);
        let trial_value = evaluator.residual(&mut trial, &mut trial_residual)?;
        if trial_value.is_finite() {
            let dx = trial.iter().zip(x.iter()).map(|(to, from)| to - from);
            jacobian.learn(dx, residual, &trial_residual);
        }
        let reduction = trial_value / *value;
        if reduction < 1.0 {
            (*x, *value, *residual) = (trial, trial_value, trial_residual);
            *damping = (*damping * 0.1).max(LEAST_DAMPING);
            // Values are squares: a quarter corresponds to half of the residual.
            state.slow = if reduction > 0.25 { state.slow + 1 } else { 0 };
            state.fresh = false;
            return if state.slow < SLOW_STEPS { Ok(()) } else { state.put_out_antennae(evaluator) };
        }
        if !state.fresh {
            return state.put_out_antennae(evaluator);
        }
        *damping = (*damping * 10.0).max(FIRST_DAMPING);
        if *damping > LARGEST_DAMPING { Err(Status::Stalled) } else { Ok(()) }
    }
}

impl State {
    /// Estimates the Jacobian by forward differences, with one antenna per entry of x.
    #[cold]
    fn put_out_antennae<O: Residual + ?Sized>(&mut self, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let bounds = evaluator.bounds();
        for j in 0..self.x.len() {
            let length = antenna(self.x[j], NOISELESS_ANTENNA, bounds.lower()[j], bounds.upper()[j]);
            if length == 0.0 {
                continue; // a locked joint
            }
            let (mut x, mut residual) = (self.x.clone(), TaskResiduals::new());
            x[j] += length;
            if evaluator.residual(&mut x, &mut residual)?.is_finite() {
                self.jacobian.set_column(j, x[j] - self.x[j], &self.residual, &residual);
            }
        }
        (self.slow, self.fresh) = (0, true);
        Ok(())
    }
}
