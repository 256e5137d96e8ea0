//! Options of a batch.

use crate::ik::SolveOptions;
use crate::wording::words;

/// Treatment of invalid targets and starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnInvalid {
    /// Raise an error that names the row.
    #[default]
    Raise,
    /// Solve the others and mark the row [`Status::Invalid`](crate::solver::Status::Invalid).
    Skip,
}

words!("on_invalid": OnInvalid { Raise => "raise", Skip => "skip" });

/// Options of [`solve_batch`](super::solve_batch()). The default uses all cores.
#[derive(Debug, Clone, Default)]
pub struct BatchOptions<'a> {
    /// Options of each solve. Its budgets apply to each target, its start to all targets unless `starts` is given.
    pub each: SolveOptions,
    /// The start of each target (m, n), row-major (rad, m).
    pub starts: Option<&'a [f64]>,
    /// The row of the first target in the batch that these are part of: item i draws from stream `first_row + i` of the seed.
    pub first_row: usize,
    /// Number of threads; None: one per core. The result does not depend on it.
    pub threads: Option<usize>,
    /// Treatment of invalid rows.
    pub on_invalid: OnInvalid,
}
