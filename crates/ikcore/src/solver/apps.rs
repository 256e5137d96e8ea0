//! The autonomous path planning solution (APPS) of Yuan et al. 2016: descent down the gradient of the smooth error E by
//! steps that are cut off joint by joint. Equation numbers are those of the paper.
//!
//! The search is free, as published: a joint may pass its limits, and eq. (12) brings it back by whole turns.

use super::conduct::{Conduct, Domain, Goal};
use super::driver::Solver;
use super::evaluator::{Evaluator, Halt};
use crate::error::{Error, Result, require_positive};
use crate::objective::{Gradient, Point};

/// eta of eq. (13) (rad per unit of E's derivative).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LearningRate {
    /// As large as the curvature of E allows where the search stands.
    Auto,
    /// The same everywhere.
    Fixed(f64),
}

/// APPS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Apps {
    /// eta of eq. (13).
    pub learning_rate: LearningRate,
    /// Largest change of a joint in an iteration (rad or m): d theta_th of eq. (20).
    pub step_limit: f64,
    /// E_0: after the first update from an E of at most this much the search ends, solved or not. None: it ends when
    /// solved.
    pub error_threshold: Option<f64>,
    /// Share of the last step in the next one (heavy ball); 0 as published.
    pub momentum: f64,
}

/// A descent at a rate below 2 over the curvature approaches its minimum; the curvature there is not that here.
const AUTO_RATE: f64 = 1.8;
/// Iterations between two looks at the curvature.
const CURVATURE_EVERY: usize = 8;

impl Default for Apps {
    fn default() -> Self {
        Self { learning_rate: LearningRate::Auto, step_limit: 0.1, error_threshold: None, momentum: 0.0 }
    }
}

impl Apps {
    /// The parameters of the paper's experiment, in the scale of its eq. (11).
    ///
    /// It prints eta = 0.01 and E_0 = 1e-8, which go with an E that is 20 times as large; its tables follow from these to
    /// the last iteration.
    pub fn paper() -> Self {
        Self {
            learning_rate: LearningRate::Fixed(0.2),
            step_limit: std::f64::consts::PI / 180.0,
            error_threshold: Some(5e-10),
            momentum: 0.0,
        }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        if let LearningRate::Fixed(rate) = self.learning_rate {
            require_positive("learning_rate", rate)?;
        }
        require_positive("step_limit", self.step_limit)?;
        self.error_threshold.map_or(Ok(()), |threshold| require_positive("error_threshold", threshold))?;
        if !(0.0..1.0).contains(&self.momentum) {
            return Err(Error::out_of_range("momentum", "at least 0 and below 1", self.momentum));
        }
        Ok(())
    }

    /// E <= E_0.
    fn is_below_threshold(&self, error: f64) -> bool {
        self.error_threshold.is_some_and(|threshold| error <= threshold)
    }
}

/// Where the descent stands.
#[derive(Debug, Clone)]
pub struct State {
    theta: Point,
    /// E at theta, and its gradient.
    error: f64,
    gradient: Point,
    /// The last step d theta.
    step: Point,
    rate: f64,
    iterations: usize,
    /// Whether the last update was made from an E below the threshold.
    arrived: bool,
}

impl<O: Gradient + ?Sized> Solver<O> for Apps {
    type State = State;

    fn conduct(&self) -> Conduct {
        let goal = if self.error_threshold.is_some() { Goal::Threshold } else { Goal::Solved };
        Conduct { domain: Domain::Wrapped, goal }
    }

    fn start(&self, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<State, Halt> {
        let mut theta = Point::from_slice(x0);
        let mut gradient = Point::from_elem(0.0, x0.len());
        let error = evaluator.differentiate(&mut theta, &mut gradient)?;
        let step = Point::from_elem(0.0, x0.len());
        let arrived = self.is_below_threshold(error);
        Ok(State { theta, error, gradient, step, rate: 0.0, iterations: 0, arrived })
    }

    /// The paper evaluates E, updates theta and stops if that E was small enough: its last update is the one made from it.
    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Halt> {
        if state.arrived {
            evaluator.check_strayed()?;
            return Err(Halt::BelowThreshold);
        }
        if !state.error.is_finite() {
            return Err(Halt::Stalled);
        }
        self.refresh_rate(state, evaluator)?;
        let State { theta, error, gradient, step, rate, arrived, .. } = state;
        *arrived = self.is_below_threshold(*error);
        let before = theta.clone();
        for ((theta, step), slope) in theta.iter_mut().zip(step.iter_mut()).zip(&*gradient) {
            // (13), (20) with the step that its last case lacks, (21)
            let wanted = self.momentum * *step - *rate * slope;
            *step = wanted.clamp(-self.step_limit, self.step_limit);
            *theta += *step;
        }
        *error = evaluator.differentiate(theta, gradient)?;
        if *theta == before {
            return Err(Halt::Stalled);
        }
        if self.error_threshold.is_none() { evaluator.check_strayed() } else { Ok(()) }
    }
}

impl Apps {
    fn refresh_rate<O: Gradient + ?Sized>(
        &self,
        state: &mut State,
        evaluator: &mut Evaluator<'_, O>,
    ) -> Result<(), Halt> {
        match self.learning_rate {
            LearningRate::Fixed(rate) => state.rate = rate,
            LearningRate::Auto if state.iterations.is_multiple_of(CURVATURE_EVERY) => {
                let curvature = evaluator.curvature(&state.theta)?;
                state.rate = AUTO_RATE / curvature;
            }
            LearningRate::Auto => {}
        }
        state.iterations += 1;
        Ok(())
    }
}
