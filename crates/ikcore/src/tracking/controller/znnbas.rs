//! Zeroing neural network with beetle antennae search (Khan et al. 2022), in discrete time.
//!
//! In every tick the arm is sent to theta' = beta(theta + lambda b) (eq. 10) with a fresh random b, the error h there is
//! measured (eq. 12) and compared with that of a delay before (eq. 13), and theta moves by the sign of the change
//! (eq. 14, 15). Equations 13 to 15 write h(theta'(t) - alpha) for h(theta'(t - alpha)); the gain of the listing, -10, is that
//! of a block that takes in the minus of eq. 14: put into eq. 14 as printed it diverges. The delay of 10 is one of ticks:
//! 10 seconds do not converge.
//!
//! theta is the state of an integrator: the arm never stands there, but at theta', a random antenna away.
//!
//! The proof of Theorem 1 describes another algorithm, which keeps theta' where h fell and else goes back to theta and waits.
//! It is here as [`UpdateRule::Improving`]: the theorem holds for it, while the target stands still.

use crate::error::{Error, Result, require_positive};
use crate::wording::words;

/// A longer memory than this is a mistake, and might not fit.
const MOST_TICKS: usize = 100_000;

/// The length of the antennae, lambda of eq. (10).
#[derive(Debug, Clone, PartialEq)]
pub enum Antenna {
    /// The same at all times (rad): one number, or one per joint.
    Constant(Vec<f64>),
    /// c1 sqrt(h), eq. (16) (rad per m), up to half a radian.
    Adaptive {
        /// See the variant.
        c1: f64,
    },
}

/// The measurement that a new one is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delay {
    /// The one `delay_steps` ticks before: eq. (13).
    Sliding,
    /// One renewed every `delay_steps` ticks: lines 17 to 20 of Algorithm 1.
    Held,
}

words!("delay": Delay { Sliding => "sliding", Held => "held" });

/// When theta moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UpdateRule {
    /// In every tick: eq. (15).
    Always,
    /// To theta' where that is nearer to the target of now than theta is, else not at all: the proof of Theorem 1. Gain and
    /// delay have no part in it.
    Improving,
}

words!("accept": UpdateRule { Always => "always", Improving => "improving" });

/// ZNNBAS.
#[derive(Debug, Clone, PartialEq)]
pub struct Znnbas {
    /// k of eq. (14) (1/s), positive to converge. A gain times dt above 0.3 overshoots.
    pub gain: f64,
    /// Delay of the sensor in ticks: a measurement belongs to the command and target of that many ticks before.
    pub sensor_delay: usize,
    /// lambda of eq. (10).
    pub antenna: Antenna,
    /// alpha of eq. (13), in ticks; gain times delay should stay below 1.
    pub delay_steps: usize,
    /// The measurement that a new one is compared with.
    pub delay: Delay,
    /// When theta moves.
    pub accept: UpdateRule,
}

impl Default for Znnbas {
    /// The adaptive antenna of eq. (16), which converges ten times as fast as the published constants.
    fn default() -> Self {
        Self {
            gain: 100.0,
            sensor_delay: 0,
            antenna: Antenna::Adaptive { c1: 0.3 },
            delay_steps: 1,
            delay: Delay::Sliding,
            accept: UpdateRule::Always,
        }
    }
}

impl Znnbas {
    /// The constants of Algorithm 1 in the paper.
    pub fn published() -> Self {
        Self { gain: 10.0, antenna: Antenna::Constant(vec![0.1]), delay_steps: 10, ..Self::default() }
    }

    /// Checks the options, for an arm of `n` joints.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range; [`Error::WrongLength`] for antennae of another arm.
    pub fn validate(&self, n: usize) -> Result<()> {
        self.validate_numbers()?;
        match &self.antenna {
            Antenna::Constant(lengths) if lengths.len() != 1 && lengths.len() != n => {
                let expected = format!("one number, or {n} (one per joint)");
                Err(Error::WrongLength { what: "antenna_length".into(), expected, got: lengths.len() })
            }
            _ => Ok(()),
        }
    }

    /// The same, where the arm is not known yet.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate_numbers(&self) -> Result<()> {
        if !(self.gain.is_finite() && self.gain != 0.0) {
            return Err(Error::out_of_range("gain", "finite and not zero (positive to converge)", self.gain));
        }
        match &self.antenna {
            Antenna::Constant(lengths) => {
                lengths.iter().try_for_each(|length| require_positive("antenna_length", *length))?;
            }
            Antenna::Adaptive { c1 } => require_positive("c1", *c1)?,
        }
        if self.delay_steps == 0 {
            return Err(Error::out_of_range("delay_steps", "at least 1", 0.0));
        }
        for (what, ticks) in [("delay_steps", self.delay_steps), ("sensor_delay", self.sensor_delay)] {
            if ticks > MOST_TICKS {
                return Err(Error::out_of_range(what, &format!("at most {MOST_TICKS} ticks"), ticks as f64));
            }
        }
        Ok(())
    }
}
