//! Budgets of a run.

use std::time::Duration;

use crate::error::{Error, Result, require_at_least_one};

/// Budgets of a run, which ends when the first of them is spent. Counts are repeatable, a time limit is not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Objective evaluations (for a robot: forward kinematics), including the start.
    pub max_evaluations: usize,
    /// Iterations, as counted by the solver.
    pub max_iterations: usize,
    /// Minimum number of iterations, even from a start that is already solved.
    pub min_iterations: usize,
    /// Wall-clock time limit. Results with it are not repeatable.
    pub max_time: Option<Duration>,
    /// Value below which the run ends after a step. The start itself is not compared.
    pub value_below: Option<f64>,
}

impl Default for Stop {
    /// Default budget of 30 000 evaluations: about 10 ms for a 7-joint arm.
    fn default() -> Self {
        Self {
            max_evaluations: 30_000,
            max_iterations: usize::MAX,
            min_iterations: 0,
            max_time: None,
            value_below: None,
        }
    }
}

impl Stop {
    /// Checks that the budgets allow at least the start and one step.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a budget of zero.
    pub fn validate(&self) -> Result<()> {
        require_at_least_one("max_evaluations", self.max_evaluations)?;
        require_at_least_one("max_iterations", self.max_iterations)?;
        match self.value_below {
            Some(value) if value.is_nan() => Err(Error::out_of_range("value_below", "a number", value)),
            _ => Ok(()),
        }
    }
}
