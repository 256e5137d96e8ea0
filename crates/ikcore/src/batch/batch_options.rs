//! Options of a batch.

use crate::ik::SolveOptions;
use crate::wording::words;

/// Treatment of invalid targets and starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnInvalid {
    /// Raise an error that names the row.
    #[default]
    Raise,
    /// Solve the other rows and mark this one [`Status::Invalid`](crate::solver::Status::Invalid).
    Skip,
}

words!("on_invalid": OnInvalid { Raise => "raise", Skip => "skip" });

/// Options of [`solve_batch`](super::solve_batch()). The default uses all cores.
#[derive(Debug, Clone, Default)]
pub struct BatchOptions<'a> {
    /// Options of each solve. The budgets apply to each target, the start to all targets unless `starts` is given.
    pub each: SolveOptions,
    /// Start of each target (m, n), row-major (rad, m).
    pub starts: Option<&'a [f64]>,
    /// Row of the first target in a larger batch: item i draws from stream `first_row + i` of the seed.
    pub first_row: usize,
    /// Number of threads; `None` means one per core. The result does not depend on it.
    pub threads: Option<usize>,
    /// Treatment of invalid rows.
    pub on_invalid: OnInvalid,
}
