//! The result of one target.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::objective::Point;
use crate::solver::Status;
use crate::task::TipError;

/// The best configuration found, and how the search ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solution {
    /// The configuration (n,) (rad, m), inside the limits.
    pub q: Point,
    /// Why the search ended.
    pub status: Status,
    /// Errors at `q`, by forward kinematics.
    pub error: TipError,
    /// Why the target was not reached, in words; empty if unknown or reached.
    pub obstruction: String,
    /// Iterations over all starts.
    pub iterations: usize,
    /// Starts beyond the first.
    pub restarts: usize,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
}

impl Solution {
    /// Returns a sentence: what happened, and what to try.
    pub fn message(&self) -> String {
        let Self { error, obstruction, status, .. } = self;
        if error.position.is_nan() && error.rotation.is_nan() {
            return format!("not solved: {}", status.advice());
        }
        let ended = match status {
            Status::Solved => return format!("solved to {error}"),
            Status::Improved => return format!("below the requested value, {error} away"),
            Status::OutOfReach => "as near as possible,",
            Status::BelowThreshold => "error_threshold met,",
            Status::HeldInRegion => "as near as its region allows,",
            Status::OutsideLimits => "reached only outside the limits; inside them",
            Status::Stalled => "no further progress,",
            Status::BudgetSpent => "budget spent,",
            Status::TimeUp => "time limit reached,",
            _ => "stopped,",
        };
        let why = if obstruction.is_empty() { String::new() } else { format!(" ({obstruction})") };
        format!("{ended} {error} away{why}: {}", status.advice())
    }
}
