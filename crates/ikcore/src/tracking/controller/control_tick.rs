//! One tick, as a controller sees it.

use crate::objective::Bounds;

/// A tick, as a controller sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ControlTick<'a> {
    /// Where the tip shall be at its end (m).
    pub target: [f64; 3],
    /// Where commands may lie.
    pub bounds: &'a Bounds,
}

/// What a controller says after a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TickProgress {
    /// It has another command for this tick.
    GoOn,
    /// The tick is over.
    TickOver,
}
