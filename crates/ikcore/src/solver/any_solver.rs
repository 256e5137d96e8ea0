//! Choice of solver: an algorithm from one start, or from many.

use super::algorithm::{Algorithm, DerivativeFree};
use super::evaluator::Evaluator;
use super::levenberg_marquardt::LevenbergMarquardt;
use super::multi_start::{MultiStart, RestartRule};
use super::status::Status;
use super::stop::Stop;
use crate::error::{Error, Result};
use crate::objective::{Differentiable, Objective};

/// Algorithm `A` from one start or from many: [`Algorithm`] for robots, [`DerivativeFree`] for functions without derivatives.
#[derive(Debug, Clone, PartialEq)]
pub enum AnySolver<A = Algorithm> {
    /// Single run from the given start.
    Single(A),
    /// Restarts until solved or the budget is spent.
    MultiStart(MultiStart<A>),
}

impl Default for AnySolver {
    /// Levenberg-Marquardt from many starts.
    fn default() -> Self {
        Self::MultiStart(Algorithm::from(LevenbergMarquardt::default()).into_multi_start())
    }
}

impl<A> AnySolver<A> {
    /// Algorithm that runs from each start.
    pub fn algorithm(&self) -> &A {
        let (Self::Single(algorithm) | Self::MultiStart(MultiStart { solver: algorithm, .. })) = self;
        algorithm
    }

    /// Rule for restarts, if there are any.
    fn restarts(&self) -> Option<RestartRule> {
        match self {
            Self::Single(_) => None,
            Self::MultiStart(multi_start) => Some(multi_start.rule),
        }
    }

    fn validate_restarts(&self) -> Result<()> {
        match self {
            Self::Single(_) => Ok(()),
            Self::MultiStart(multi_start) => multi_start.validate(),
        }
    }
}

impl AnySolver {
    /// Converts to a derivative-free solver; `None` if the algorithm needs more than values.
    pub fn into_derivative_free(self) -> Option<AnySolver<DerivativeFree>> {
        match self {
            Self::Single(Algorithm::DerivativeFree(solver)) => Some(AnySolver::Single(solver)),
            Self::MultiStart(MultiStart { solver: Algorithm::DerivativeFree(solver), rule }) => {
                Some(AnySolver::MultiStart(MultiStart { solver, rule }))
            }
            _ => None,
        }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.validate_restarts().and(self.algorithm().validate())
    }

    /// Whether the solver needs only the values of an objective.
    pub(crate) fn needs_values_alone(&self) -> bool {
        matches!(self.algorithm(), Algorithm::DerivativeFree(_))
    }

    /// Whether a tick of a track may end once it beats the previous one (line 16 of Algorithm 1 in Cheng et al. 2020).
    /// A random search could otherwise run for long; a descent converges in a few iterations.
    pub(crate) fn settles_for_improvement(&self) -> bool {
        self.needs_values_alone()
    }

    /// Whether the solver ends by itself even without a budget.
    pub(crate) fn ends_by_itself(&self) -> bool {
        matches!(self, Self::Single(Algorithm::DerivativeFree(_) | Algorithm::LevenbergMarquardt(_)))
    }

    /// Levenberg-Marquardt from many starts, if this is the solver.
    pub(crate) fn restarted_descent(&self) -> Option<MultiStart<LevenbergMarquardt>> {
        match *self {
            Self::MultiStart(MultiStart { solver: Algorithm::LevenbergMarquardt(solver), rule }) => {
                Some(MultiStart { solver, rule })
            }
            _ => None,
        }
    }

    /// Runs from `x0` until solved, stopped or given up.
    pub fn run(&self, evaluator: &mut Evaluator<'_, dyn Differentiable + '_>, x0: &[f64]) -> Status {
        self.algorithm().run(self.restarts(), evaluator, x0)
    }
}

impl AnySolver<DerivativeFree> {
    /// Checks that the budget allows at least one generation.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the population and the budget.
    pub(crate) fn require_affordable(&self, stop: &Stop) -> Result<()> {
        match self.algorithm().population() {
            Some(population) if population > stop.max_evaluations => {
                let requirement = format!("at most max_evaluations = {}", stop.max_evaluations);
                Err(Error::out_of_range("population", &requirement, population as f64))
            }
            _ => Ok(()),
        }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.validate_restarts().and(self.algorithm().validate())
    }

    /// Runs from `x0` until solved, stopped or given up.
    pub fn run(&self, evaluator: &mut Evaluator<'_, dyn Objective + '_>, x0: &[f64]) -> Status {
        self.algorithm().run(self.restarts(), evaluator, x0)
    }
}
