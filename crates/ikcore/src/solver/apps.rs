//! Autonomous path planning solution (APPS) of Yuan et al. 2016: gradient descent on the smooth error E, with limited joint
//! steps. Equation numbers refer to the paper.
//!
//! The search is unconstrained, as published: a joint may leave its limits, and eq. (12) brings it back by whole turns.

use super::domain::Domain;
use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::error::{Result, require_positive};
use crate::objective::{Gradient, Point};

/// Learning rate eta of eq. (13) (rad per unit of E's derivative).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LearningRate {
    /// Adaptive rate from the curvature of E along the last step, estimated from the gradients at both ends (Barzilai and
    /// Borwein 1988, Two-point step size gradient methods). From random starts to 2000 random targets of the paper's robot it
    /// converges on 85 % in 1000 iterations and on 86 % in 20 000, the best of five fixed rates on 51 and 79 %.
    Auto,
    /// Constant rate.
    Fixed(f64),
}

/// Options of APPS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Apps {
    /// Learning rate eta of eq. (13).
    pub learning_rate: LearningRate,
    /// Largest change of a joint in an iteration (rad or m): d theta_th of eq. (20).
    pub step_limit: f64,
    /// Threshold E_0: the search ends after the first update that starts at an E of at most this, solved or not. `None` ends it
    /// when solved.
    pub error_threshold: Option<f64>,
}

impl Default for Apps {
    /// Default options, with a longer step than the paper's one degree: random targets need a third of the iterations.
    fn default() -> Self {
        Self { learning_rate: LearningRate::Auto, step_limit: 0.2, error_threshold: None }
    }
}

impl Apps {
    /// Parameters of the paper's experiment, in the scale of its eq. (11).
    ///
    /// The paper prints eta = 0.01 and E_0 = 1e-8. Both match an E that is 20 times as large: with this reading, its tables are
    /// reproduced to the last iteration.
    pub fn paper() -> Self {
        Self {
            learning_rate: LearningRate::Fixed(0.2),
            step_limit: std::f64::consts::PI / 180.0,
            error_threshold: Some(5e-10),
        }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        if let LearningRate::Fixed(rate) = self.learning_rate {
            require_positive("learning_rate", rate)?;
        }
        require_positive("step_limit", self.step_limit)?;
        self.error_threshold.map_or(Ok(()), |threshold| require_positive("error_threshold", threshold))
    }

    /// Whether E <= E_0.
    fn is_below_threshold(&self, error: f64) -> bool {
        self.error_threshold.is_some_and(|threshold| error <= threshold)
    }
}

/// State of the descent between updates.
#[derive(Debug, Clone, Default)]
pub struct State {
    theta: Point,
    /// Error E at theta.
    error: f64,
    gradient: Point,
    /// Step that led to theta, and the gradient at its start.
    step: Point,
    gradient_before: Point,
    iterations: usize,
    /// Whether the last update started at an E below the threshold.
    arrived: bool,
}

impl<O: Gradient + ?Sized> Solver<O> for Apps {
    type State = State;

    fn domain(&self) -> Domain {
        Domain::Wrapped
    }

    fn has_own_threshold(&self) -> bool {
        self.error_threshold.is_some()
    }

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let mut theta = Point::from_slice(x0);
        let zeros = Point::from_elem(0.0, x0.len());
        let mut gradient = zeros.clone();
        let error = evaluator.differentiate(&mut theta, &mut gradient)?;
        let arrived = self.is_below_threshold(error);
        *state = State { theta, error, gradient, step: zeros.clone(), gradient_before: zeros, iterations: 0, arrived };
        Ok(())
    }

    /// Takes one update. The paper evaluates E, updates theta, and stops if that E was small enough, so a last update follows
    /// the threshold.
    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        if state.arrived {
            evaluator.check_solved_outside()?;
            return Err(Status::BelowThreshold);
        }
        if !state.error.is_finite() || state.gradient.iter().all(|slope| *slope == 0.0) {
            return Err(Status::Stalled);
        }
        let eta = match self.learning_rate {
            LearningRate::Fixed(rate) => rate,
            LearningRate::Auto => state.two_point_rate(),
        };
        let State { theta, error, gradient, step, gradient_before, iterations, arrived } = state;
        *arrived = self.is_below_threshold(*error);
        let before = theta.clone();
        for ((theta, step), slope) in theta.iter_mut().zip(step.iter_mut()).zip(&*gradient) {
            // Eq. (13) and (20), whose printed last case lacks the step; (21).
            *step = (-eta * slope).clamp(-self.step_limit, self.step_limit);
            *theta += *step;
        }
        std::mem::swap(gradient, gradient_before);
        *error = evaluator.differentiate(theta, gradient)?;
        *iterations += 1;
        if *theta == before {
            return Err(Status::Stalled);
        }
        if self.error_threshold.is_none() { evaluator.check_solved_outside() } else { Ok(()) }
    }
}

impl State {
    /// Learning rate by the long and the short formula of Barzilai and Borwein, eq. (5) and (6), alternating. Without positive
    /// curvature of E along the last step, or without a last step, the rate of Polyak (1969), which on a linear slope would
    /// reach E = 0.
    fn two_point_rate(&self) -> f64 {
        let (mut ss, mut sy, mut yy, mut gg) = (0.0, 0.0, 0.0, 0.0);
        for ((s, g), before) in self.step.iter().zip(&self.gradient).zip(&self.gradient_before) {
            let y = g - before;
            ss += s * s;
            sy += s * y;
            yy += y * y;
            gg += g * g;
        }
        match () {
            () if !(sy > 0.0) => self.error / gg,
            () if self.iterations.is_multiple_of(2) => ss / sy,
            () => sy / yy,
        }
    }
}
