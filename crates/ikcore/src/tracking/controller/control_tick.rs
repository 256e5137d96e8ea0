//! Input of a controller for one tick, and whether the tick continues.

use crate::objective::Bounds;
use crate::tracking::tip_pose::TipPose;

/// Input of a controller for one tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct ControlTick<'a> {
    /// Target of the tip at the end of the tick.
    pub target: &'a TipPose,
    /// Box of the commands.
    pub bounds: &'a Bounds,
}

/// Whether the tick continues after a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TickProgress {
    /// The controller has another command for this tick.
    GoOn,
    /// The tick is over.
    TickOver,
}
