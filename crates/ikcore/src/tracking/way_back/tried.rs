//! Outcome of a search, which need not be repeated.

use crate::task::{Target, TargetRow};
use crate::tracking::away::{Away, Way};

/// Waits before an arm tries again among other obstacles after it has failed to get to what was found. Obstacles that are replaced
/// in every tick would otherwise send it to and fro.
const WAITS: usize = 8;

/// Relative change of the error by which a target counts as new; noise causes smaller ones.
const NEW: f64 = 0.5;

/// Outcome of a search.
#[derive(Debug, Clone)]
pub(super) struct Tried {
    targets: TargetRow,
    /// Error of the arm at rest.
    error: f64,
    pub away: Option<Away>,
    failed: bool,
    /// Waits left before other obstacles count.
    waits: usize,
    replaced: bool,
}

impl Tried {
    /// Outcome for an arm that rests with this error to `targets`; `failed` if it did not get to what was found.
    pub fn new(targets: &[Target], error: f64, away: Option<Away>, failed: bool) -> Self {
        let waits = if failed { WAITS } else { 0 };
        Self { targets: TargetRow::from_slice(targets), error, away, failed, waits, replaced: false }
    }

    /// Whether the arm was near enough to its target to be spared the way.
    pub fn spares(&self) -> bool {
        self.away.is_some_and(|away| away.way == Way::Spared)
    }

    /// Records that obstacles were replaced.
    pub fn note_replaced(&mut self) {
        self.replaced = true;
    }

    /// Ends a wait of an arm that rests with this error to `targets`. Returns whether the outcome still holds. It does not for an arm
    /// that has come much nearer since. As its error then is at most half, such attempts end.
    pub fn holds(&mut self, targets: &[Target], error: f64) -> bool {
        self.waits = self.waits.saturating_sub(1);
        let is_same =
            self.targets[..] == *targets && error > NEW * self.error || self.failed && is_still(error, self.error);
        is_same && !(self.replaced && self.waits == 0)
    }
}

/// Whether the error is as it was at rest, but for noise.
pub(super) fn is_still(error: f64, at_rest: f64) -> bool {
    (error - at_rest).abs() <= NEW * at_rest
}
