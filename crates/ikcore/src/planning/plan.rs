//! The result of a planner.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::cost::Cost;
use super::planar_arm::Orientations;
use super::violation::Violation;
use crate::error::{Error, Result};
use crate::solver::Status;
use crate::stored::from_bytes;
use crate::trajectory::Trajectory;
use crate::wording::number;

/// A planned motion and the outcome of the search for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The best motion that keeps all limits, or the least violating one.
    pub trajectory: Trajectory,
    /// Quantity that was minimised.
    pub objective: Cost,
    /// Value of the objective on the trajectory (s, rad or m).
    pub cost: f64,
    /// Improvements of the search, in the order of evaluations.
    pub history: Vec<Improvement>,
    /// Smallest distance (m) between robot and obstacles on the trajectory; None where there are no obstacles.
    pub clearance: Option<f64>,
    /// Largest distance (m) of the tip from the path that it was to follow, at its points and between them; None from end
    /// to end.
    pub accuracy: Option<f64>,
    /// Positions that the tip was to follow (m), straight in between; None from end to end.
    pub reference: Option<Vec<[f64; 3]>>,
    /// The orientations that a planar arm was free to choose, at every point of the path, from the tip's link down; empty
    /// where there is no such choice.
    pub redundancy: Vec<Orientations>,
    /// Bounds that the trajectory breaks; empty for a plan that succeeded.
    pub violations: Vec<Violation>,
    /// [`Status::Solved`] for a trajectory that breaks nothing; else why the search ended.
    pub status: Status,
    /// Evaluations of the planner's cost.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
}

/// A step of a search to something better.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Improvement {
    /// Evaluations up to then, that one included.
    pub evaluations: usize,
    /// The lowest value of the search's function from then on; with penalties as long as the plan breaks something.
    pub cost: f64,
}

/// Violations written out in a message.
const NAMED_IN_MESSAGE: usize = 3;

impl Plan {
    /// The plan that [`to_bytes`](crate::stored::to_bytes) stored.
    ///
    /// # Errors
    /// [`Error::Corrupt`] for bytes of another version, damaged ones, those of something else, or values that no plan has.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let plan: Self = from_bytes("plan", bytes)?;
        if plan.redundancy.windows(2).any(|points| points[0].len() != points[1].len()) {
            let problem = "its points have different numbers of redundant links".into();
            return Err(Error::Corrupt { what: "plan".into(), problem });
        }
        Ok(plan)
    }

    /// Returns a sentence: what happened, and what to try.
    pub fn message(&self) -> String {
        let cost = format!("{} of {} {}", self.objective.noun(), number(self.cost), self.objective.unit());
        match self.status {
            Status::Solved => format!("planned with {cost}"),
            Status::Interrupted if self.violations.is_empty() => {
                format!("stopped with {cost}: {}", self.status.advice())
            }
            _ => format!(
                "no plan keeps everything; the least violating one breaks: {}; {}",
                self.broken(),
                self.advice()
            ),
        }
    }

    fn advice(&self) -> &'static str {
        match (self.accuracy, self.clearance) {
            (None, None) => "try another seed, a larger budget in stop=Stop(...) or wider limits",
            (None, Some(_)) => {
                "try another seed, a larger budget in stop=Stop(...), a smaller margin, ends that are clear or wider limits"
            }
            (Some(_), _) => {
                "try another seed, a larger budget in stop=Stop(...), wider limits, a larger accuracy, or for \
                 method=\"tpbso\" denser points"
            }
        }
    }

    fn broken(&self) -> String {
        let mut named: Vec<String> = self.violations.iter().take(NAMED_IN_MESSAGE).map(Violation::to_string).collect();
        if let Some(more @ 1..) = self.violations.len().checked_sub(NAMED_IN_MESSAGE) {
            named.push(format!("and {more} more"));
        }
        named.join("; ")
    }
}
