//! How to solve a batch.

use crate::ik::SolveOptions;
use crate::wording::words;

/// What to do about an invalid target or start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnInvalid {
    /// Refuse the batch with an error that names the row.
    #[default]
    Raise,
    /// Solve the others and mark the row [`Status::Invalid`](crate::solver::Status::Invalid).
    Skip,
}

words!("on_invalid": OnInvalid { Raise => "raise", Skip => "skip" });

/// How to solve a batch. The default uses all cores.
#[derive(Debug, Clone, Default)]
pub struct BatchOptions<'a> {
    /// How to solve each target. Its budgets apply to each target, its start to all unless `starts` is given.
    pub each: SolveOptions,
    /// The start of each target, (m, n) row after row (rad, m).
    pub starts: Option<&'a [f64]>,
    /// Number of threads; None: one per core. The result does not depend on it.
    pub threads: Option<usize>,
    /// What to do about an invalid row.
    pub on_invalid: OnInvalid,
}
