//! One tick, as a controller sees it.

use crate::objective::Bounds;

/// A tick, as a controller sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ControlTick<'a> {
    /// Target of the tip at its end (m).
    pub target: [f64; 3],
    /// Box of the commands.
    pub bounds: &'a Bounds,
}

/// Whether a tick goes on after a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TickProgress {
    /// It has another command for this tick.
    GoOn,
    /// The tick is over.
    TickOver,
}
