//! The result of one tick.

use serde::{Deserialize, Serialize};

use crate::solver::Status;
use crate::task::TipError;

/// The result of one tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// [`Status::Solved`] in the band, [`Status::Improved`] nearer than before, else [`Status::Capped`].
    pub status: Status,
    /// Errors at the accepted configuration.
    pub error: TipError,
    /// Position of the tip there (m).
    pub position: [f64; 3],
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Iterations of the rule; passes of the beetle.
    pub iterations: usize,
    /// False where a joint cannot be brought within its position limits, or slowed down to its velocity limit, in this tick.
    pub inside_limits: bool,
    /// The monitor asked to stop; nothing was accepted and time stands still.
    pub interrupted: bool,
}

impl Step {
    /// Returns a sentence: what happened, and what to try.
    pub fn message(&self) -> String {
        let error = &self.error;
        let limits = if self.inside_limits { "" } else { "; a joint is outside its limits and returns" };
        match self.status {
            Status::Solved => format!("within the tolerances, {error} away{limits}"),
            Status::HeldInRegion => {
                format!("as near as its region allows, {error} away{limits}: {}", self.status.advice())
            }
            Status::Improved => format!("nearer than in the tick before, {error} away{limits}"),
            status => format!("no nearer than in the tick before, {error} away{limits}: {}", status.advice()),
        }
    }
}
