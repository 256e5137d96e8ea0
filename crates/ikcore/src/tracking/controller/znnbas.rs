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
//! It is here as [`Accept::Improving`]: the theorem holds for it, while the target stands still.

use super::{Tick, Verdict};
use crate::error::{Error, Result, require_positive};
use crate::objective::Point;
use crate::rng::LazyRng;
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

/// What a measurement is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delay {
    /// The measurement so many ticks before: eq. (13).
    Sliding,
    /// One that is taken anew every so many ticks: lines 17 to 20 of Algorithm 1.
    Held,
}

words!("delay": Delay { Sliding => "sliding", Held => "held" });

/// When theta moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accept {
    /// In every tick: eq. (15).
    Always,
    /// To theta' where that is nearer to the target of now than theta is, else not at all: the proof of Theorem 1. Gain and
    /// delay have no part in it.
    Improving,
}

words!("accept": Accept { Always => "always", Improving => "improving" });

/// ZNNBAS.
#[derive(Debug, Clone, PartialEq)]
pub struct Znnbas {
    /// k of eq. (14) (1/s), positive to converge. A gain times dt above 0.3 overshoots.
    pub gain: f64,
    /// Ticks by which the sensor is late: a measurement is held against the command and the target of so many ticks before.
    pub sensor_delay: usize,
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
            sensor_delay: 0,
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
        for (what, ticks) in [("delay_steps", self.delay_steps), ("sensor_delay", self.sensor_delay)] {
            if ticks > MOST_TICKS {
                return Err(Error::out_of_range(what, &format!("at most {MOST_TICKS} ticks"), ticks as f64));
            }
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
    /// Where the tip was at the last theta that was measured (m).
    standing: [f64; 3],
    /// theta', where the arm was sent.
    sent: Point,
    /// What the last measurement said: where, of which command, and h.
    position: [f64; 3],
    answered: Point,
    value: f64,
    on_the_way: OnTheWay,
    past: Past,
}

/// Commands that a late sensor has not answered yet, with their targets; the slots in turn.
#[derive(Debug)]
struct OnTheWay {
    sent: Vec<f64>,
    targets: Vec<[f64; 3]>,
    ticks: usize,
}

/// The measurements of the last so many ticks, the slots in turn.
#[derive(Debug)]
struct Past {
    sent: Vec<f64>,
    values: Vec<f64>,
    ticks: usize,
}

impl Memory {
    pub fn new(options: &Znnbas, start: &[f64], dt: f64) -> Box<Self> {
        let (n, delay) = (start.len(), options.delay_steps);
        Box::new(Self {
            gain: options.gain * dt,
            antenna: options.antenna.clone(),
            delay: options.delay,
            accept: options.accept,
            theta: start.into(),
            standing: [f64::NAN; 3],
            sent: start.into(),
            position: [f64::NAN; 3],
            answered: start.into(),
            value: f64::INFINITY,
            on_the_way: OnTheWay {
                sent: start.repeat(options.sensor_delay),
                targets: vec![[f64::NAN; 3]; options.sensor_delay],
                ticks: 0,
            },
            past: Past { sent: vec![0.0; delay * n], values: vec![0.0; delay], ticks: 0 },
        })
    }

    pub fn begin(&mut self, target: [f64; 3], position: [f64; 3]) {
        (self.position, self.standing, self.value) = (position, position, squared_distance(target, position));
        // Until the first answer comes, the arm stands at the start.
        self.on_the_way.targets.fill(target);
    }

    pub fn accepted(&self) -> &[f64] {
        &self.theta
    }

    pub fn measured(&self) -> (&[f64], [f64; 3]) {
        (&self.answered, self.position)
    }

    pub fn command(&mut self, tick: Tick<'_>, rng: &mut LazyRng) -> &[f64] {
        let Self { theta, sent, antenna, .. } = self;
        rng.symmetric(sent); // b, line 14
        let error = match self.accept {
            Accept::Always => self.value,
            Accept::Improving => squared_distance(tick.target, self.standing),
        };
        let lengths = match antenna {
            Antenna::Constant(lengths) => &lengths[..],
            Antenna::Adaptive { c1 } => &[(*c1 * error.sqrt()).min(LONGEST)], // (16)
        };
        for (j, (sent, theta)) in sent.iter_mut().zip(theta).enumerate() {
            *sent = *theta + lengths[if lengths.len() == 1 { 0 } else { j }] * *sent; // (10)
        }
        tick.bounds.clip(sent); // (11)
        sent
    }

    pub fn observe(&mut self, tick: Tick<'_>, position: [f64; 3]) -> Verdict {
        self.position = position;
        self.answered.copy_from_slice(&self.sent);
        let target = self.on_the_way.swap(&mut self.answered, tick.target);
        self.value = squared_distance(target, position); // (12)
        match self.accept {
            Accept::Always => self.move_theta(),
            Accept::Improving
                if squared_distance(tick.target, position) < squared_distance(tick.target, self.standing) =>
            {
                self.theta.copy_from_slice(&self.answered);
                self.standing = position;
            }
            Accept::Improving => {}
        }
        // A limit may have closed in since the command.
        tick.bounds.clip(&mut self.theta);
        self.past.push(&self.answered, self.value);
        Verdict::TickOver
    }

    /// One Euler step of eq. (14).
    fn move_theta(&mut self) {
        let Self { theta, answered, past, .. } = self;
        let slot = match self.delay {
            _ if past.ticks < past.values.len() => return,
            Delay::Sliding => past.slot(),
            Delay::Held => 0,
        };
        let step = self.gain * sign(self.value - past.values[slot]);
        let before = &past.sent[slot * theta.len()..][..theta.len()];
        for ((theta, now), before) in theta.iter_mut().zip(answered).zip(before) {
            *theta -= step * (*now - before);
        }
    }
}

impl OnTheWay {
    /// Takes in the newest command with its target, and gives the one that is answered now.
    fn swap(&mut self, command: &mut [f64], target: [f64; 3]) -> [f64; 3] {
        if self.targets.is_empty() {
            return target;
        }
        let slot = self.ticks % self.targets.len();
        self.ticks += 1;
        self.sent[slot * command.len()..][..command.len()].swap_with_slice(command);
        std::mem::replace(&mut self.targets[slot], target)
    }
}

impl Past {
    /// The slot of `delay` ticks before, which is that of now too.
    fn slot(&self) -> usize {
        self.ticks % self.values.len()
    }

    fn push(&mut self, command: &[f64], value: f64) {
        let slot = self.slot();
        self.values[slot] = value;
        self.sent[slot * command.len()..][..command.len()].copy_from_slice(command);
        self.ticks += 1;
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
