//! How to solve a batch.

use crate::ik::SolveOptions;
use crate::wording::words;

/// What to do about a target or a start that is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnInvalid {
    /// Refuse the batch; the error names the row.
    #[default]
    Raise,
    /// Solve the others; the row is marked [`Status::Invalid`](crate::solver::Status::Invalid).
    Skip,
}

words!("on_invalid": OnInvalid { Raise => "raise", Skip => "skip" });

/// How to solve a batch. The default uses all cores.
#[derive(Debug, Clone, Default)]
pub struct BatchOptions<'a> {
    /// How to solve each target. Its budgets are those of one target, its start serves all unless `starts` is given.
    pub each: SolveOptions,
    /// Where each target begins, (m, n) row after row (rad, m).
    pub starts: Option<&'a [f64]>,
    /// Number of threads; None: one per core. The result is the same for any.
    pub threads: Option<usize>,
    /// What to do about a wrong row.
    pub on_invalid: OnInvalid,
}
