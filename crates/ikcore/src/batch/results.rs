//! Results of a batch.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::ik::{Nearest, Solution};
use crate::objective::Point;
use crate::solver::Status;
use crate::task::TipError;

/// Result of one target; its configuration is a row of [`Batch::q`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BatchItem {
    /// Reason for the end of the search.
    pub status: Status,
    /// Errors by forward kinematics; NaN if the item was not solved.
    pub error: TipError,
    /// Reason for a miss, in words; empty if unknown or reached.
    pub obstruction: String,
    /// Nearest two bodies, if obstacles or self-collision were checked.
    pub nearest: Option<Box<Nearest>>,
    /// Iterations over all starts.
    pub iterations: usize,
    /// Starts beyond the first.
    pub restarts: usize,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Time taken by this target.
    pub elapsed: Duration,
}

impl From<Solution> for BatchItem {
    fn from(solution: Solution) -> Self {
        let Solution { q: _, status, error, obstruction, nearest, iterations, restarts, evaluations, elapsed } =
            solution;
        Self { status, error, obstruction, nearest, iterations, restarts, evaluations, elapsed }
    }
}

impl BatchItem {
    /// Smallest distance (m), as in [`Solution::clearance`].
    pub fn clearance(&self) -> f64 {
        self.nearest.as_ref().map_or(f64::NAN, |nearest| nearest.clearance.distance)
    }

    /// Item that was not solved.
    pub(super) fn untouched(status: Status) -> Self {
        let error = TipError { position: f64::NAN, rotation: f64::NAN };
        let obstruction = String::new();
        Self {
            status,
            error,
            obstruction,
            nearest: None,
            iterations: 0,
            restarts: 0,
            evaluations: 0,
            elapsed: Duration::ZERO,
        }
    }

    /// Combines the item with its configuration.
    pub fn solution(&self, q: &[f64]) -> Solution {
        let Self { status, error, obstruction, nearest, iterations, restarts, evaluations, elapsed } = self.clone();
        Solution {
            q: Point::from_slice(q),
            status,
            error,
            obstruction,
            nearest,
            iterations,
            restarts,
            evaluations,
            elapsed,
        }
    }
}

/// Solutions in the order of the targets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Batch {
    /// Degrees of freedom, n.
    pub dof: usize,
    /// Best configurations found (m, n), row-major (rad, m); NaN for items that were not solved.
    pub q: Vec<f64>,
    /// Result of each target (m,).
    pub items: Vec<BatchItem>,
    /// Total time.
    pub elapsed: Duration,
}

impl Batch {
    pub(super) fn untouched(dof: usize, len: usize) -> Self {
        let items = vec![BatchItem::untouched(Status::Interrupted); len];
        Self { dof, q: vec![f64::NAN; dof * len], items, elapsed: Duration::ZERO }
    }

    /// Solution of item `i`; `None` past the end.
    pub fn solution(&self, i: usize) -> Option<Solution> {
        self.items.get(i).map(|item| item.solution(&self.q[i * self.dof..(i + 1) * self.dof]))
    }

    /// Selects the items in `rows`, in this order; the time is the sum of their times.
    ///
    /// # Panics
    /// If a row is past the end.
    pub fn select(&self, rows: &[usize]) -> Self {
        let items: Vec<BatchItem> = rows.iter().map(|i| self.items[*i].clone()).collect();
        let q = rows.iter().flat_map(|i| &self.q[i * self.dof..(i + 1) * self.dof]).copied().collect();
        let elapsed = items.iter().map(|item| item.elapsed).sum();
        Self { dof: self.dof, q, items, elapsed }
    }

    /// Returns a sentence with the number of solved targets, and advice for the others.
    pub fn message(&self) -> String {
        let mut counts = vec![0; Status::ALL.len()];
        self.items.iter().for_each(|item| counts[item.status as usize] += 1);
        message_of_counts(&counts)
    }
}

/// Returns a sentence with the number of solved targets, and advice for the others, where `counts[status as usize]` targets
/// ended with `status`.
pub fn message_of_counts(counts: &[usize]) -> String {
    let count = |status: Status| counts.get(status as usize).copied().unwrap_or_default();
    let (solved, total) = (count(Status::Solved), counts.iter().sum::<usize>());
    if total == 0 {
        return "no targets".into();
    }
    if solved == total {
        return format!("all {total} solved");
    }
    let unsolved = Status::ALL[1..].iter().map(|status| (count(*status), status)).filter(|(count, _)| *count > 0);
    let reasons: Vec<String> =
        unsolved.map(|(count, status)| format!("{count} {}: {}", status.name(), status.advice())).collect();
    format!("{solved} of {total} solved; {}", reasons.join("; "))
}
