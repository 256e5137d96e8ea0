//! Choice of controller.

use super::broyden_bas::BroydenBasState;
use super::control_tick::RunningController;
use super::znnbas::Znnbas;
use super::znnbas_state::ZnnbasState;
use crate::error::Result;
use crate::solver::BroydenBas;
use crate::task::Tolerance;

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

    pub(super) fn start(&self, start: &[f64], dt: f64, tolerance: Tolerance) -> Box<dyn RunningController> {
        match self {
            Self::BroydenBas(broyden) => Box::new(BroydenBasState::new(*broyden, start, tolerance)),
            Self::Znnbas(znnbas) => Box::new(ZnnbasState::new(znnbas, start, dt)),
        }
    }
}
