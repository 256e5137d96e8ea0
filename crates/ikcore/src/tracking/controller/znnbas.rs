//! Zeroing neural network with beetle antennae search (Khan et al. 2022), in discrete time.
//!
//! In every tick the arm is sent to theta' = beta(theta + lambda b) (eq. 10) with a fresh random b, the error h there is
//! measured (eq. 12) and compared with that of a delay before (eq. 13), and theta moves by the sign of the change
//! (eq. 14, 15). Equations 13 to 15 write h(theta'(t) - alpha) for h(theta'(t - alpha)); the gain of the listing, -10, is that
//! of a block that takes in the minus of eq. 14: put into eq. 14 as printed it diverges. The delay of 10 is one of ticks:
//! 10 seconds do not converge.
//!
//! theta is the state of an integrator: the arm never stands there, but at theta', a random antenna away.

use std::fmt;
use std::str::FromStr;

use super::{Tick, Verdict};
use crate::error::{Error, Result, require_positive};
use crate::objective::Point;
use crate::rng::LazyRng;

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

/// What a measurement is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delay {
    /// The measurement so many ticks before: eq. (13).
    Sliding,
    /// One that is taken anew every so many ticks: lines 17 to 20 of Algorithm 1.
    Held,
}

/// When theta moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accept {
    /// In every tick: eq. (15).
    Always,
    /// Only where the measurement beats the best so far, held against the target of now; else the arm goes back and waits:
    /// the proof of Theorem 1.
    Improving,
}

/// ZNNBAS.
#[derive(Debug, Clone, PartialEq)]
pub struct Znnbas {
    /// k of eq. (14) (1/s), positive to converge. A gain times dt above 0.3 overshoots.
    pub gain: f64,
    /// lambda of eq. (10).
    pub antenna: Antenna,
    /// alpha of eq. (13), in ticks; gain times delay should stay below 1.
    pub delay_steps: usize,
    /// What a measurement is compared with.
    pub delay: Delay,
    /// When theta moves.
    pub accept: Accept,
}

impl Default for Znnbas {
    /// The adaptive antenna of eq. (16), which converges ten times as fast as the published constants.
    fn default() -> Self {
        Self {
            gain: 100.0,
            antenna: Antenna::Adaptive { c1: 0.3 },
            delay_steps: 1,
            delay: Delay::Sliding,
            accept: Accept::Always,
        }
    }
}

/// The longest adaptive antenna (rad).
const LONGEST: f64 = 0.5;

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
        Ok(())
    }
}

/// What the controller remembers from tick to tick.
#[derive(Debug)]
pub(super) struct Memory {
    /// k dt.
    gain: f64,
    antenna: Antenna,
    delay: Delay,
    accept: Accept,
    /// theta, the state of the integrator.
    theta: Point,
    /// theta', where the arm was sent.
    sent: Point,
    position: [f64; 3],
    /// h there.
    value: f64,
    /// Where the best measurement so far was (m).
    best: [f64; 3],
    past: Past,
}

/// The measurements of the last so many ticks, the slots in turn.
#[derive(Debug)]
struct Past {
    sent: Vec<f64>,
    values: Vec<f64>,
    ticks: usize,
}

impl Past {
    /// The slot of `delay` ticks before, which is that of now too.
    fn slot(&self) -> usize {
        self.ticks % self.values.len()
    }
}

impl Memory {
    pub fn new(options: &Znnbas, start: &[f64], dt: f64) -> Self {
        let delay = options.delay_steps;
        Self {
            gain: options.gain * dt,
            antenna: options.antenna.clone(),
            delay: options.delay,
            accept: options.accept,
            theta: start.into(),
            sent: start.into(),
            position: [f64::NAN; 3],
            value: f64::INFINITY,
            best: [f64::INFINITY; 3],
            past: Past { sent: vec![0.0; delay * start.len()], values: vec![0.0; delay], ticks: 0 },
        }
    }

    pub fn begin(&mut self, target: [f64; 3], position: [f64; 3]) {
        (self.position, self.best, self.value) = (position, position, squared_distance(target, position));
    }

    pub fn accepted(&self) -> &[f64] {
        &self.theta
    }

    pub fn measured(&self) -> (&[f64], [f64; 3]) {
        (&self.sent, self.position)
    }

    pub fn command(&mut self, tick: Tick<'_>, rng: &mut LazyRng) -> &[f64] {
        let Self { theta, sent, antenna, .. } = self;
        rng.symmetric(sent); // b, line 14
        let lengths = match antenna {
            Antenna::Constant(lengths) => &lengths[..],
            Antenna::Adaptive { c1 } => &[(*c1 * self.value.sqrt()).min(LONGEST)], // (16)
        };
        for (j, (sent, theta)) in sent.iter_mut().zip(theta).enumerate() {
            *sent = *theta + lengths[if lengths.len() == 1 { 0 } else { j }] * *sent; // (10)
        }
        tick.bounds.clip(sent); // (11)
        sent
    }

    pub fn observe(&mut self, tick: Tick<'_>, position: [f64; 3]) -> Verdict {
        self.position = position;
        self.value = squared_distance(tick.target, position); // (12)
        let improves = self.value < squared_distance(tick.target, self.best);
        if improves {
            self.best = position;
        }
        if self.past.ticks >= self.past.values.len() && (improves || self.accept == Accept::Always) {
            self.move_theta(tick);
        }
        self.remember();
        Verdict::TickOver
    }

    /// One Euler step of eq. (14).
    fn move_theta(&mut self, tick: Tick<'_>) {
        let Self { theta, sent, past, .. } = self;
        let slot = match self.delay {
            Delay::Sliding => past.slot(),
            Delay::Held => 0,
        };
        let step = self.gain * sign(self.value - past.values[slot]);
        let before = &past.sent[slot * theta.len()..][..theta.len()];
        for ((theta, sent), before) in theta.iter_mut().zip(sent).zip(before) {
            *theta -= step * (*sent - before);
        }
        tick.bounds.clip(theta);
    }

    fn remember(&mut self) {
        let Self { sent, past, value, .. } = self;
        let slot = past.slot();
        past.values[slot] = *value;
        past.sent[slot * sent.len()..][..sent.len()].copy_from_slice(sent);
        past.ticks += 1;
    }
}

/// h of eq. (12).
fn squared_distance(target: [f64; 3], position: [f64; 3]) -> f64 {
    (0..3).map(|k| (target[k] - position[k]) * (target[k] - position[k])).sum()
}

/// The plain sign: zero at zero.
fn sign(z: f64) -> f64 {
    f64::from(i8::from(z > 0.0) - i8::from(z < 0.0))
}

impl fmt::Display for Delay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sliding => "sliding",
            Self::Held => "held",
        })
    }
}

impl FromStr for Delay {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "sliding" => Ok(Self::Sliding),
            "held" => Ok(Self::Held),
            _ => Err(Error::unknown_option("delay", name, &["sliding", "held"])),
        }
    }
}

impl fmt::Display for Accept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Always => "always",
            Self::Improving => "improving",
        })
    }
}

impl FromStr for Accept {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "always" => Ok(Self::Always),
            "improving" => Ok(Self::Improving),
            _ => Err(Error::unknown_option("accept", name, &["always", "improving"])),
        }
    }
}
