//! Controllers: what moves an arm that it has no model of. A controller sees the target, the box of the tick and what was
//! measured, and nothing else.
//!
//! | file | controller | measurements a tick | when to use it |
//! |---|---|---|---|
//! | [`broyden_bas`] | a Jacobian from antenna differences, kept up to date by every step | 1 to a few | the choice, where a tick leaves time to measure more than once, or a step a tick will do |
//! | [`znnbas`] | a random antenna a tick and the sign of what it brought (Khan et al. 2022) | exactly 1 | to repeat the paper; it learns nothing, needs a fast clock, and its antennae shake the tool |

pub mod broyden_bas;
mod control_session;
mod noise;
pub mod znnbas;
mod znnbas_state;

pub use control_session::Session;
pub use znnbas::{Accept, Antenna, Delay, Znnbas};

use crate::error::Result;
use crate::objective::Bounds;
use crate::rng::LazyRng;
use crate::solver::BroydenBas;

/// What a caller chooses.
#[derive(Debug, Clone, PartialEq)]
pub enum Controller {
    /// Secants.
    BroydenBas(BroydenBas),
    /// Signs.
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

    fn start(&self, start: &[f64], dt: f64, tolerance: f64) -> Running {
        match self {
            Self::BroydenBas(broyden) => Running::BroydenBas(broyden_bas::Memory::new(*broyden, start, tolerance)),
            Self::Znnbas(znnbas) => Running::Znnbas(znnbas_state::Memory::new(znnbas, start, dt)),
        }
    }
}

/// A tick, as a controller sees it.
#[derive(Debug, Clone, Copy)]
struct Tick<'a> {
    /// Where the tip shall be at its end (m).
    target: [f64; 3],
    /// Where commands may lie.
    bounds: &'a Bounds,
}

/// What a controller says after a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// It has another command for this tick.
    GoOn,
    /// The tick is over.
    TickOver,
}

/// A controller at work, with what it remembers.
#[derive(Debug)]
enum Running {
    BroydenBas(Box<broyden_bas::Memory>),
    Znnbas(Box<znnbas_state::Memory>),
}

impl Running {
    /// Makes up its mind about the next command.
    fn choose_command(&mut self, tick: Tick<'_>, rng: &mut LazyRng) {
        match self {
            Self::BroydenBas(memory) => memory.choose_command(tick),
            Self::Znnbas(memory) => memory.choose_command(tick, rng),
        }
    }

    /// The last command; the start before there was one.
    fn sent(&self) -> &[f64] {
        match self {
            Self::BroydenBas(memory) => memory.sent(),
            Self::Znnbas(memory) => memory.sent(),
        }
    }

    /// Where the tip was at the last command (m).
    fn observe(&mut self, tick: Tick<'_>, position: [f64; 3]) -> Verdict {
        match self {
            Self::BroydenBas(memory) => memory.observe(tick, position),
            Self::Znnbas(memory) => memory.observe(tick, position),
        }
    }

    /// Where the tip was at the start, before the first tick (m).
    fn begin(&mut self, target: [f64; 3], position: [f64; 3]) {
        match self {
            Self::BroydenBas(memory) => memory.begin(position),
            Self::Znnbas(memory) => memory.begin(target, position),
        }
    }

    /// The configuration that the next tick starts from.
    fn accepted(&self) -> &[f64] {
        match self {
            Self::BroydenBas(memory) => memory.accepted(),
            Self::Znnbas(memory) => memory.accepted(),
        }
    }

    /// The command that the tick stands for, and the position measured there (m).
    fn measured(&self) -> (&[f64], [f64; 3]) {
        match self {
            Self::BroydenBas(memory) => memory.measured(),
            Self::Znnbas(memory) => memory.measured(),
        }
    }
}
