//! One tick, as a controller sees it.

use crate::objective::Bounds;
use crate::tracking::tip_pose::TipPose;

/// A tick, as a controller sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ControlTick<'a> {
    /// Target of the tip at its end.
    pub target: &'a TipPose,
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
