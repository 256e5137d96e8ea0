//! Results of a batch.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::ik::{Solution, SolveReport};
use crate::message::{Message, message};
use crate::objective::Point;
use crate::solver::Status;

/// Solutions in the order of the targets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Batch {
    /// Degrees of freedom, n.
    pub dof: usize,
    /// Best configurations found (m, n), row-major (rad, m); NaN for items that were not solved.
    pub q: Vec<f64>,
    /// Report on each target (m,).
    pub items: Vec<SolveReport>,
    /// Total time.
    pub elapsed: Duration,
}

impl Batch {
    pub(super) fn untouched(dof: usize, len: usize) -> Self {
        let items = vec![SolveReport::unsolved(Status::Interrupted); len];
        Self { dof, q: vec![f64::NAN; dof * len], items, elapsed: Duration::ZERO }
    }

    /// Solution of item `i`; `None` past the end.
    pub fn solution(&self, i: usize) -> Option<Solution> {
        let q = |i: usize| Point::from_slice(&self.q[i * self.dof..(i + 1) * self.dof]);
        self.items.get(i).map(|report| Solution { q: q(i), report: report.clone() })
    }

    /// Selects the items in `rows`, in this order; the time is the sum of their times.
    ///
    /// # Panics
    /// If a row is past the end.
    pub fn select(&self, rows: &[usize]) -> Self {
        let items: Vec<SolveReport> = rows.iter().map(|i| self.items[*i].clone()).collect();
        let q = rows.iter().flat_map(|i| &self.q[i * self.dof..(i + 1) * self.dof]).copied().collect();
        let elapsed = items.iter().map(|item| item.elapsed).sum();
        Self { dof: self.dof, q, items, elapsed }
    }

    /// Returns a sentence with the number of solved targets, and advice for the others.
    pub fn message(&self) -> Message {
        let mut counts = vec![0; Status::ALL.len()];
        self.items.iter().for_each(|item| counts[item.status as usize] += 1);
        let mut own = self.items.iter().filter_map(|item| item.own_points);
        let advice = own.next().map(|measured| (1 + own.count(), measured.advice()));
        message_of(&counts, advice)
    }
}

/// Returns a sentence with the number of solved targets, and advice for the others, where `counts[status as usize]` targets
/// ended with `status`.
pub fn message_of_counts(counts: &[usize]) -> Message {
    message_of(counts, None)
}

/// [`message_of_counts`]. Of the solutions in collision, `own` are so with what was measured of the robot itself: their number, and
/// advice.
fn message_of(counts: &[usize], own: Option<(usize, Message)>) -> Message {
    let count = |status: Status| counts.get(status as usize).copied().unwrap_or_default();
    let (solved, total) = (count(Status::Solved), counts.iter().sum::<usize>());
    if total == 0 {
        return "no targets".into();
    }
    if solved == total {
        return format!("all {total} solved").into();
    }
    let with_itself = own.as_ref().map_or(0, |(count, _)| *count);
    let others = |status: Status| count(status) - if status == Status::InCollision { with_itself } else { 0 };
    let unsolved = Status::ALL[1..].iter().map(|status| (others(*status), *status, status.advice()));
    let unsolved = unsolved.chain(own.map(|(count, advice)| (count, Status::InCollision, advice)));
    let unsolved = unsolved.filter(|(count, ..)| *count > 0);
    let reasons = unsolved.map(|(count, status, advice)| message![format!("{count} {}: ", status.name()), advice]);
    message![format!("{solved} of {total} solved; "), Message::joined(reasons, "; ")]
}
