//! Interface of a running controller: its input for one tick, and whether the tick continues.

use std::fmt::Debug;

use crate::objective::Bounds;
use crate::rng::LazyRng;
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

/// Running controller with its state.
pub(super) trait RunningController: Debug + Send + Sync {
    /// Takes the tip measured at the start, before the first tick.
    fn begin(&mut self, target: &TipPose, tip: &TipPose);

    /// Chooses the next command.
    fn choose_command(&mut self, tick: ControlTick<'_>, rng: &mut LazyRng);

    /// Last command; the start before the first.
    fn sent(&self) -> &[f64];

    /// Takes the tip measured at the last command.
    fn observe(&mut self, tick: ControlTick<'_>, tip: &TipPose) -> TickProgress;

    /// Configuration that the next tick starts from.
    fn accepted(&self) -> &[f64];

    /// Command at which the tip of the tick was measured, and that measurement.
    fn measured(&self) -> (&[f64], &TipPose);
}
