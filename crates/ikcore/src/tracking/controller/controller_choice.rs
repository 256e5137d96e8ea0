//! Choice of controller, and the running controller.

use super::broyden_bas::BroydenBasState;
use super::control_tick::{ControlTick, TickProgress};
use super::znnbas::Znnbas;
use super::znnbas_state::ZnnbasState;
use crate::error::Result;
use crate::rng::LazyRng;
use crate::solver::BroydenBas;
use crate::task::Tolerance;
use crate::tracking::tip_pose::TipPose;

/// Model-free controller and its options.
#[derive(Debug, Clone, PartialEq)]
pub enum Controller {
    /// Broyden updates of a Jacobian estimate carried along the path.
    BroydenBas(BroydenBas),
    /// Steps by the sign of each measured change.
    Znnbas(Znnbas),
}

impl Default for Controller {
    fn default() -> Self {
        Self::BroydenBas(BroydenBas::default())
    }
}

impl Controller {
    /// Checks the options, for an arm of `n` joints.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) or [`Error::WrongLength`](crate::Error::WrongLength) name the option.
    pub fn validate(&self, n: usize) -> Result<()> {
        match self {
            Self::BroydenBas(broyden) => broyden.validate(),
            Self::Znnbas(znnbas) => znnbas.validate(n),
        }
    }

    /// Assumed delay of the sensor (measurements).
    pub(in crate::tracking) fn sensor_delay(&self) -> usize {
        match self {
            Self::BroydenBas(broyden) => broyden.sensor_delay,
            Self::Znnbas(znnbas) => znnbas.sensor_delay,
        }
    }

    pub(super) fn start(&self, start: &[f64], dt: f64, tolerance: Tolerance) -> RunningController {
        match self {
            Self::BroydenBas(broyden) => {
                RunningController::BroydenBas(BroydenBasState::new(*broyden, start, tolerance))
            }
            Self::Znnbas(znnbas) => RunningController::Znnbas(ZnnbasState::new(znnbas, start, dt)),
        }
    }
}

/// Running controller with its state.
#[derive(Debug)]
pub(super) enum RunningController {
    BroydenBas(Box<BroydenBasState>),
    Znnbas(Box<ZnnbasState>),
}

impl RunningController {
    /// Chooses the next command.
    pub(super) fn choose_command(&mut self, tick: ControlTick<'_>, rng: &mut LazyRng) {
        match self {
            Self::BroydenBas(memory) => memory.choose_command(tick),
            Self::Znnbas(memory) => memory.choose_command(tick, rng),
        }
    }

    /// Last command; the start before the first.
    pub(super) fn sent(&self) -> &[f64] {
        match self {
            Self::BroydenBas(memory) => memory.sent(),
            Self::Znnbas(memory) => memory.sent(),
        }
    }

    /// Takes the tip measured at the last command.
    pub(super) fn observe(&mut self, tick: ControlTick<'_>, tip: &TipPose) -> TickProgress {
        match self {
            Self::BroydenBas(memory) => memory.observe(tick, tip),
            Self::Znnbas(memory) => memory.observe(tick, tip),
        }
    }

    /// Takes the tip measured at the start, before the first tick.
    pub(super) fn begin(&mut self, target: &TipPose, tip: &TipPose) {
        match self {
            Self::BroydenBas(memory) => memory.begin(tip),
            Self::Znnbas(memory) => memory.begin(target, tip),
        }
    }

    /// Configuration that the next tick starts from.
    pub(super) fn accepted(&self) -> &[f64] {
        match self {
            Self::BroydenBas(memory) => memory.accepted(),
            Self::Znnbas(memory) => memory.accepted(),
        }
    }

    /// Command at which the tip of the tick was measured, and that measurement.
    pub(super) fn measured(&self) -> (&[f64], &TipPose) {
        match self {
            Self::BroydenBas(memory) => memory.measured(),
            Self::Znnbas(memory) => memory.measured(),
        }
    }
}
