//! Zeroing neural network with beetle antennae search (Khan et al. 2022), in discrete time.
//!
//! Every tick sends the arm to theta' = beta(theta + lambda b) (eq. 10) with a new random b, measures the error h there (eq.
//! 12), compares it with the error one delay earlier (eq. 13), and moves theta by the sign of the change (eq. 14, 15).
//! Equations 13 to 15 write h(theta'(t) - alpha) for h(theta'(t - alpha)). The gain of -10 in the listing already includes the
//! minus sign of eq. 14; inserted into eq. 14 as printed, it diverges. The delay of 10 is in ticks: 10 seconds do not converge.
//!
//! theta is the state of an integrator. The arm is never at theta, but at theta', a random antenna away.
//!
//! The proof of Theorem 1 describes another algorithm, which moves to theta' if h fell there, and otherwise returns to
//! theta and waits. It is implemented as [`UpdateRule::Improving`]; the theorem holds for it while the target does not
//! move.

use crate::error::{Error, Result, require_at_least_one, require_positive};
use crate::wording::words;

/// Longest delay (ticks): a longer one is a mistake, and might not fit in memory.
const MOST_TICKS: usize = 100_000;

/// Antenna length, lambda of eq. (10).
#[derive(Debug, Clone, PartialEq)]
pub enum Antenna {
    /// Constant length (rad): one number, or one per joint.
    Constant(Vec<f64>),
    /// Adaptive length c1 sqrt(h), eq. (16), at most half a radian.
    Adaptive {
        /// c1 of eq. (16) (rad per m).
        c1: f64,
    },
}

/// Reference measurement for the comparison of eq. (13).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delay {
    /// Measurement `delay_steps` ticks earlier: eq. (13).
    Sliding,
    /// Measurement renewed every `delay_steps` ticks: lines 17 to 20 of Algorithm 1.
    Held,
}

words!("delay": Delay { Sliding => "sliding", Held => "held" });

/// Update rule of theta.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UpdateRule {
    /// Update in every tick: eq. (15).
    Always,
    /// Update to theta' only if it is nearer to the current target than theta: the proof of Theorem 1. Gain and delay are not
    /// used.
    Improving,
}

words!("accept": UpdateRule { Always => "always", Improving => "improving" });

/// Options of ZNNBAS.
#[derive(Debug, Clone, PartialEq)]
pub struct Znnbas {
    /// Gain k of eq. (14) (1/s), positive to converge. Above gain dt = 0.3 it overshoots.
    pub gain: f64,
    /// Delay of the sensor in ticks: a measurement belongs to the command and target of that many ticks earlier.
    pub sensor_delay: usize,
    /// Antenna length lambda of eq. (10).
    pub antenna: Antenna,
    /// Delay alpha of eq. (13), in ticks; gain times delay should stay below 1.
    pub delay_steps: usize,
    /// Reference measurement for the comparison of eq. (13).
    pub delay: Delay,
    /// Update rule of theta.
    pub accept: UpdateRule,
}

impl Default for Znnbas {
    /// Default options, with the adaptive antenna of eq. (16), which converges ten times as fast as the published constants.
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
    /// Constants of Algorithm 1 of the paper.
    pub fn published() -> Self {
        Self { gain: 10.0, antenna: Antenna::Constant(vec![0.1]), delay_steps: 10, ..Self::default() }
    }

    /// Checks the options, for an arm of `n` joints.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range; [`Error::WrongLength`] if the number of antenna lengths
    /// does not match.
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

    /// Checks the options that do not depend on the arm.
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
        require_at_least_one("delay_steps", self.delay_steps)?;
        for (what, ticks) in [("delay_steps", self.delay_steps), ("sensor_delay", self.sensor_delay)] {
            if ticks > MOST_TICKS {
                return Err(Error::out_of_range(what, format!("at most {MOST_TICKS} ticks"), ticks as f64));
            }
        }
        Ok(())
    }
}
